#include "problem_generator/certifier.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <set>
#include <stdexcept>
#include <string>

#include "common/sqlite.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

/// Runs a program to its end, its stdout (the driver's tables) left out. Exit code, or 128 +
/// signal.
int RunProgram(std::vector<std::string> arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw std::runtime_error(arguments[0] + ": cannot be started: " + std::strerror(error));
  }
  int status = 0;
  while (waitpid(pid, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error(arguments[0] + ": lost: " + std::strerror(errno));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// "1-3,7" of ascending indices, for --problems-range: of a large set the indices one by one are
/// more than an argument may hold.
std::string RangesOf(const std::vector<int>& indices) {
  std::vector<std::string> ranges;
  for (std::size_t i = 0; i < indices.size();) {
    std::size_t last = i;
    while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) ++last;
    ranges.push_back(last == i ? fmt::format("{}", indices[i])
                               : fmt::format("{}-{}", indices[i], indices[last]));
    i = last + 1;
  }
  return fmt::format("{}", fmt::join(ranges, ","));
}

/// Those of `indices` that no run of the session solved.
std::vector<int> UnsolvedIn(const fs::path& session, const std::vector<int>& indices) {
  SqliteConnection results(session / "results.sqlite", SqliteConnection::Mode::kReadOnly);
  std::set<int> tried;
  std::set<int> solved;
  SqliteStatement runs = results.Prepare(
      "SELECT problem_index, max(ifnull(solved AND referee_valid, 0)) FROM runs GROUP BY 1");
  while (runs.Step()) {
    const int index = static_cast<int>(runs.Int(0));
    tried.insert(index);
    if (runs.Int(1) != 0) solved.insert(index);
  }
  std::vector<int> unsolved;
  for (const int index : indices) {
    if (tried.count(index) == 0) {
      throw std::runtime_error(fmt::format("the driver has not tried problem {}", index));
    }
    if (solved.count(index) == 0) unsolved.push_back(index);
  }
  return unsolved;
}

}  // namespace

Certification CertifyProblemSet(
    const fs::path& folder, std::vector<int> indices, const CertifierOptions& options,
    const std::function<void(const std::vector<int>& indices, int attempt)>& replace) {
  Certification certification;
  while (true) {
    const int round = ++certification.num_rounds;
    const fs::path session = options.sessions / fmt::format("round_{}", round);
    // What is asked is whether there is a path, not how good it is.
    const int code =
        RunProgram({options.driver.string(), "--launch", "--robot", options.robot.string(),
                    "--problems", folder.string(), "--problems-range", RangesOf(indices),
                    "--directions", "both", "--time", fmt::format("{}", options.time_limit_s),
                    "--no-simplify", "--no-clearance", "--out", session.string()});
    if (code != 0) {
      throw std::runtime_error(fmt::format("{} ended with exit code {} in round {}",
                                           options.driver.string(), code, round));
    }
    certification.unsolved = UnsolvedIn(session, indices);
    if (certification.unsolved.empty() || round == options.max_rounds) return certification;
    indices = certification.unsolved;
    replace(indices, round);
    for (const int index : indices) certification.replaced[index] = round;
  }
}

}  // namespace planbench
