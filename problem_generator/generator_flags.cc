#include "problem_generator/generator_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <optional>
#include <thread>

#include "common/command_line.h"
#include "common/exit_codes.h"
#include "common/progress_line.h"
#include "common/scratch_folder.h"
#include "common/sibling_program.h"
#include "common/standard_output.h"
#include "problem_generator/certifier.h"
#include "problem_generator/problem_set_maker.h"

namespace planbench {

void GeneratorFlags::AddTo(CLI::App* app) {
  app->add_option("--spec", spec, "specification of the problem set, e.g. problems/box.yaml")
      ->required();
  app->add_option("--robot", robot, "robot folder, or the name of a robot that ships")->required();
  app->add_option("--out", out, "folder to write sceneNNNN.yaml and requestNNNN.yaml to")
      ->required();
  app->add_option("--count", count, "number of problems")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app->add_option("--seed", seed, "equal seeds give equal sets; another seed, other problems")
      ->check(AnySeed())
      ->capture_default_str();
  app->add_flag("--replace", replace, "remove the problems that the folder holds");
  app->add_option("--threads", threads, "default: as many as the machine has; the set is the same")
      ->check(CLI::Range(1, 1024));
  CLI::Option* certify_flag = app->add_flag(
      "--certify", certify,
      "let the live planners try each problem, and replace those that none of them solves");
  app->add_option("--certify-time", certify_time_s, "time limit of each attempt, s")
      ->check(Positive())
      ->capture_default_str()
      ->needs(certify_flag);
  app->add_option("--certify-rounds", certify_rounds,
                  "how often to let them try, replacements between")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->needs(certify_flag);
}

namespace {

/// Has the written set certified, says what was replaced. Exit code.
int Certify(const GeneratorFlags& flags, const ProblemSpec& spec, const Robot& robot,
            const CertifierOptions& options, const std::vector<int>& indices, int threads) {
  const Certification certification = CertifyProblemSet(
      flags.out, indices, options, [&](const std::vector<int>& unsolved, int attempt) {
        const MadeProblems made = MakeProblems(spec, robot, flags.seed, unsolved, attempt, threads);
        for (const Problem& problem : made.problems) WriteToFolder(problem, flags.out);
      });
  for (const auto& [index, attempt] : certification.replaced) {
    WriteOut(fmt::format("problem {} replaced: attempt {}\n", index, attempt));
  }
  if (!certification.unsolved.empty()) {
    WriteOut(fmt::format(
        "NOT certified: after {} rounds nobody has solved problem {} within {} s\n",
        certification.num_rounds, fmt::join(certification.unsolved, ", "), flags.certify_time_s));
    return kExitFailed;
  }
  WriteOut(fmt::format("certified: a planner has solved each problem within {} s\n",
                       flags.certify_time_s));
  return kExitOk;
}

}  // namespace

int RunGenerator(const GeneratorFlags& flags) {
  const Robot robot = LoadRobot(flags.robot);
  for (const std::string& warning : robot.warnings) fmt::print(stderr, "{}\n", warning);
  const ProblemSpec spec = LoadProblemSpec(flags.spec, robot);
  for (const std::string& warning : spec.warnings) fmt::print(stderr, "{}\n", warning);
  RequireProblemFolder(flags.out, flags.replace);
  CertifierOptions certifier;
  std::optional<ScratchFolder> sessions;
  if (flags.certify) {  // what stands in its way is told before a set is made
    sessions.emplace(TemporaryFiles() / "planbench_certify_");
    certifier.sessions = sessions->path();
    certifier.driver = SiblingProgram("benchmark_driver");
    certifier.robot = flags.robot;
    certifier.time_limit_s = flags.certify_time_s;
    certifier.max_rounds = flags.certify_rounds;
  }
  const int threads = flags.threads > 0
                          ? flags.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<int> indices(static_cast<std::size_t>(flags.count));
  std::iota(indices.begin(), indices.end(), 1);
  MadeProblems made;
  {
    std::optional<ProgressLine> progress;
    if (isatty(STDERR_FILENO) == 1) progress.emplace(flags.count);
    made = MakeProblems(spec, robot, flags.seed, indices, 0, threads, [&](int done) {
      if (progress) progress->Show(done, spec.name);
    });
  }
  WriteProblemSet(made.problems, flags.out);
  WriteOut(fmt::format("{}: {} problems with seed {} in {}\n", spec.name, flags.count, flags.seed,
                       flags.out.string()));
  for (const auto& [query, count] : made.by_query) {
    WriteOut(fmt::format("  {:6} {}\n", count, query));
  }
  const auto rejected = made.rejections.ByReason();
  if (!rejected.empty()) WriteOut("rejected on the way:\n");
  for (const auto& [reason, count] : rejected) WriteOut(fmt::format("  {:6} {}\n", count, reason));
  if (!flags.certify) return kExitOk;
  std::fflush(stdout);  // before the driver has its say
  return Certify(flags, spec, robot, certifier, indices, threads);
}

}  // namespace planbench
