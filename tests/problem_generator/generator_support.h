#pragma once

#include <string>

#include "problem_generator/problem_spec.h"
#include "scene/moveit_yaml.h"
#include "tests/support/planning_problems.h"
#include "tests/support/temporary_folder.h"

namespace planbench {

inline std::filesystem::path ShippedProblems() {
  return std::filesystem::path(PLANBENCH_SOURCE_DIR) / "problems";
}

/// A folder with the Fetch's setup file, for specifications that a test writes.
class SpecFolder {
 public:
  SpecFolder() {
    std::filesystem::copy_file(ShippedProblems() / "fetch_setup.yaml",
                               folder_ / "fetch_setup.yaml");
  }
  std::filesystem::path Write(const std::string& text) const {
    return folder_.Write("spec.yaml", text);
  }
  ProblemSpec Load(const std::string& text, const Robot& robot) const {
    return LoadProblemSpec(Write(text), robot);
  }
  const std::filesystem::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

/// A can on a table, with little effort allowed. Line 9 begins the table, line 12 the can, line 17
/// the query, lines 18 and 19 are its ends.
inline const std::string kCanOnTable = R"(setup: fetch_setup.yaml
clearance: 0.005
object_gap: 0.02
min_joint_distance: 1
effort: {scenes: 20, poses: 2, solutions: 4, ik_starts: 5}

objects:
  # A table.
  - id: table
    position: [1.0, 0, [0.6, 0.8]]
    parts: [{name: top, box: [1.0, 1.0, 0.04]}]
  - id: can
    stands_on: table.top
    position: [-0.3, [-0.2, 0.2]]
    parts: [{cylinder: [0.12, 0.03]}]
queries:
  - name: approach
    start: {configuration: tuck}
    goal: {gripper: {object: can, position: [-0.0335, 0, 0.03], position_tolerance: 0.01}}
)";

/// The right hand of the two arms (tests/support/two_arm_robot.h, with a torso) beside a post.
/// Writes the setup beside it.
inline std::filesystem::path WriteTwoArmSpec(const TemporaryFolder& folder,
                                             const std::string& tip = "tip: right_hand, ") {
  folder.Write("two_arms_setup.yaml", R"(robot: two_arms
group: both
rest: {left_shoulder: 1.2, left_elbow: -0.5, right_elbow: 2}
configurations:
  ready: {torso: 0, left_shoulder: 0, left_elbow: 0, right_shoulder: -1.5, right_elbow: 0}
)");
  return folder.Write("two_arms.yaml", R"(setup: two_arms_setup.yaml
clearance: 0.005
object_gap: 0
min_joint_distance: 0
effort: {scenes: 5, poses: 1, solutions: 4, ik_starts: 50}
objects:
  - {id: post, position: [0.5, -0.8, 0], parts: [{sphere: 0.1}]}
queries:
  - name: reach
    start: {configuration: ready}
    goal: {gripper: {)" + tip + "object: post, position: [0.2, 0.45, 0]}}\n");
}

/// kCanOnTable with the only occurrence of a text replaced.
inline std::string CanOnTableWith(const std::string& text, const std::string& replacement) {
  std::string spec = kCanOnTable;
  const std::size_t at = spec.find(text);
  if (at == std::string::npos || spec.find(text, at + 1) != std::string::npos) {
    throw std::logic_error("'" + text + "' does not occur exactly once");
  }
  return spec.replace(at, text.size(), replacement);
}

}  // namespace planbench
