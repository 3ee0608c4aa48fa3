#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "messaging/multicast_receiver.h"
#include "messaging/program.h"
#include "messaging/robot_flags.h"
#include "scene_server/scene_server_node.h"

int main(int argc, char** argv) {
  using namespace planbench;
  Program program(
      "scene_server",
      "Serves problem sets and scenes on the bus, answers collision queries, and judges "
      "the planners' paths.");
  RobotFlags robot_flags;
  std::string referee_folder;
  std::vector<std::filesystem::path> problem_folders;
  std::string name = "scene_server";
  robot_flags.AddTo(&program.app()).front()->required();
  program.app()
      .add_option("--problems", problem_folders,
                  "problem set, or folder of problem sets (may be repeated)")
      ->required()
      ->allow_extra_args(false);
  program.app().add_option(
      "--referee-robot", referee_folder,
      "robot folder, the name of a robot that ships, or a folder with one .urdf "
      "file, whose meshes judge every path too");
  bool allow_standing_contacts = false;
  program.app().add_flag("--allow-standing-contacts", allow_standing_contacts,
                         "links of the referee's robot that touch in every configuration may");
  program.app().add_option("--name", name, "name on the bus")->capture_default_str();

  return program.Run(argc, argv, [&] {
    Robot robot = robot_flags.Load();
    for (const std::string& warning : robot.warnings) spdlog::warn("{}", warning);
    std::optional<Robot> referee;
    if (!referee_folder.empty()) {
      referee = LoadRefereeRobot(referee_folder, robot, robot_flags.Packages());
      for (const std::string& warning : referee->warnings) spdlog::warn("{}", warning);
    }
    // Those of whoever asks for less lose messages as it is.
    const int receive_buffer_bytes = std::max(
        MulticastAddress::Parse(program.lcm_url()).receive_buffer_bytes, kReceiveBufferBytes);
    SceneService service(std::move(robot), std::move(referee), problem_folders,
                         allow_standing_contacts, static_cast<std::size_t>(receive_buffer_bytes));
    Bus bus(program.lcm_url());
    SceneServerNode node(&bus, name, &service);
    bus.Start();
    for (const auto& set : node.problem_sets().sets) {
      spdlog::info("serving problem set '{}': {} problems", set.name, set.indices.size());
    }
    node.Run(AwaitStopSignals());
    return kExitOk;
  });
}
