#include "geometry/segment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "common/random.h"

namespace planbench {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Asks, and counts, how far a point is from a box of twice these sizes.
struct CountingBox {
  Eigen::Vector3d half_size;
  int* asked;
  double operator()(const Eigen::Vector3d& p) const {
    ++*asked;
    return (p.cwiseAbs() - half_size).cwiseMax(0).norm();
  }
};

TEST(LeastOnSegment, IsTheLeastOfAllItsPoints) {
  std::mt19937_64 random(5);
  int asked = 0;
  const CountingBox box{{0.3, 0.2, 0.1}, &asked};
  for (int i = 0; i < 300; ++i) {
    Segment segment;
    for (Eigen::Vector3d* end : {&segment.a, &segment.b}) {
      for (double& x : *end) x = 2 * UniformFraction(&random) - 1;
    }
    if (i % 5 == 0) segment.b = segment.a;
    if (i % 5 == 1) segment.b.y() = segment.a.y();  // along a face
    double truth = kNoLimit;
    constexpr int kSteps = 1000;
    for (int step = 0; step <= kSteps; ++step) {
      truth = std::min(truth, box(segment.a + step * (segment.b - segment.a) / kSteps));
    }
    const double least = LeastOnSegment(segment, kNoLimit, box);
    EXPECT_LE(least, truth + 1e-12);
    EXPECT_GE(least, truth - (segment.b - segment.a).norm() / kSteps / 2);
    for (const double limit : {0.01, 0.1, least - 1e-6, least + 1e-6}) {
      EXPECT_NEAR(LeastOnSegment(segment, std::max(limit, 0.0), box),
                  std::min(least, std::max(limit, 0.0)), 1e-12);
    }
  }
}

/// Most segments are asked only whether they are nearer than what was found, or touch.
TEST(LeastOnSegment, AsksLittleOfWhatIsFurtherThanTheLimitOrTouches) {
  int asked = 0;
  const CountingBox box{{0.3, 0.2, 0.1}, &asked};
  const auto times_asked = [&](const Segment& segment, double at_most) {
    asked = 0;
    LeastOnSegment(segment, at_most, box);
    return asked;
  };
  EXPECT_EQ(times_asked({{1, 2, 3}, {1, 2, 3}}, kNoLimit), 1);
  EXPECT_EQ(times_asked({{-1, 2, 0}, {1, 2, 0}}, 0.5), 1);
  EXPECT_LE(times_asked({{-1, 0.5, 0}, {1, 0.5, 0}}, 0.01), 6);
  EXPECT_LE(times_asked({{-1, 0.3, 0}, {1, 0.1, 0.4}}, 0.01), 10);
  EXPECT_LE(times_asked({{-0.2, -1, 0}, {0.2, 0.4, 0}}, kNoLimit), 6);
}

}  // namespace
}  // namespace planbench
