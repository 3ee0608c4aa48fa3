#include "report/session_robot.h"

#include <fmt/format.h>

#include <map>
#include <string>

#include "common/file_kind.h"
#include "common/lookup.h"
#include "results/recorded_flags.h"
#include "robot_model/shipped_robots.h"

namespace planbench {
namespace {

// Of the driver's flags, and of the scene server.
constexpr char kRobotSetting[] = "robot";
constexpr char kSpheresSetting[] = "spheres";
constexpr char kPackagesFlag[] = "package-path";

/// Whether both, content ids of robots, can be of one; "" is of any.
bool CanBeOne(const std::string& id, const std::string& other) {
  return id.empty() || other.empty() || id == other;
}

const std::string& RobotId(const SessionMessage& session) {
  return session.conditions.request.robot_id;
}

bool IsSceneServerOf(const SessionMessage& session, const NodeStatusMessage& node) {
  return node.kind == NodeKind::kSceneServer && CanBeOne(node.robot_id, RobotId(session));
}

std::filesystem::path RobotFolder(const SessionMessage& session) {
  std::string why = "the session does not name its robot's folder";
  if (const auto flag = Lookup(session.settings, kRobotSetting).value_or(""); !flag.empty()) {
    try {
      return FindRobotFolder(flag);
    } catch (const InputError& error) {
      why = error.what();
    }
  }
  for (const NodeStatusMessage& node : session.nodes) {
    if (!IsSceneServerOf(session, node)) continue;
    const std::string folder = Lookup(node.settings, kRobotSetting).value_or("");
    if (IsFolder(folder)) return folder;
    if (!folder.empty() && why.find(folder) == std::string::npos) {
      why += "; the scene server's, " + folder + ", is not here";
    }
  }
  throw UnknownRobot(why + ": give it with --robot DIR");
}

/// The file of spheres that took the place of the robot folder's; "" if none did.
std::string SpheresFile(const SessionMessage& session) {
  if (const auto flag = Lookup(session.settings, kSpheresSetting).value_or(""); !flag.empty()) {
    return flag;
  }
  for (const NodeStatusMessage& node : session.nodes) {
    if (!IsSceneServerOf(session, node)) continue;
    const auto told = Lookup(node.settings, kSpheresSetting).value_or("");
    if (!told.empty()) return told;
  }
  return "";
}

/// Where the driver was told that packages are; whether they are here is not looked at.
std::map<std::string, std::filesystem::path> Packages(const SessionMessage& session) {
  std::map<std::string, std::filesystem::path> packages;
  const std::string flag = Lookup(session.settings, kPackagesFlag).value_or("");
  for (const std::string& value : SplitFlagValues(flag)) {
    const std::size_t sign = value.find('=');
    // Of one that is named twice the first counts, as for the driver.
    if (sign != std::string::npos) packages.emplace(value.substr(0, sign), value.substr(sign + 1));
  }
  return packages;
}

}  // namespace

Robot LoadSessionRobot(const SessionMessage& session, const std::filesystem::path& robot_folder,
                       std::map<std::string, std::filesystem::path> packages) {
  packages.merge(Packages(session));
  const std::string spheres = SpheresFile(session);
  const bool has_spheres = spheres.empty() || IsFile(spheres);
  if (robot_folder.empty()) {
    const std::filesystem::path folder = RobotFolder(session);
    if (has_spheres) return LoadRobot(folder, packages, spheres);
    throw UnknownRobot("the session's spheres, " + spheres +
                       ", are not here: give a robot folder that holds them with --robot DIR");
  }
  Robot robot = LoadRobot(robot_folder, packages, has_spheres ? spheres : "");
  if (!has_spheres && !CanBeOne(robot.content_id, RobotId(session))) {
    throw InputError(fmt::format(
        "{} is not the session's robot, which has the spheres of {}: as that file is not here, the "
        "folder must hold them as its own",
        robot_folder.string(), spheres));
  }
  return robot;
}

}  // namespace planbench
