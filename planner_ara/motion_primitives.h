#pragma once

#include <string>
#include <vector>

namespace planbench {

/// Moves between lattice points, in multiples of the lattice's discretisation, one a row and one
/// coordinate a joint in group order. Each row also stands for its negation.
struct MotionPrimitives {
  std::vector<std::vector<int>> long_moves;
  std::vector<std::vector<int>> short_moves;
};

/// Reads SMPL's text format: the line "Motion_Primitives(degrees): ROWS COLUMNS NUM_SHORT", then
/// ROWS rows of COLUMNS integers; the last NUM_SHORT rows are the short moves. (The word "degrees"
/// notwithstanding, SMPL takes the numbers as multiples of the discretisation, and so does this.)
/// Throws InputError with `origin` and line for counts that do not hold, anything but integers,
/// rows of zeros, no rows, and COLUMNS other than `num_joints`.
MotionPrimitives ParseMotionPrimitives(const std::string& text, const std::string& origin,
                                       int num_joints);
/// The same from a file.
MotionPrimitives LoadMotionPrimitives(const std::string& path, int num_joints);

}  // namespace planbench
