#include "robot_tools/link_balls.h"

#include <algorithm>
#include <limits>

namespace planbench {
namespace {

bool Meet(const Ball& a, const Ball& b) {
  const double reach = a.radius + b.radius;
  return (a.center - b.center).squaredNorm() <= reach * reach;
}

}  // namespace

LinkBalls BallsOfLink(const std::vector<LinkSphere>& spheres, int link) {
  LinkBalls of_link{{}, {Eigen::Vector3d::Zero(), 0}};
  for (const LinkSphere& sphere : spheres) {
    if (sphere.link != link) continue;
    of_link.balls.push_back({sphere.p_LS, sphere.radius});
    of_link.around.center += sphere.p_LS;
  }
  if (of_link.balls.empty()) return of_link;
  of_link.around.center /= static_cast<double>(of_link.balls.size());
  for (const Ball& ball : of_link.balls) {
    of_link.around.radius =
        std::max(of_link.around.radius, (ball.center - of_link.around.center).norm() + ball.radius);
  }
  return of_link;
}

LeastGap FindLeastGap(const LinkBalls& link_a, const LinkBalls& link_b,
                      const Eigen::Isometry3d& X_AB) {
  LeastGap least{std::numeric_limits<double>::infinity(), 0, 0};
  for (std::size_t b = 0; b < link_b.balls.size(); ++b) {
    const Eigen::Vector3d center = X_AB * link_b.balls[b].center;
    const double radius = link_b.balls[b].radius;
    const Ball& around = link_a.around;
    if ((center - around.center).norm() - around.radius - radius >= least.gap_m) continue;
    for (std::size_t a = 0; a < link_a.balls.size(); ++a) {
      const Ball& ball = link_a.balls[a];
      const double gap = (center - ball.center).norm() - ball.radius - radius;
      if (gap < least.gap_m) least = {gap, a, b};
    }
  }
  return least;
}

bool BallsTouch(const LinkBalls& link_a, const LinkBalls& link_b, const Eigen::Isometry3d& X_AB) {
  if (!Meet(link_a.around, {X_AB * link_b.around.center, link_b.around.radius})) return false;
  for (const Ball& b : link_b.balls) {
    const Ball moved{X_AB * b.center, b.radius};
    for (const Ball& a : link_a.balls) {
      if (Meet(a, moved)) return true;
    }
  }
  return false;
}

}  // namespace planbench
