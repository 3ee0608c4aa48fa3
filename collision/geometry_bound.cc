#include "collision/geometry_bound.h"

#include <utility>

#include "collision/balls.h"
#include "collision/rigid_bodies.h"

namespace planbench {

MotionBound GeometryBound::Compute(const Scene& scene, std::span<const double> base_positions) {
  if (scene.attached.empty()) {
    std::vector<double> held = HeldPositions(*model_, *group_, base_positions);
    if (held != held_) {
      robot_bound_ = MotionBound(*model_, *group_, held, geometry_);
      held_ = std::move(held);
    }
    return robot_bound_;
  }
  std::vector<LinkSphere> all = geometry_;
  for (const AttachedObject& attached : scene.attached) {
    const int link = model_->FindLink(attached.link);
    for (const Ball& ball : BallsAround(attached.object)) {
      all.push_back({link, ball.center, ball.radius});
    }
  }
  return MotionBound(*model_, *group_, base_positions, all);
}

}  // namespace planbench
