#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>

#include "common/command_line.h"
#include "common/exit_codes.h"
#include "common/write_file.h"
#include "experience/learn_paths.h"
#include "messaging/record_log.h"

int main(int argc, char** argv) {
  using namespace planbench;
  std::vector<std::string> sessions;
  Lessons lessons;
  std::string out;
  CLI::App app(
      "Collects the paths of recorded sessions for planners that learn from experience: of each "
      "problem the shortest simplified one that the referee confirmed and, where it judged with "
      "the robot's meshes too, found free by them.",
      "learn_paths");
  AddVersionFlag(&app);
  app.add_option("sessions", sessions, "session folders, with their event logs")->required();
  app.add_option("--out", out, "file to write")->required();
  app.add_option("--sets", lessons.sets, "problem sets to learn from; default: all")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--contestants", lessons.contestants,
                 "whose paths, by the name in tables or on the bus; again for each further one; "
                 "default: everybody's")
      ->allow_extra_args(false);
  return RunCommand(&app, argc, argv, [&] {
    const auto each_run = [&](const VisitRun& visit) {
      for (const std::string& session : sessions) {
        const RecordedSession recorded = ReadRecords(FindEventLog(session));
        for (const std::string& line : recorded.passed_over) {
          std::cerr << "learn_paths: " << line << "\n";
        }
        for (const RecordedRun& run : recorded.runs) visit(ReadRecord(run.place));
      }
    };
    const auto [library, num_against_meshes] = LearnPaths(each_run, lessons);
    WriteFile(out, ToYaml(library));
    std::cout << fmt::format("{}: {} paths of {}", out, library.paths.size(),
                             fmt::join(library.learned_from, ", "));
    if (num_against_meshes > 0) {
      std::cout << fmt::format(
          "; left out: {} that the referee confirmed and the robot's meshes refuse",
          num_against_meshes);
    }
    std::cout << "\n";
    return kExitOk;
  });
}
