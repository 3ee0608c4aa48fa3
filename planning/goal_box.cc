#include "planning/goal_box.h"

#include <cstddef>

namespace planbench {

bool GoalBox::Contains(const JointSpace& space, std::span<const double> q) const {
  for (int j = 0; j < space.size(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    const double offset = space.Difference(j, nominal[k], q[k]);
    // Written so that NaN is outside.
    if (!(offset >= lower[k] - nominal[k] - kRounding)) return false;
    if (!(offset <= upper[k] - nominal[k] + kRounding)) return false;
  }
  return true;
}

}  // namespace planbench
