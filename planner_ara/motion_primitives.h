#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "common/named_file.h"
#include "common/yaml.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// Rows that a graph has room for, both lists together: each stands for two edges of a state, which
/// ManipulationGraph numbers in 15 bits, beside a few others.
inline constexpr std::size_t kMostPrimitives = 16000;

/// Moves between lattice points, in multiples of the lattice's discretisation, one a row and one
/// coordinate a joint in group order. Each row also stands for its negation.
struct MotionPrimitives {
  std::vector<std::vector<int>> long_moves;
  std::vector<std::vector<int>> short_moves;

  std::size_t size() const { return long_moves.size() + short_moves.size(); }
};

/// Reads SMPL's text format: the line "Motion_Primitives(degrees): ROWS COLUMNS NUM_SHORT", then
/// ROWS rows of COLUMNS integers; the last NUM_SHORT rows are the short moves. (The word "degrees"
/// notwithstanding, SMPL takes the numbers as multiples of the discretisation, and so does this.)
/// Throws InputError with `origin` and line for counts that do not hold, anything but integers,
/// rows of zeros, no rows or more than kMostPrimitives, and COLUMNS other than `num_joints`.
MotionPrimitives ParseMotionPrimitives(const std::string& text, const std::string& origin,
                                       int num_joints);

/// Reads the same moves with their units:
///
///   angle_unit: deg         # or rad; of revolute and continuous joints
///   length_unit: m          # or mm; of prismatic joints
///   long:                   # either list may be left out, not both
///     - {shoulder_pan_joint: 20, shoulder_lift_joint: -20}   # joints not named do not move
///   short:
///     - {shoulder_pan_joint: 10}
///
/// Throws InputError with file, line and key for unknown joints, moves that are no whole multiples
/// of the discretisation (n joints, rad or m; to 1 % of a cell), moves of nothing, lists without
/// moves, and more than kMostPrimitives.
MotionPrimitives ReadMotionPrimitives(const YamlNode& node, const JointSpace& space,
                                      std::span<const double> discretization);

/// The moves of a file: the YAML form if its name ends in .yaml or .yml, SMPL's if not.
MotionPrimitives PrimitivesOfFile(const NamedFile& file, const JointSpace& space,
                                  std::span<const double> discretization);

}  // namespace planbench
