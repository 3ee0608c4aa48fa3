#include "messaging/mesh_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <string_view>
#include <system_error>

#include "common/error.h"
#include "common/file_state.h"
#include "common/random_id.h"
#include "geometry/meshes_in_use.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFileScheme = "file://";

// Value of an environment variable, empty if it is not set.
std::string Environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::string ToObj(const TriangleMesh& mesh) {
  fmt::memory_buffer text;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    fmt::format_to(std::back_inserter(text), "v {} {} {}\n", v.x(), v.y(), v.z());
  }
  for (const auto& t : mesh.triangles) {
    fmt::format_to(std::back_inserter(text), "f {} {} {}\n", t[0] + 1ULL, t[1] + 1ULL, t[2] + 1ULL);
  }
  return fmt::to_string(text);
}

// Three numbers, one space before each, to the end of the line.
template <typename Number>
bool ParseThree(std::string_view line, Number* numbers) {
  const char* position = line.data();
  const char* const end = position + line.size();
  for (int i = 0; i < 3; ++i) {
    if (position == end || *position != ' ') return false;
    const auto [after, error] = std::from_chars(position + 1, end, numbers[i]);
    if (error != std::errc()) return false;
    position = after;
  }
  return position == end;
}

TriangleMesh ReadStoredMesh(const std::string& uri) {
  if (!uri.starts_with(kFileScheme)) {
    throw InputError(fmt::format("mesh '{}': not a file:// URI", uri));
  }
  const std::string file = uri.substr(kFileScheme.size());
  std::error_code error;
  if (!fs::is_regular_file(file, error)) throw InputError(file + ": no such mesh file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file + ": cannot be read");

  TriangleMesh mesh;
  std::string line;
  int line_number = 0;
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("{}:{}: {}", file, line_number, what));
  };
  while (std::getline(stream, line)) {
    ++line_number;
    if (line.starts_with('v')) {
      Eigen::Vector3d vertex;
      if (!ParseThree(std::string_view(line).substr(1), vertex.data()) || !vertex.allFinite()) {
        fail("expected 'v x y z' in finite numbers");
      }
      mesh.vertices.push_back(vertex);
    } else if (line.starts_with('f')) {
      std::array<std::uint32_t, 3> corners{};
      if (!ParseThree(std::string_view(line).substr(1), corners.data())) {
        fail("expected 'f a b c' in vertex numbers");
      }
      for (std::uint32_t& corner : corners) {
        if (corner < 1 || corner > mesh.vertices.size()) fail("no such vertex");
        --corner;
      }
      mesh.triangles.push_back(corners);
    } else {
      fail("not a line of a stored mesh");
    }
  }
  if (mesh.triangles.empty()) throw InputError(file + ": the mesh has no triangles");
  return mesh;
}

/// Whether the file of a mesh is there and whole: it may have been damaged since it was stored. It
/// is read once, and again when it has changed.
bool IsStored(const std::string& uri, const std::string& mesh_id) {
  static std::mutex mutex;
  static std::map<std::string, std::string> whole;  // states of files
  const std::string state = FileState(uri.substr(kFileScheme.size()));
  const auto is_known = [&] {
    const std::scoped_lock lock(mutex);
    const auto known = whole.find(uri);
    return known != whole.end() && known->second == state;
  };
  if (state.empty() || is_known()) return !state.empty();
  try {
    if (MeshId(ReadStoredMesh(uri)) != mesh_id) return false;
  } catch (const InputError&) {
    return false;
  }
  const std::scoped_lock lock(mutex);
  whole[uri] = state;
  return true;
}

/// Has the disk hold what was written to a file.
bool Sync(const fs::path& file) {
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool is_done = fsync(fd) == 0;
  close(fd);
  return is_done;
}

}  // namespace

fs::path MeshStoreFolder() {
  if (const std::string store = Environment("PLANBENCH_MESH_STORE"); !store.empty()) {
    return fs::absolute(store);
  }
  if (const std::string cache = Environment("XDG_CACHE_HOME"); !cache.empty()) {
    return fs::absolute(cache) / "planbench" / "meshes";
  }
  if (const std::string home = Environment("HOME"); !home.empty()) {
    return fs::absolute(home) / ".cache" / "planbench" / "meshes";
  }
  throw InputError("no folder for meshes: set PLANBENCH_MESH_STORE or HOME");
}

std::string StoreMesh(const SharedMesh& mesh) {
  const fs::path folder = MeshStoreFolder();
  const fs::path file = folder / (mesh.id() + ".obj");
  const std::string uri = std::string(kFileScheme) + file.string();
  if (IsStored(uri, mesh.id())) return uri;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: {}", folder.string(), error.message()));

  // A name of its own for every writer: several threads, processes and, in a shared folder, hosts
  // and containers of equal pids may store the same mesh.
  const fs::path temporary =
      folder / fmt::format("{}.{}.part", file.filename().string(), RandomId());
  std::ofstream stream(temporary, std::ios::binary);
  stream << ToObj(mesh);
  stream.close();
  // Else the name may be on the disk before what it names, when the machine loses its power.
  const bool written = stream.good() && Sync(temporary);
  if (written) fs::rename(temporary, file, error);
  if (!written || error) {
    std::error_code ignored;  // What failed first is what the message is about.
    fs::remove(temporary, ignored);
    throw InputError(fmt::format("{}: cannot be written{}{}", file.string(), error ? ": " : "",
                                 error ? error.message() : ""));
  }
  return uri;
}

SharedMesh LoadStoredMesh(const std::string& uri, const std::string& mesh_id) {
  static MeshesInUse meshes;
  return meshes.Get(mesh_id, [&] { return ReadStoredMesh(uri); });
}

}  // namespace planbench
