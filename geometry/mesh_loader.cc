#include "geometry/mesh_loader.h"

#include <assimp/config.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <charconv>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "common/error.h"
#include "common/name_value.h"
#include "common/read_text.h"
#include "geometry/collada_text.h"
#include "geometry/obj_text.h"
#include "geometry/ply_reader.h"
#include "geometry/polygons.h"
#include "geometry/stl_reader.h"
#include "geometry/text_words.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr std::string_view kPackageScheme = "package://";
constexpr std::string_view kFileScheme = "file://";

constexpr double kSinglePrecision = 6e-8;  // Of a coordinate, which assimp rounds by so much.
constexpr double kMostRounding = 1e-4;     // m

// Gathers triangles, giving vertices of exactly the same position one index: STL names every corner
// of every triangle anew, and tools that follow a surface need to know which corners meet.
class MeshBuilder {
 public:
  explicit MeshBuilder(const std::string& file) : file_(file) {}

  const std::string& file() const { return file_; }

  std::uint32_t AddVertex(const Vector3d& vertex) {
    if (!vertex.allFinite()) throw InputError(file_ + ": a vertex is not finite");
    // Adding 0.0 turns -0.0 into 0.0, which compares equal but orders apart nowhere.
    const std::array<double, 3> key = {vertex.x() + 0.0, vertex.y() + 0.0, vertex.z() + 0.0};
    const auto [entry, is_new] =
        index_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.emplace_back(key[0], key[1], key[2]);
    return entry->second;
  }

  // By its vertices.
  void AddPolygon(std::span<const std::uint32_t> corners, bool mirrored) {
    if (corners.size() == 3) return AddTriangle(corners[0], corners[1], corners[2], mirrored);
    std::vector<Vector3d> positions;
    for (const std::uint32_t corner : corners) positions.push_back(mesh_.vertices[corner]);
    for (const auto& [a, b, c] : Triangulate(positions)) {
      AddTriangle(corners[a], corners[b], corners[c], mirrored);
    }
  }

  // Mirroring turns surfaces inside out; the order of the corners turns them back.
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool mirrored) {
    if (a == b || b == c || c == a) {
      lines_.emplace(std::min({a, b, c}), std::max({a, b, c}));
      return;
    }
    if (mirrored) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  }

  // Refuses a mesh whose vertices were rounded to single precision too far from its origin.
  void CheckRounding() const {
    double farthest = 0;
    for (const Vector3d& v : mesh_.vertices) farthest = std::max(farthest, v.cwiseAbs().maxCoeff());
    const double rounding = kSinglePrecision * farthest;
    if (rounding <= kMostRounding) return;
    throw InputError(fmt::format(
        "{}: reaches {:.4g} m from its origin, where its vertices are read to {:.2g} mm "
        "only; check its unit, move it to its origin, or write it as OBJ or PLY",
        file_, farthest, 1000 * rounding));
  }

  // Files have thousands of lines that are edges of other triangles, and add nothing to them.
  TriangleMesh Take() {
    for (const auto& t : mesh_.triangles) {
      if (lines_.empty()) break;
      for (std::size_t k = 0; k < 3; ++k) {
        lines_.erase({t[k], t[k]});
        lines_.erase(std::minmax(t[k], t[(k + 1) % 3]));
      }
    }
    for (const auto& [a, b] : lines_) mesh_.triangles.push_back({a, b, a});
    return std::move(mesh_);
  }

 private:
  const std::string& file_;
  TriangleMesh mesh_;
  // Triangles with corners in one place, by their ends: those of points are equal.
  std::set<std::pair<std::uint32_t, std::uint32_t>> lines_;
  std::map<std::array<double, 3>, std::uint32_t> index_;
};

Eigen::Matrix4d ToEigen(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return result;
}

// Adds the meshes of a node and of all below it. `to_shape` maps the node's parent into the shape's
// frame.
void AddNode(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& to_shape,
             MeshBuilder* builder) {
  const Eigen::Matrix4d transform = to_shape * ToEigen(node.mTransformation);
  const bool mirrored = transform.topLeftCorner<3, 3>().determinant() < 0;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    std::vector<std::uint32_t> indices;
    indices.reserve(mesh.mNumVertices);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      const Vector3d vertex = (transform * Eigen::Vector4d(p.x, p.y, p.z, 1)).head<3>();
      indices.push_back(builder->AddVertex(vertex));
    }
    std::vector<std::uint32_t> corners;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      corners.clear();
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        const unsigned index = face.mIndices[k];
        if (index >= indices.size()) {
          throw InputError(fmt::format("{}: a face names vertex {}, counted from 0, of {}",
                                       builder->file(), index, indices.size()));
        }
        corners.push_back(indices[index]);
      }
      builder->AddPolygon(corners, mirrored);  // Points and lines have no surface.
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    AddNode(scene, *node.mChildren[i], transform, builder);
  }
}

