#include "report/session_robot.h"

#include <map>
#include <string>

#include "common/file_kind.h"
#include "robot_model/shipped_robots.h"

namespace planbench {
namespace {

constexpr char kRobotSetting[] = "robot";  // Of the driver's flags, and of the scene server.

std::string SettingOf(const std::map<std::string, std::string>& settings, const char* name) {
  const auto setting = settings.find(name);
  return setting == settings.end() ? "" : setting->second;
}

std::filesystem::path RobotFolder(const SessionMessage& session) {
  std::string why = "the session does not name its robot's folder";
  if (const std::string flag = SettingOf(session.settings, kRobotSetting); !flag.empty()) {
    try {
      return FindRobotFolder(flag);
    } catch (const InputError& error) {
      why = error.what();
    }
  }
  for (const NodeStatusMessage& node : session.nodes) {
    if (node.kind != NodeKind::kSceneServer) continue;
    const std::string folder = SettingOf(node.settings, kRobotSetting);
    if (IsFolder(folder)) return folder;
    if (!folder.empty() && why.find(folder) == std::string::npos) {
      why += "; the scene server's, " + folder + ", is not here";
    }
  }
  throw UnknownRobot(why + ": give it with --robot DIR");
}

}  // namespace

Robot LoadSessionRobot(const SessionMessage& session, const std::filesystem::path& robot_folder) {
  return LoadRobot(robot_folder.empty() ? RobotFolder(session) : robot_folder, {},
                   SettingOf(session.settings, "spheres"));
}

}  // namespace planbench
