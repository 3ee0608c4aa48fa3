#include "collision/geometry_bound.h"

#include <algorithm>
#include <utility>

#include "collision/at.h"
#include "collision/balls.h"
#include "collision/rigid_bodies.h"

namespace planbench {

GeometryBound::GeometryBound(const RobotModel& model, const PlanningGroup& group,
                             const std::vector<LinkSphere>& geometry)
    : model_(&model), group_(&group), geometry_(static_cast<std::size_t>(model.num_links())) {
  for (const LinkSphere& ball : geometry) At(geometry_, ball.link).push_back(ball);
}

void GeometryBound::Set(const Scene& scene, std::span<const double> base_positions) {
  std::vector<double> held = HeldPositions(*model_, *group_, base_positions);
  if (links_.empty() || held != held_) {
    links_.clear();
    for (const auto& balls : geometry_) links_.emplace_back(*model_, *group_, held, balls);
    held_ = std::move(held);
  }
  attached_.clear();
  for (const AttachedObject& attached : scene.attached) {
    const int link = model_->FindLink(attached.link);
    std::vector<LinkSphere> balls;
    for (const Ball& ball : BallsAround(attached.object)) {
      balls.push_back({link, ball.center, ball.radius});
    }
    attached_.emplace_back(*model_, *group_, base_positions, balls);
  }
}

MotionBound GeometryBound::OfAll() const {
  std::vector<double> reach(group_->joints.size(), 0.0);
  for (const auto* bounds : {&links_, &attached_}) {
    for (const MotionBound& bound : *bounds) {
      for (std::size_t j = 0; j < reach.size(); ++j) {
        reach[j] = std::max(reach[j], bound.reach()[j]);
      }
    }
  }
  return MotionBound(std::move(reach));
}

}  // namespace planbench
