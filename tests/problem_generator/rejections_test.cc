#include "problem_generator/rejections.h"

#include <gtest/gtest.h>

namespace planbench {
namespace {

TEST(Rejections, OfMissesTheLeastByWhatIsAllowedIsTold) {
  IkOptions allowed;
  allowed.position_tolerance_m = 0.001;
  allowed.orientation_tolerance_rad = 0.1;
  Rejections rejections;
  rejections.Add("reach", "goal", {0.002, 0, allowed});
  Rejections more;
  more.Add("reach", "goal", {0, 0.15, allowed});
  rejections.Add(more);
  rejections.Add("reach", "goal", {0.003, 0, allowed});
  EXPECT_EQ(rejections.Summary(),
            "reach 3 (nearest: 0 m and 0.15 rad off; 0.001 m and 0.1 rad are allowed)");
}

}  // namespace
}  // namespace planbench
