#include "messaging/planner_main.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "collision/collision_model.h"
#include "common/command_line.h"
#include "messaging/planner_node.h"
#include "messaging/program.h"
#include "messaging/robot_flags.h"
#include "planning/planner_settings.h"

namespace planbench {

int PlannerMain(int argc, char** argv, const std::string& planner, const std::string& description,
                const PlannerFactory& factory, const std::vector<SettingFlag>& setting_flags) {
  const std::string program_name = "planner_" + planner;
  Program program(program_name, description);
  RobotFlags robot_flags;
  std::string name = planner;
  std::string config;
  std::vector<std::string> overrides;
  std::vector<std::string> origins;
  std::vector<CollisionModel> models = EnumValues<CollisionModel>();
  robot_flags.AddTo(&program.app()).front()->required();
  program.app().add_option("--name", name, "name on the bus")->capture_default_str();
  program.app().add_option("--config", config, "settings file; default: the robot folder's");
  program.app()
      .add_option("--set", overrides,
                  "KEY=VALUE: overrides a setting, dots in KEY lead into maps; repeatable")
      ->allow_extra_args(false);
  program.app()
      .add_option("--set-origin", origins, "KEY=ORIGIN: where the value of --set KEY was written")
      ->allow_extra_args(false)
      ->group("");  // The driver's, and not shown.
  program.app()
      .add_option("--collision-models", models,
                  fmt::format("those to prepare and to offer, comma-separated; default: all that "
                              "can be used; {}",
                              kCollisionModelsHelp))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->transform(OneOf<CollisionModel>());
  for (const SettingFlag& flag : setting_flags) {
    program.app().add_option_function<std::string>(
        flag.flag,
        [&overrides, key = flag.key](const std::string& value) {
          overrides.push_back(key + "=" + value);
        },
        flag.help);
  }
  return program.Run(argc, argv, [&] {
    const Robot robot = robot_flags.Load();
    std::unique_ptr<Planner> solver =
        factory(robot, LoadPlannerSettings(robot, planner, config, overrides, origins));
    Bus bus(program.lcm_url());
    PlannerNode node(&bus, name, std::move(solver), models, program_name);
    bus.Start();
    spdlog::info("planner '{}' is live on {}", name, bus.url());
    node.Run(AwaitStopSignals());
    return kExitOk;
  });
}

}  // namespace planbench
