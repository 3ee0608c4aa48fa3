#include "robot_tools/mesh_files.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <variant>

#include "common/error.h"
#include "common/read_text.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPackage = "package://";

// Where the URDF names each mesh first, by URI.
std::map<std::string, std::string> MeshUris(const RobotModel& model) {
  std::map<std::string, std::string> uris;
  for (const Link& link : model.links()) {
    for (const PlacedShape& placed : link.collision) {
      const auto* mesh = std::get_if<Mesh>(&placed.shape);
      if (mesh != nullptr && !mesh->resource.empty()) uris.emplace(mesh->resource, link.where);
    }
  }
  return uris;
}

// Where a URDF in a robot folder looks for a URI within that folder; nothing if it does not.
std::optional<fs::path> OwnPlace(const std::string& uri) {
  const bool in_package = uri.starts_with(kPackage);
  if (in_package && uri.find('%') != std::string::npos) return std::nullopt;
  if (!in_package && uri.find("://") != std::string::npos) return std::nullopt;
  const fs::path place = in_package ? uri.substr(kPackage.size()) : uri;
  const bool leaves = std::find(place.begin(), place.end(), "..") != place.end();
  if (place.is_absolute() || leaves) return std::nullopt;
  return place.lexically_normal();
}

class MeshPlacer {
 public:
  MeshPlacer(const RobotModel& model, const ResourceResolver& resources, const fs::path& folder)
      : folder_(folder) {
    std::map<std::string, fs::path> others;
    for (const auto& [uri, where] : MeshUris(model)) {
      try {
        const fs::path source = resources.Resolve(uri);
        const std::optional<fs::path> place = OwnPlace(uri);
        if (!place || !Take(source, *place)) others.emplace(uri, source);
      } catch (const InputError& error) {
        meshes_.missing.push_back(fmt::format("{}: {}", where, error.what()));
      }
    }
    for (const auto& [uri, source] : others) meshes_.renamed[uri] = PlaceAmongMeshes(source);
  }

  MeshFiles Take() { return std::move(meshes_); }

 private:
  // False if another mesh has the place.
  bool Take(const fs::path& source, const fs::path& place) {
    const auto [taken, is_new] = taken_.try_emplace(place, source);
    if (is_new) meshes_.files.push_back({source, place});
    return fs::equivalent(taken->second, source);
  }

  std::string PlaceAmongMeshes(const fs::path& source) {
    for (int n = 1;; ++n) {
      const std::string number = n == 1 ? "" : fmt::format("_{}", n);
      const fs::path place =
          fs::path("meshes") / (source.stem().string() + number + source.extension().string());
      if (!IsForeign(folder_ / place, source) && Take(source, place)) return place.string();
    }
  }

  // Whether a place holds another file already: the folder may be the URDF's own.
  static bool IsForeign(const fs::path& place, const fs::path& source) {
    std::error_code error;
    return fs::exists(place, error) &&
           (!fs::is_regular_file(place, error) || ReadText(place) != ReadText(source));
  }

  const fs::path& folder_;
  MeshFiles meshes_;
  std::map<fs::path, fs::path> taken_;  // Sources by place.
};

void RenameBelow(tinyxml2::XMLElement* element, const std::map<std::string, std::string>& renamed) {
  if (element == nullptr) return;
  const char* name = element->Attribute("filename");
  if (name != nullptr && element->Name() == std::string_view("mesh")) {
    const auto other = renamed.find(name);
    if (other != renamed.end()) element->SetAttribute("filename", other->second.c_str());
  }
  for (auto* child = element->FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    RenameBelow(child, renamed);
  }
}

}  // namespace

MeshFiles FindMeshes(const RobotModel& model, const ResourceResolver& resources,
                     const fs::path& folder) {
  return MeshPlacer(model, resources, folder).Take();
}

std::string RenameMeshes(const std::string& urdf_text,
                         const std::map<std::string, std::string>& renamed) {
  if (renamed.empty()) return urdf_text;
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf_text.data(), urdf_text.size()) != tinyxml2::XML_SUCCESS) {
    throw InputError(fmt::format("the URDF's meshes cannot be renamed: line {}: {}",
                                 document.ErrorLineNum(),
                                 tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())));
  }
  RenameBelow(document.RootElement(), renamed);
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

void CopyMeshes(const MeshFiles& meshes, const fs::path& folder) {
  for (const MeshFiles::File& file : meshes.files) {
    const fs::path target = folder / file.place;
    std::error_code error;
    if (fs::equivalent(file.source, target, error)) continue;
    fs::create_directories(target.parent_path(), error);
    if (!error) {
      fs::copy_file(file.source, target, fs::copy_options::overwrite_existing, error);
    }
    if (error) throw InputError("cannot write " + target.string() + ": " + error.message());
  }
}

}  // namespace planbench
