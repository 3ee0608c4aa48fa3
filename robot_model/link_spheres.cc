#include "robot_model/link_spheres.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>
#include <variant>

#include "common/error.h"
#include "common/yaml.h"
#include "robot_model/srdf.h"

namespace planbench {
namespace {

std::vector<LinkSphere> ReadYaml(const YamlNode& root, const RobotModel& model) {
  root.AllowOnly({"links"});
  const YamlNode links = root.At("links");
  std::vector<LinkSphere> spheres;
  std::set<std::string> seen;
  for (const std::string& name : links.Keys()) {
    if (!seen.insert(name).second) links.Fail(fmt::format("the link '{}' occurs twice", name));
    const YamlNode list = links.At(name);
    const int link = model.FindLink(name);
    if (link < 0) list.Fail(fmt::format("the robot '{}' has no link '{}'", model.name(), name));
    for (const YamlNode& sphere : list.Elements()) {
      sphere.AllowOnly({"center", "radius"});
      const std::vector<double> center = sphere.At("center").Doubles(3);
      spheres.push_back(
          {link, Eigen::Vector3d(center.data()), sphere.At("radius").PositiveDouble()});
    }
  }
  return spheres;
}

std::vector<LinkSphere> ReadUrdf(const std::string& text, const std::string& origin,
                                 const RobotModel& model) {
  const RobotModel spherized = RobotModel::FromUrdf(text, origin);
  std::vector<LinkSphere> spheres;
  for (const Link& link : spherized.links()) {
    if (link.collision.empty()) continue;
    const int index = model.FindLink(link.name);
    if (index < 0) {
      throw InputError(
          fmt::format("{}: the robot '{}' has no such link", link.where, model.name()));
    }
    for (const PlacedShape& placed : link.collision) {
      const auto* sphere = std::get_if<Sphere>(&placed.shape);
      if (sphere == nullptr) {
        throw InputError(
            fmt::format("{}: its collision geometry holds a {}; a sphere model holds "
                        "spheres alone",
                        link.where, ShapeTypeName(placed.shape)));
      }
      spheres.push_back({index, placed.X_FS.translation(), sphere->radius});
    }
  }
  return spheres;
}

}  // namespace

std::vector<LinkSphere> ReadLinkSpheres(const std::filesystem::path& file, const std::string& text,
                                        const RobotModel& model,
                                        std::vector<std::string>* warnings) {
  const std::string origin = file.string();
  const std::string extension = file.extension().string();
  std::vector<LinkSphere> spheres;
  if (extension == ".urdf") {
    spheres = ReadUrdf(text, origin, model);
  } else if (extension == ".srdf") {
    Srdf srdf = ParseSrdf(text, origin, model);
    if (srdf.spheres.empty()) {
      throw InputError(srdf.sphere_warnings.empty()
                           ? origin + ": has no <link_sphere_approximation>"
                           : srdf.sphere_warnings.front());
    }
    spheres = std::move(srdf.spheres);
    if (warnings != nullptr) {
      std::ranges::move(srdf.sphere_warnings, std::back_inserter(*warnings));
    }
  } else {
    spheres = ReadYaml(YamlNode::Parse(text, origin), model);
  }
  std::stable_sort(spheres.begin(), spheres.end(),
                   [](const LinkSphere& a, const LinkSphere& b) { return a.link < b.link; });
  return spheres;
}

}  // namespace planbench
