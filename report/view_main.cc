#include <fmt/format.h>

#include <charconv>
#include <iostream>
#include <optional>

#include "collision/collision_model.h"
#include "common/command_line.h"
#include "common/error.h"
#include "common/exit_codes.h"
#include "common/write_file.h"
#include "messaging/record_log.h"
#include "messaging/robot_flags.h"
#include "report/page.h"
#include "report/recorded_views.h"
#include "report/session_robot.h"
#include "results/stored_session.h"
#include "scene/moveit_yaml.h"

namespace planbench {
namespace {

struct Flags {
  std::string session;
  std::string log;
  std::optional<std::int64_t> run;
  std::string problem;
  RobotFlags robot;
  CollisionModel model = CollisionModel::kSpheres;
  std::string out = "view.html";
};

/// Frames of a path.
constexpr int kFrames = 120;

void Tell(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::cerr << "view: " << line << "\n";
}

Json ViewOfRun(const Flags& flags) {
  if (!flags.run) {
    throw InputError(flags.session + ": give --run ID: the id of a run in its table runs");
  }
  for (const StoredSession& session : ReadSessions(flags.session, flags.run).sessions) {
    for (const StoredRun& run : session.runs) {
      if (run.id != *flags.run) continue;
      const RecordedViews views(session, flags.robot.folder, flags.robot.Packages());
      Tell(views.passed_over());
      Tell(views.robot().warnings);
      return views.View(run, kFrames);
    }
  }
  throw InputError(
      fmt::format("{}: no run {} in its table runs that was asked for", flags.session, *flags.run));
}

/// The run of that number among those of the log, from 1, or the last.
Json ViewOfLog(const Flags& flags) {
  RecordedSession recorded = ReadRecords(flags.log);
  const auto scenes = ReadScenes(flags.log, &recorded.passed_over);
  Tell(recorded.passed_over);
  const auto num_runs = static_cast<std::int64_t>(recorded.runs.size());
  const std::int64_t number = flags.run.value_or(num_runs);
  if (num_runs == 0) throw InputError(flags.log + ": no run is recorded in it");
  if (number < 1 || number > num_runs) {
    throw InputError(
        fmt::format("{}: no run {}; --run takes 1 to {}", flags.log, number, num_runs));
  }
  const RunRecordMessage run =
      ReadRecord(recorded.runs[static_cast<std::size_t>(number - 1)].place);
  const auto scene = scenes.find(run.request.scene_id);
  if (scene == scenes.end()) {
    throw InputError(fmt::format("{}: the scene of run {} is not in it", flags.log, number));
  }
  const SessionMessage session = LastTold(recorded, run.run_id);
  const ShownRobot shown(LoadSessionRobot(session, flags.robot.folder, flags.robot.Packages()),
                         session.conditions.mesh_robot_id);
  Tell(shown.robot().warnings);
  return RunView(shown, scene->second, run, kFrames);
}

Json ViewOfProblem(const Flags& flags) {
  if (flags.robot.folder.empty()) throw InputError("--problems needs --robot");
  if (flags.run) throw InputError("--run is of --session and --log; --problems shows no run");
  const std::filesystem::path place = flags.problem;
  const std::string number = place.filename().string();
  int index = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
  if (error != std::errc() || end != number.data() + number.size()) {
    throw InputError("--problems: " + flags.problem + " does not end in a problem's index (SET/3)");
  }
  const ProblemSet set = ListProblemSet(place.parent_path());
  const ProblemFiles* files = set.Find(index);
  if (files == nullptr) throw InputError(fmt::format("{}: no problem {}", set.name, index));
  const ShownRobot shown(flags.robot.Load());
  Tell(shown.robot().warnings);
  return ProblemView(shown, ReadProblem(files->scene, files->request, shown.robot()), flags.model);
}

Json ViewOf(const Flags& flags) {
  if (static_cast<int>(!flags.session.empty()) + static_cast<int>(!flags.log.empty()) +
          static_cast<int>(!flags.problem.empty()) !=
      1) {
    throw InputError("one of --session, --log and --problems is needed (see view --help)");
  }
  if (!flags.session.empty()) return ViewOfRun(flags);
  return flags.log.empty() ? ViewOfProblem(flags) : ViewOfLog(flags);
}

int Run(const Flags& flags) {
  WriteFile(flags.out, ViewPage(ViewOf(flags)));
  std::cout << "view: " << flags.out << "\n";
  return kExitOk;
}

}  // namespace
}  // namespace planbench

int main(int argc, char** argv) {
  CLI::App app("Makes a page that shows a run, or a problem, in 3D.", "view");
  planbench::AddVersionFlag(&app);
  planbench::Flags flags;
  app.add_option("--session", flags.session, "session folder; --run tells which run");
  app.add_option("--log", flags.log, "event log; of its runs the last, or that which --run tells");
  app.add_option("--run", flags.run,
                 "id of the run in the session's table runs; of a log its number, from 1");
  CLI::Option* const problems = app.add_option("--problems,--problem", flags.problem,
                                               "SET/3: problem 3 of the problem set folder SET");
  const std::vector<CLI::Option*> robot_flags = flags.robot.AddTo(&app);
  robot_flags[0]->description("robot folder; default: the session's");
  robot_flags[1]->needs(problems);  // What is recorded tells its spheres,
  app.add_option("--collision-model", flags.model,
                 fmt::format("geometry by which the robot is shown; {}",
                             planbench::kCollisionModelsHelp))
      ->transform(planbench::OneOf<planbench::CollisionModel>())
      ->default_str("spheres")
      ->needs(problems);  // and by what it was checked.
  app.add_option("--out", flags.out, "the page")->capture_default_str();
  return planbench::RunCommand(&app, argc, argv, [&] { return planbench::Run(flags); });
}
