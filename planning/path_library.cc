#include "planning/path_library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "common/numbers.h"
#include "common/yaml.h"
#include "common/yaml_text.h"

namespace planbench {
namespace {

struct Nearest {
  double distance = kInfinity;
  std::ptrdiff_t waypoint = 0;
};

Nearest NearestWaypoint(const JointSpace& space, const Path& path, std::span<const double> q) {
  Nearest nearest;
  for (const Configuration& waypoint : path) {
    const double distance = space.Distance(waypoint, q);
    if (distance < nearest.distance) nearest = {distance, &waypoint - path.data()};
  }
  return nearest;
}

std::string Row(const Configuration& q) {
  std::vector<std::string> positions;
  for (const double position : q) positions.push_back(YamlNumber(position));
  return fmt::format("[{}]", fmt::join(positions, ", "));
}

std::string Names(const std::vector<std::string>& names) {
  std::vector<std::string> texts;
  for (const std::string& name : names) texts.push_back(YamlText(name));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

}  // namespace

std::string ShortSceneId(const std::string& scene_id) { return scene_id.substr(0, 8); }

bool PathLibrary::Fits(const JointSpace& space) const {
  return std::equal(
      joints.begin(), joints.end(), space.joints().begin(), space.joints().end(),
      [](const std::string& name, const JointSpace::Joint& joint) { return name == joint.name; });
}

std::vector<Path> PathLibrary::Recall(const JointSpace& space, std::span<const double> from,
                                      std::span<const double> to, int count) const {
  struct Stretch {
    double distance;
    std::size_t path;
    std::ptrdiff_t first, last;
  };
  std::vector<Stretch> stretches;
  stretches.reserve(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Nearest first = NearestWaypoint(space, paths[i], from);
    const Nearest last = NearestWaypoint(space, paths[i], to);
    stretches.push_back({first.distance + last.distance, i, first.waypoint, last.waypoint});
  }
  const auto num = std::min(stretches.size(), static_cast<std::size_t>(count));
  std::partial_sort(stretches.begin(), stretches.begin() + static_cast<std::ptrdiff_t>(num),
                    stretches.end(), [](const Stretch& a, const Stretch& b) {
                      return std::pair(a.distance, a.path) < std::pair(b.distance, b.path);
                    });
  std::vector<Path> recalled;
  for (std::size_t k = 0; k < num; ++k) {
    const Stretch& stretch = stretches[k];
    const auto begin = paths[stretch.path].begin();
    const auto [lower, upper] = std::minmax(stretch.first, stretch.last);
    recalled.emplace_back(begin + lower, begin + upper + 1);
    if (stretch.first > stretch.last) std::reverse(recalled.back().begin(), recalled.back().end());
  }
  return recalled;
}

PathLibrary ReadPathLibrary(const std::filesystem::path& file) {
  const YamlNode node = YamlNode::LoadFile(file.string());
  node.AllowOnly({"joints", "learned_from", "scenes", "paths"});
  PathLibrary library;
  library.joints = node.At("joints").Strings();
  if (library.joints.empty()) node.At("joints").Fail("is empty");
  library.learned_from = node.At("learned_from").Strings();
  if (const auto scenes = node.Find("scenes")) library.scenes = scenes->Strings();
  for (const YamlNode& waypoints : node.At("paths").Elements()) {
    Path path;
    for (const YamlNode& q : waypoints.Elements()) {
      path.push_back(q.Doubles(static_cast<int>(library.joints.size())));
    }
    if (path.size() < 2) waypoints.Fail("a path has two waypoints at least");
    library.paths.push_back(std::move(path));
  }
  return library;
}

std::string ToYaml(const PathLibrary& library) {
  std::string yaml = fmt::format("joints: {}\nlearned_from: {}\n", Names(library.joints),
                                 Names(library.learned_from));
  if (!library.scenes.empty()) yaml += fmt::format("scenes: {}\n", Names(library.scenes));
  yaml += library.paths.empty() ? "paths: []\n" : "paths:\n";
  for (const Path& path : library.paths) {
    std::vector<std::string> rows;
    for (const Configuration& q : path) rows.push_back(Row(q));
    yaml += fmt::format("  - [{}]\n", fmt::join(rows, ",\n     "));
  }
  return yaml;
}

}  // namespace planbench
