#include "experience/learn_paths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

bool Confirmed(const RunRecordMessage& run) {
  const auto& verdict = run.simplified_check.verdict;
  return run.status == PlanStatus::kSolved && verdict && verdict->valid;
}

bool FreeByMeshes(const RunRecordMessage& run) {
  const auto& verdict = run.simplified_check.mesh_verdict;
  return !verdict || verdict->valid;
}

/// Throws InputError naming the first of `wanted` that was not seen, and those that were.
void RequireSeen(const std::vector<std::string>& wanted, const std::set<std::string>& seen,
                 const char* flag) {
  for (const std::string& name : wanted) {
    if (!seen.contains(name)) {
      throw InputError(fmt::format("{} '{}': no run of that name is recorded; there are: {}", flag,
                                   name, fmt::join(seen, "; ")));
    }
  }
}

/// The group's joints, in its order: the driver's goals name them so, one alternative after the
/// other.
std::vector<std::string> GroupJoints(const RunRecordMessage& run) {
  const std::size_t num_joints = run.result.joint_names.size();
  std::vector<std::string> joints;
  for (const JointGoal& goal : run.request.goal) {
    if (joints.size() < num_joints) joints.push_back(goal.joint);
  }
  return joints;
}

/// The path that has its positions in the order of `names`, which are those of `joints`.
Path InOrderOf(const std::vector<std::string>& joints, const std::vector<std::string>& names,
               const Path& path) {
  Path ordered;
  for (const Configuration& q : path) {
    Configuration& waypoint = ordered.emplace_back();
    for (const std::string& joint : joints) {
      const auto found = std::find(names.begin(), names.end(), joint);
      waypoint.push_back(q.at(static_cast<std::size_t>(found - names.begin())));
    }
  }
  return ordered;
}

bool Wanted(const std::vector<std::string>& wanted, const std::string& name) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

}  // namespace

Learned LearnPaths(const EachRun& each_run, const Lessons& lessons) {
  Learned learned;
  PathLibrary& library = learned.library;
  // By set, number and scene: sets of one name need not hold the same problems.
  std::map<std::tuple<std::string, int, std::string>, std::pair<double, Path>> shortest;
  std::set<std::string> sets;
  std::set<std::string> contestants;
  each_run([&](const RunRecordMessage& run) {
    sets.insert(run.problem_set);
    contestants.insert({run.contestant, run.planner});
    const bool is_wanted =
        Wanted(lessons.sets, run.problem_set) &&
        (Wanted(lessons.contestants, run.contestant) || Wanted(lessons.contestants, run.planner));
    if (!is_wanted || !Confirmed(run)) return;
    const Path& path = run.result.result.simplified_path;
    if (path.size() < 2) return;  // It started at its goal.
    if (!FreeByMeshes(run)) {
      ++learned.num_against_meshes;
      return;
    }
    const std::optional<double> length =
        FindMeasure(run.simplified_check.verdict->measures, kLength);
    if (!length) return;
    const std::vector<std::string>& names = run.result.joint_names;  // in any order
    if (library.joints.empty()) library.joints = GroupJoints(run);
    if (!std::is_permutation(library.joints.begin(), library.joints.end(), names.begin(),
                             names.end())) {
      throw InputError(fmt::format("set '{}': its paths are of other joints than those before",
                                   run.problem_set));
    }
    const auto [best, first] = shortest.try_emplace(
        {run.problem_set, run.problem_index, run.request.scene_id}, *length, Path());
    if (first || *length < best->second.first) {
      best->second = {*length, InOrderOf(library.joints, names, path)};
    }
  });
  RequireSeen(lessons.sets, sets, "--sets");
  RequireSeen(lessons.contestants, contestants, "--contestants");
  if (shortest.empty()) {
    throw InputError(
        learned.num_against_meshes == 0
            ? "nothing to learn: no simplified path was recorded that the referee confirmed"
            : fmt::format("nothing to learn: the robot's meshes refuse every simplified path that "
                          "the referee confirmed ({})",
                          learned.num_against_meshes));
  }
  std::set<std::string> scenes;
  for (auto& [problem, path] : shortest) {
    const auto& [set, index, scene] = problem;
    if (!scene.empty()) scenes.insert(scene);
    if (library.learned_from.empty() || library.learned_from.back() != set) {
      library.learned_from.push_back(set);
    }
    library.paths.push_back(std::move(path.second));
  }
  library.scenes.assign(scenes.begin(), scenes.end());
  return learned;
}

}  // namespace planbench
