#include "sphere_fitting/center_fit.h"

#include <gtest/gtest.h>

#include <vector>

#include "sphere_fitting/link_body.h"

namespace planbench {
namespace {

// Samples of centres that have stayed are not tried against others that have.
TEST(CenterFitTest, EverySampleIsOfTheCentreThatServesItBestWhicheverHaveMoved) {
  LinkBody body;
  body.Add({Box{{0.4, 0.3, 0.2}}, Eigen::Isometry3d::Identity()});
  CenterFit fit(body, 400);
  const auto expect_best = [&fit](const char* after) {
    const double worst = fit.Worst();
    const std::vector<Ball> balls = fit.Balls();
    fit.AddSamples({});  // All are given anew, against all centres.
    EXPECT_EQ(fit.Worst(), worst) << after;
    const std::vector<Ball> anew = fit.Balls();
    ASSERT_EQ(anew.size(), balls.size()) << after;
    for (std::size_t k = 0; k < balls.size(); ++k) {
      EXPECT_EQ(anew[k].radius, balls[k].radius) << after << ", ball " << k;
    }
  };
  for (int size = 2; size <= 20; ++size) {
    fit.Grow();
    expect_best("growing");
  }
  fit.Improve(5);
  expect_best("improving");
  fit.Shrink(4);
  fit.Improve(1);
  expect_best("shrinking");
}

}  // namespace
}  // namespace planbench
