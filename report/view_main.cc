#include <fmt/format.h>

#include <charconv>
#include <iostream>

#include "common/command_line.h"
#include "common/error.h"
#include "common/exit_codes.h"
#include "report/page.h"
#include "report/recorded_views.h"
#include "report/write_file.h"
#include "results/stored_session.h"
#include "scene/moveit_yaml.h"

namespace planbench {
namespace {

struct Flags {
  std::string session;
  std::int64_t run = 0;
  std::string problem;
  std::string robot;
  std::string out = "view.html";
};

/// Frames of a path.
constexpr int kFrames = 120;

Json ViewOfRun(const Flags& flags) {
  for (const StoredSession& session : ReadSessions(flags.session).sessions) {
    for (const StoredRun& run : session.runs) {
      if (run.id == flags.run) return RecordedViews(session, flags.robot).View(run, kFrames);
    }
  }
  throw InputError(fmt::format("{}: no run {}", flags.session, flags.run));
}

Json ViewOfProblem(const Flags& flags) {
  if (flags.robot.empty()) throw InputError("--problem needs --robot");
  const std::filesystem::path place = flags.problem;
  const std::string number = place.filename().string();
  int index = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
  if (error != std::errc() || end != number.data() + number.size()) {
    throw InputError("--problem: " + flags.problem + " does not end in a problem's index (SET/3)");
  }
  const ProblemSet set = ListProblemSet(place.parent_path());
  const ProblemFiles* files = set.Find(index);
  if (files == nullptr) throw InputError(fmt::format("{}: no problem {}", set.name, index));
  const Robot robot = LoadRobot(flags.robot);
  return ProblemView(robot, ReadProblem(files->scene, files->request, robot));
}

int Run(const Flags& flags) {
  if (flags.session.empty() == flags.problem.empty()) {
    throw InputError("one of --session and --problem is needed (see view --help)");
  }
  WriteFile(flags.out, ViewPage(flags.problem.empty() ? ViewOfRun(flags) : ViewOfProblem(flags)));
  std::cout << "view: " << flags.out << "\n";
  return kExitOk;
}

}  // namespace
}  // namespace planbench

int main(int argc, char** argv) {
  CLI::App app("Makes a page that shows a run, or a problem, in 3D.", "view");
  planbench::AddVersionFlag(&app);
  planbench::Flags flags;
  CLI::Option* session = app.add_option("--session", flags.session, "session folder");
  app.add_option("--run", flags.run, "id of the run in the session's table runs")->needs(session);
  app.add_option("--problem", flags.problem, "SET/3: problem 3 of the problem set folder SET");
  app.add_option("--robot", flags.robot, "robot folder; default: the session's");
  app.add_option("--out", flags.out, "the page")->capture_default_str();
  return planbench::RunCommand(&app, argc, argv, [&] { return planbench::Run(flags); });
}
