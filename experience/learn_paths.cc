#include "experience/learn_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "common/error.h"
#include "planning/path_measures.h"

namespace planbench {
namespace {

constexpr char kLength[] = "path_length";

bool Confirmed(const PathCheckReplyMessage& check) {
  return check.verdict && check.verdict->valid &&
         (!check.mesh_verdict || check.mesh_verdict->valid);
}

/// Throws InputError naming the first of `wanted` that was not seen.
void RequireSeen(const std::vector<std::string>& wanted, const std::set<std::string>& seen,
                 const char* flag) {
  for (const std::string& name : wanted) {
    if (!seen.contains(name)) {
      throw InputError(fmt::format("{} '{}': no run of that name is recorded", flag, name));
    }
  }
}

bool Wanted(const std::vector<std::string>& wanted, const std::string& name) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

}  // namespace

PathLibrary LearnPaths(const std::vector<RunRecordMessage>& runs, const Lessons& lessons) {
  PathLibrary library;
  // By set, number and scene: sets of one name need not hold the same problems.
  std::map<std::tuple<std::string, int, std::string>, std::pair<double, Path>> shortest;
  std::set<std::string> sets;
  std::set<std::string> contestants;
  for (const RunRecordMessage& run : runs) {
    sets.insert(run.problem_set);
    contestants.insert(run.contestant);
    if (!Wanted(lessons.sets, run.problem_set) || !Wanted(lessons.contestants, run.contestant)) {
      continue;
    }
    if (run.status != PlanStatus::kSolved || !Confirmed(run.simplified_check)) continue;
    const Path& path = run.result.result.simplified_path;
    if (path.size() < 2) continue;  // It started at its goal.
    const std::optional<double> length =
        FindMeasure(run.simplified_check.verdict->measures, kLength);
    if (!length) continue;
    if (library.joints.empty()) library.joints = run.result.joint_names;
    if (library.joints != run.result.joint_names) {
      throw InputError(fmt::format("set '{}': its paths are of other joints than those before",
                                   run.problem_set));
    }
    const auto [best, first] = shortest.try_emplace(
        {run.problem_set, run.problem_index, run.request.scene_id}, *length, path);
    if (!first && *length < best->second.first) best->second = {*length, path};
  }
  RequireSeen(lessons.sets, sets, "--sets");
  RequireSeen(lessons.contestants, contestants, "--contestants");
  if (shortest.empty()) {
    throw InputError(
        "nothing to learn: no simplified path was recorded that the referee confirmed");
  }
  for (auto& [problem, path] : shortest) {
    const std::string& set = std::get<0>(problem);
    if (library.learned_from.empty() || library.learned_from.back() != set) {
      library.learned_from.push_back(set);
    }
    library.paths.push_back(std::move(path.second));
  }
  return library;
}

}  // namespace planbench