// Adds what assimp makes of a file. It is not asked to cut polygons into triangles: of those with
// corners in a row it leaves out parts.
void AddScene(const fs::path& path, const std::string& format, const Vector3d& scale,
              MeshBuilder* builder) {
  const std::string file = path.string();
  if (format == ".zae") {
    throw InputError(file + ": is an archive; unpack it (unzip) and name the .dae within");
  }
  if (format == ".dae" || format == ".xml") CheckCollada(ReadText(path), file);
  Assimp::Importer importer;
  // Robot descriptions take a mesh's axes as they are written, whatever the file calls "up".
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Else it draws bones where there is no mesh.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* scene = importer.ReadFile(file, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw InputError(
        fmt::format("{}: cannot be read as a mesh: {}", file, importer.GetErrorString()));
  }
  Eigen::Matrix4d to_shape = Eigen::Matrix4d::Identity();
  to_shape.diagonal().head<3>() = scale;
  AddNode(*scene, *scene->mRootNode, to_shape, builder);
  builder->CheckRounding();
}

void AddPolygons(const Polygons& polygons, const Vector3d& scale, MeshBuilder* builder) {
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    corners.clear();
    for (const std::uint32_t corner : polygons.corners(i)) {
      corners.push_back(builder->AddVertex(polygons.vertices()[corner].cwiseProduct(scale)));
    }
    builder->AddPolygon(corners, scale.prod() < 0);
  }
}

// Of Git LFS, what stands in a file's place until that is fetched.
void RefusePointer(const fs::path& path) {
  constexpr std::string_view kBegin = "version https://git-lfs";
  std::string begin(kBegin.size(), '\0');
  std::ifstream(path).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (begin != kBegin) return;
  throw InputError(path.string() +
                   ": is a pointer of Git LFS, not the mesh; fetch it: git lfs pull");
}

void AddStl(const fs::path& path, const Vector3d& scale, MeshBuilder* builder) {
  for (const auto& corners : ReadStl(ReadText(path), path.string())) {
    std::array<std::uint32_t, 3> indices;
    for (std::size_t i = 0; i < 3; ++i) {
      indices[i] = builder->AddVertex(corners[i].cwiseProduct(scale));
    }
    builder->AddTriangle(indices[0], indices[1], indices[2], scale.prod() < 0);
  }
}

// Characters that URLs write as %20 and the like.
std::string DecodePercent(const std::string& text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    const char* const digits = text.data() + i + 1;
    const bool is_code = text[i] == '%' && i + 2 < text.size() &&
                         std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
    decoded += is_code ? static_cast<char>(byte) : text[i];
    if (is_code) i += 2;
  }
  return decoded;
}

bool IsFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

std::optional<fs::path> FirstFile(const fs::path& folder,
                                  std::initializer_list<std::string> names) {
  for (const std::string& name : names) {
    if (IsFile(folder / name)) return folder / name;
  }
  return std::nullopt;
}

// The file that the path of a URI names below a folder; nothing if there is none. Not all who write
// URIs encode what they should.
std::optional<fs::path> FindFile(const fs::path& folder, const std::string& rest) {
  return FirstFile(folder, {DecodePercent(rest), rest});
}

[[noreturn]] void FailNoFile(const std::string& uri, const fs::path& path) {
  throw InputError(fmt::format("resource '{}': no file {}", uri, path.string()));
}

// `rest`: "HOST/path", where the host is none or this machine.
fs::path ResolveFile(const std::string& uri, const std::string& rest) {
  const std::string host = rest.substr(0, rest.find('/'));
  if (!host.empty() && LowerCase(host) != "localhost") {
    throw InputError(fmt::format(
        "resource '{}': names the machine '{}'; a file of this one is file:///FOLDER/FILE", uri,
        host));
  }
  const std::string path = rest.substr(host.size());
  if (const auto file = FindFile("", path)) return *file;
  FailNoFile(uri, path);
}

