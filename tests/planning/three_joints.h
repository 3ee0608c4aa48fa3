#pragma once

#include "common/numbers.h"
#include "robot_model/joint_space.h"

namespace planbench {

/// A continuous joint and two bounded ones.
inline JointSpace ThreeJoints() {
  return JointSpace({{"turn", true, false, -kPi, kPi, 1},
                     {"bend", false, false, -10, 10, 1},
                     {"slide", false, true, -10, 10, 1}});
}

}  // namespace planbench
