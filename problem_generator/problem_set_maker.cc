#include "problem_generator/problem_set_maker.h"

#include <fmt/format.h>

#include <exception>
#include <mutex>
#include <thread>

#include "common/error.h"
#include "scene/moveit_yaml.h"

namespace planbench {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void GiveUp(const ProblemSpec& spec, int index,
                         const ProblemGenerator::Result& result) {
  throw InputError(fmt::format(
      "{}: problem {} ('{}') could not be made: gave up after {} scenes (effort.scenes); "
      "rejected: {}",
      result.rejections.MostFrequentPlace(), index, result.query, spec.effort.scenes,
      result.rejections.Summary()));
}

std::vector<fs::path> ProblemFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (ProblemIndexOf(entry.path())) files.push_back(entry.path());
  }
  return files;
}

}  // namespace

MadeProblems MakeProblems(const ProblemSpec& spec, const Robot& robot, std::uint64_t seed,
                          const std::vector<int>& indices, int attempt, int threads,
                          const std::function<void(int)>& made) {
  std::vector<ProblemGenerator::Result> results(indices.size());
  std::mutex mutex;
  std::size_t next = 0;
  int num_made = 0;
  bool stop = false;
  std::exception_ptr error;
  const auto work = [&] {
    try {
      ProblemGenerator generator(spec, robot, seed);
      while (true) {
        std::unique_lock lock(mutex);
        if (stop || next == indices.size()) return;
        const std::size_t i = next++;
        lock.unlock();
        ProblemGenerator::Result result = generator.Generate(indices[i], attempt);
        lock.lock();
        // Those begun earlier are still finished, so that the first that cannot be made is always
        // the one that is reported.
        stop = stop || !result.problem;
        results[i] = std::move(result);
        if (!stop && made) made(++num_made);
      }
    } catch (...) {
      const std::scoped_lock lock(mutex);
      error = std::current_exception();
      stop = true;
    }
  };
  std::vector<std::jthread> pool;
  for (int i = 0; i < threads; ++i) pool.emplace_back(work);
  pool.clear();  // Joins.
  if (error) std::rethrow_exception(error);

  MadeProblems all;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!results[i].problem) GiveUp(spec, indices[i], results[i]);
    all.problems.push_back(std::move(*results[i].problem));
    ++all.by_query[results[i].query];
    all.rejections.Add(results[i].rejections);
  }
  return all;
}

void RequireProblemFolder(const fs::path& folder, bool replace) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": is no folder");
  if (!replace && !ProblemFilesIn(folder).empty()) {
    throw InputError(folder.string() +
                     ": holds problems already; name another folder, or give --replace");
  }
}

void WriteProblemSet(const std::vector<Problem>& problems, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be created: " + error.message());
  for (const fs::path& file : ProblemFilesIn(folder)) fs::remove(file);
  for (const Problem& problem : problems) WriteToFolder(problem, folder);
}

void WriteToFolder(const Problem& problem, const fs::path& folder) {
  const std::string number = fmt::format("{:04}", problem.index);
  WriteProblem(problem, folder / ("scene" + number + ".yaml"),
               folder / ("request" + number + ".yaml"));
}

}  // namespace planbench
