#include "problem_generator/generator_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <thread>

#include "common/exit_codes.h"
#include "problem_generator/problem_set_maker.h"
#include "problem_generator/progress_line.h"

namespace planbench {

void GeneratorFlags::AddTo(CLI::App* app) {
  app->add_option("--spec", spec, "specification of the problem set, e.g. problems/box.yaml")
      ->required();
  app->add_option("--robot", robot, "robot folder, e.g. robots/fetch")->required();
  app->add_option("--out", out, "folder to write sceneNNNN.yaml and requestNNNN.yaml to")
      ->required();
  app->add_option("--count", count, "number of problems")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app->add_option("--seed", seed, "equal seeds give equal sets; another seed, other problems")
      ->check(CLI::NonNegativeNumber)  // CLI11 would wrap it
      ->capture_default_str();
  app->add_flag("--replace", replace, "remove the problems that the folder holds");
  app->add_option("--threads", threads, "default: as many as the machine has; the set is the same")
      ->check(CLI::Range(1, 1024));
}

int RunGenerator(const GeneratorFlags& flags) {
  const Robot robot = LoadRobot(flags.robot);
  const ProblemSpec spec = LoadProblemSpec(flags.spec, robot);
  RequireProblemFolder(flags.out, flags.replace);
  const int threads = flags.threads > 0
                          ? flags.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<int> indices(static_cast<std::size_t>(flags.count));
  std::iota(indices.begin(), indices.end(), 1);
  MadeProblems made;
  {
    ProgressLine progress(spec.name, flags.count);
    made = MakeProblems(spec, robot, flags.seed, indices, 0, threads,
                        [&](int done) { progress.Show(done); });
  }
  WriteProblemSet(made.problems, flags.out);
  fmt::print("{}: {} problems with seed {} in {}\n", spec.name, flags.count, flags.seed,
             flags.out.string());
  for (const auto& [query, count] : made.by_query) fmt::print("  {:6} {}\n", count, query);
  const auto rejected = made.rejections.ByReason();
  if (!rejected.empty()) fmt::print("rejected on the way:\n");
  for (const auto& [reason, count] : rejected) fmt::print("  {:6} {}\n", count, reason);
  return kExitOk;
}

}  // namespace planbench