// `rest`: "NAME/path".
fs::path ResolvePackage(const ResourceResolver& resources, const std::string& uri,
                        const std::string& rest) {
  const std::size_t slash = rest.find('/');
  const std::size_t begin = rest.find_first_not_of('/', slash);
  if (slash == 0 || begin == std::string::npos) {
    throw InputError(fmt::format("resource '{}': expected package://NAME/path", uri));
  }
  const std::string package = rest.substr(0, slash);
  const std::string path = rest.substr(begin);
  const auto known = resources.packages.find(package);
  if (known != resources.packages.end()) {
    if (const auto file = FindFile(known->second, path)) return *file;
    FailNoFile(uri, known->second / path);
  }
  fs::path nearest;  // Folder of that name.
  for (fs::path place = fs::absolute(resources.base_folder / "x").lexically_normal().parent_path();
       const int level : {0, 1, 2, 3}) {
    const fs::path folder = place / package;
    if (const auto file = FindFile(folder, path)) return *file;
    std::error_code error;
    if (nearest.empty() && fs::is_directory(folder, error)) nearest = folder;
    if (level < 3) place = place.parent_path();
  }
  if (!nearest.empty()) FailNoFile(uri, nearest / path);
  throw InputError(
      fmt::format("resource '{}': no folder of package '{}' in or around {}; give it by "
                  "--package-path {}=DIR",
                  uri, package, resources.base_folder.string(), package));
}

}  // namespace

fs::path ResourceResolver::Resolve(const std::string& uri) const {
  if (uri.empty()) throw InputError("resource '': the name is empty");
  if (uri.starts_with(kPackageScheme)) {
    return ResolvePackage(*this, uri, uri.substr(kPackageScheme.size()));
  }
  if (uri.starts_with(kFileScheme)) return ResolveFile(uri, uri.substr(kFileScheme.size()));
  const std::string lower = LowerCase(uri.substr(0, uri.find('/')));
  if (lower == "file:" && uri.starts_with(lower)) return ResolveFile(uri, uri.substr(lower.size()));
  if (lower == "package:" || lower == "file:") {
    throw InputError(fmt::format(
        "resource '{}': expected package://NAME/path or file:///FOLDER/FILE, in lower case", uri));
  }
  if (uri.find("://") != std::string::npos) {
    throw InputError(fmt::format("resource '{}': only package:// and file:// are known", uri));
  }
  // No URI, but written by tools that encode all names alike. An absolute path replaces the base.
  const fs::path& own = own_folder.empty() ? base_folder : own_folder;
  for (const fs::path& folder : {own, base_folder}) {
    if (const auto file = FirstFile(folder, {uri, DecodePercent(uri)})) return *file;
  }
  if (own / uri == base_folder / uri) FailNoFile(uri, own / uri);
  throw InputError(fmt::format("resource '{}': no file {}, nor {}", uri, (own / uri).string(),
                               (base_folder / uri).string()));
}

std::map<std::string, fs::path> ParsePackagePaths(const std::vector<std::string>& arguments) {
  std::map<std::string, fs::path> packages;
  for (const std::string& argument : arguments) {
    const auto [name, folder] = SplitNameValue(argument, "--package-path", "NAME=DIR");
    if (name.find('/') != std::string::npos) {
      throw InputError(fmt::format("--package-path '{}': a package name has no '/'", argument));
    }
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
      throw InputError(fmt::format("--package-path '{}': no folder {}", argument, folder));
    }
    const auto [known, is_new] = packages.emplace(name, folder);
    if (!is_new && !fs::equivalent(known->second, folder, error)) {
      throw InputError(fmt::format("--package-path '{}': {} is given as {} before", argument, name,
                                   known->second.string()));
    }
  }
  return packages;
}

TriangleMesh LoadMesh(const fs::path& path, const Vector3d& scale) {
  const std::string file = path.string();
  if (!IsFile(path)) throw InputError(file + ": no such mesh file");
  if (!scale.allFinite() || (scale.array() == 0).any()) {
    throw InputError(fmt::format("{}: mesh scale [{}, {}, {}] must be finite and not zero", file,
                                 scale.x(), scale.y(), scale.z()));
  }

  RefusePointer(path);
  const std::string format = LowerCase(path.extension().string());
  MeshBuilder builder(file);
  try {
    if (format == ".stl") {
      AddStl(path, scale, &builder);
    } else if (format == ".obj") {
      AddPolygons(ReadObj(ReadText(path), file), scale, &builder);
    } else if (format == ".ply") {
      AddPolygons(ReadPly(ReadText(path), file), scale, &builder);
    } else {
      AddScene(path, format, scale, &builder);
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {  // Of assimp, or no memory for what a file asks for.
    throw InputError(fmt::format("{}: cannot be read as a mesh: {}", file, error.what()));
  }
  TriangleMesh mesh = builder.Take();
  if (mesh.triangles.empty()) throw InputError(file + ": the mesh has no triangles");
  return mesh;
}

}  // namespace planbench
