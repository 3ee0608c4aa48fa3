#include "collision/balls.h"

#include <algorithm>

namespace planbench {

Ball EnclosingBall(std::span<const Ball> balls, int num_steps) {
  Ball enclosing = balls.front();
  Eigen::Vector3d center = enclosing.center;
  enclosing.radius = -1;
  for (int i = 0; i < num_steps; ++i) {
    const Ball* far = &balls.front();
    double radius = -1;
    for (const Ball& ball : balls) {
      const double reach = (ball.center - center).norm() + ball.radius;
      if (reach <= radius) continue;
      far = &ball;
      radius = reach;
    }
    const Eigen::Vector3d to_far = far->center - center;
    const double distance = radius - far->radius;
    if (enclosing.radius < 0 || radius < enclosing.radius) enclosing = {center, radius};
    if (distance < 1e-12) break;
    // Towards the far side of the farthest ball.
    center += to_far * (radius / distance / (i + 2));
  }
  return enclosing;
}

std::size_t Halve(std::span<Ball> balls) {
  Eigen::Vector3d low = balls.front().center;
  Eigen::Vector3d high = low;
  for (const Ball& ball : balls) {
    low = low.cwiseMin(ball.center);
    high = high.cwiseMax(ball.center);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::stable_sort(balls.begin(), balls.end(), [axis](const Ball& a, const Ball& b) {
    return a.center[axis] < b.center[axis];
  });
  return balls.size() / 2;
}

std::vector<Ball> BallsAround(const SceneObject& object) {
  std::vector<Ball> balls;
  for (const PlacedShape& placed : object.shapes) {
    const BoundingSphere bound = ComputeBoundingSphere(placed.shape);
    balls.push_back({object.X_WO * (placed.X_FS * bound.center), bound.radius});
  }
  return balls;
}

}  // namespace planbench
