#include "planning/path_library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "common/numbers.h"
#include "common/yaml_text.h"

namespace planbench {
namespace {

constexpr char kNumPaths[] = "num_paths";

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

Configuration Waypoint(const YamlNode& node, const JointSpace& space) {
  Configuration q = node.Doubles(space.size());
  if (const auto fault = space.FindLimitFault(q)) {
    node.At(space.FirstOutsideLimits(q)).Fail(*fault);
  }
  space.Wrap(q);
  return q;
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

PathLibrary ReadPathLibrary(const YamlNode& file, std::span<const PlanningGroup> groups) {
  file.AllowOnly({"joints", "learned_from", "scenes", kNumPaths, "paths"});
  PathLibrary library;
  const YamlNode joints = file.At("joints");
  library.joints = joints.Strings();
  if (library.joints.empty()) joints.Fail("is empty");
  const auto group = std::find_if(groups.begin(), groups.end(),
                                  [&](const PlanningGroup& g) { return library.Fits(g.space); });
  if (group == groups.end()) joints.Fail("are not the joints of a group of the robot, in order");
  library.learned_from = file.At("learned_from").Strings();
  if (const auto scenes = file.Find("scenes")) library.scenes = scenes->Strings();
  const YamlNode paths = file.At("paths");
  for (const YamlNode& waypoints : paths.Elements()) {
    Path path;
    for (const YamlNode& q : waypoints.Elements()) path.push_back(Waypoint(q, group->space));
    if (path.size() < 2) waypoints.Fail("a path has two waypoints at least");
    library.paths.push_back(std::move(path));
  }
  if (library.paths.empty()) paths.Fail("is empty");
  const auto num_paths = file.Find(kNumPaths);  // Libraries of before do not say.
  if (num_paths && num_paths->Int() != static_cast<long long>(library.paths.size())) {
    num_paths->Fail(fmt::format("is {}, but there are {} paths: the file is not whole",
                                num_paths->Int(), library.paths.size()));
  }
  return library;
}

std::string ToYaml(const PathLibrary& library) {
  std::string yaml = fmt::format("joints: {}\nlearned_from: {}\n", Names(library.joints),
                                 Names(library.learned_from));
  if (!library.scenes.empty()) yaml += fmt::format("scenes: {}\n", Names(library.scenes));
  // Tells a file that was cut between two paths.
  yaml += fmt::format("{}: {}\n", kNumPaths, library.paths.size());
  yaml += library.paths.empty() ? "paths: []\n" : "paths:\n";
  for (const Path& path : library.paths) {
    std::vector<std::string> rows;
    for (const Configuration& q : path) rows.push_back(Row(q));
    yaml += fmt::format("  - [{}]\n", fmt::join(rows, ",\n     "));
  }
  return yaml;
}

}  // namespace planbench
