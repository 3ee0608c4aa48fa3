#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geometry/ball.h"
#include "scene/scene.h"

namespace planbench {

/// A small ball that encloses all of the given ones (at least one), up to rounding: with so many
/// steps a 1.01-approximation by Badoiu and Clarkson's iteration (Optimal core-sets for balls,
/// 2008), with fewer one that is larger.
Ball EnclosingBall(std::span<const Ball> balls, int num_steps = 200);

/// Sorts balls along the longest extent of their centres; returns the number of those in the first
/// half.
std::size_t Halve(std::span<Ball> balls);

/// Balls around the shapes of an object, in the frame that the object's pose is given in.
std::vector<Ball> BallsAround(const SceneObject& object);

}  // namespace planbench
