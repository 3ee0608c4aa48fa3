#include "messaging/mesh_store.h"

#include <gmock/gmock.h>

#include <fstream>
#include <limits>

#include "scene/scene.h"
#include "tests/messaging/codec_fixture.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

class MeshStore : public CodecTest {
 protected:
  std::string Uri(const std::string& name, std::string_view content) {
    return "file://" + store_.Write(name, content).string();
  }
};

TEST_F(MeshStore, KeepsEveryBit) {
  TriangleMesh mesh = ExampleMesh();
  mesh.vertices.emplace_back(1e308, std::numeric_limits<double>::denorm_min(), -0.0);
  mesh.vertices.push_back(mesh.vertices.front());  // Doubles stay, unlike in mesh files at large.
  mesh.triangles.push_back({4, 5, 0});
  const std::string uri = StoreMesh(mesh);
  EXPECT_EQ(uri, "file://" + (store_.path() / (MeshId(mesh) + ".obj")).string());
  const TriangleMesh loaded = LoadStoredMesh(uri, MeshId(mesh));
  EXPECT_EQ(loaded.vertices, mesh.vertices);
  EXPECT_EQ(loaded.triangles, mesh.triangles);
  EXPECT_EQ(MeshId(loaded), MeshId(mesh));
}

TEST_F(MeshStore, StoresOnceAndLeavesNothingElse) {
  const std::string uri = StoreMesh(ExampleMesh());
  EXPECT_EQ(StoreMesh(ExampleMesh()), uri);
  EXPECT_EQ(std::distance(fs::directory_iterator(store_.path()), fs::directory_iterator()), 1);
}

TEST_F(MeshStore, ResourcesGoThroughTheStoreToo) {
  Scene scene = ExampleScene();
  Mesh& mesh = std::get<Mesh>(scene.objects[1].shapes[0].shape);
  mesh.resource = "package://nowhere/rock.stl";
  mesh.scale = {2, 2, 2};
  const SceneMessage message{"r", SceneId(scene), true, "", scene};
  const auto decoded = Decode<SceneMessage>(Encode(message), "CH");
  const Mesh& received = std::get<Mesh>(decoded.scene.objects[1].shapes[0].shape);
  EXPECT_EQ(received.resource, StoreMesh(mesh.triangles));
  EXPECT_EQ(received.triangles->vertices, mesh.triangles->vertices);
}

TEST_F(MeshStore, EqualMeshesAreReadOnce) {
  Scene scene = ExampleScene();
  scene.objects.push_back(scene.objects[1]);
  scene.objects.back().id = "another";
  const auto bytes = Encode(SceneMessage{"r", SceneId(scene), true, "", scene});
  const auto first = Decode<SceneMessage>(bytes, "CH");
  const auto second = Decode<SceneMessage>(bytes, "CH");
  const auto mesh_of = [](const SceneObject& object) {
    return std::get<Mesh>(object.shapes[0].shape).triangles.operator->();
  };
  EXPECT_EQ(mesh_of(first.scene.objects.back()), mesh_of(first.scene.objects[1]));
  EXPECT_EQ(mesh_of(second.scene.objects[1]), mesh_of(first.scene.objects[1]));
}

TEST_F(MeshStore, MissingAndChangedFilesAreNoticed) {
  const std::vector<std::uint8_t> bytes = Encode(Example<SceneMessage>());
  const fs::path file = store_.path() / (MeshId(ExampleMesh()) + ".obj");
  std::ofstream(file, std::ios::app) << "v 0 0 0\n";
  EXPECT_THAT(DecodeError<SceneMessage>(bytes).what(),
              testing::HasSubstr("object[1].shape[0].mesh_id: " + ("file://" + file.string())));
  fs::remove(file);
  EXPECT_THAT(DecodeError<SceneMessage>(bytes).what(), testing::HasSubstr("no such mesh file"));
}

TEST_F(MeshStore, DamagedFilesAreWrittenAnew) {
  const std::string uri = StoreMesh(ExampleMesh());
  const fs::path file = store_.path() / (MeshId(ExampleMesh()) + ".obj");
  const auto size = fs::file_size(file);
  // Empty, as after a loss of power; another mesh; cut off.
  for (const char* damage : {"", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "v 0 0"}) {
    std::ofstream(file, std::ios::trunc) << damage;
    EXPECT_EQ(StoreMesh(ExampleMesh()), uri);
    EXPECT_EQ(fs::file_size(file), size);
    EXPECT_EQ(MeshId(LoadStoredMesh(uri, "not in use")), MeshId(ExampleMesh()));
    EXPECT_EQ(StoreMesh(ExampleMesh()), uri);  // looks at it
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(store_.path()), fs::directory_iterator()), 1);
}

TEST_F(MeshStore, AFileThatChangesIsReadAgainThoughItsOldMeshIsInUse) {
  TriangleMesh other = ExampleMesh();
  other.vertices[0].x() += 1;
  const fs::path file_of_other = StoreMesh(other).substr(std::string("file://").size());
  const std::string uri = Uri("rock.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string old_id = LoadStoredMesh(uri, "not in use").id();
  const SharedMesh old = LoadStoredMesh(uri, old_id);
  fs::copy_file(file_of_other, store_ / "rock.obj", fs::copy_options::overwrite_existing);
  EXPECT_EQ(LoadStoredMesh(uri, MeshId(other)).id(), MeshId(other));
  EXPECT_EQ(LoadStoredMesh(uri, old_id).operator->(), old.operator->());
}

TEST_F(MeshStore, RefusesWhatItDidNotWrite) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"v 0 0\n", ":1: expected 'v x y z'"},
      {"v 0 0 0 0\n", ":1: expected 'v x y z'"},
      {"v 0 0 nan\n", ":1: expected 'v x y z'"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ":4: no such vertex"},
      {"v 0 0 0\nf 0 1 1\n", ":2: no such vertex"},
      {"v 0 0 0\nf 1 1 -1\n", ":2: expected 'f a b c'"},
      {"v 0 0 0\nf 1/1 1/1 1/1\n", ":2: expected 'f a b c'"},
      {"solid cube\n", ":1: not a line of a stored mesh"},
      {"v 0 0 0\n", "the mesh has no triangles"},
      {"", "the mesh has no triangles"},
  };
  for (const auto& [content, expected] : bad) {
    const std::string uri = Uri("bad.obj", content);
    ExpectInputError([&] { LoadStoredMesh(uri, "id"); }, {"bad.obj", expected});
  }
  ExpectInputError([&] { LoadStoredMesh("file://" + store_.path().string(), "id"); },
                   {"no such mesh file"});
}

TEST_F(MeshStore, FolderThatCannotBeIsAnError) {
  const fs::path file = store_.Write("file", "");
  setenv("PLANBENCH_MESH_STORE", (file / "below").c_str(), 1);
  ExpectInputError([] { StoreMesh(ExampleMesh()); }, {(file / "below").string()});
}

TEST_F(MeshStore, FolderFollowsTheEnvironment) {
  EXPECT_EQ(MeshStoreFolder(), store_.path());
  unsetenv("PLANBENCH_MESH_STORE");
  const char* const set = std::getenv("XDG_CACHE_HOME");
  const std::string before = set != nullptr ? set : "";
  setenv("XDG_CACHE_HOME", "/some/cache", 1);
  EXPECT_EQ(MeshStoreFolder(), "/some/cache/planbench/meshes");
  if (set != nullptr) {
    setenv("XDG_CACHE_HOME", before.c_str(), 1);
  } else {
    unsetenv("XDG_CACHE_HOME");
  }
}

}  // namespace
}  // namespace planbench
