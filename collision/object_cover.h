#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "collision/balls.h"
#include "scene/scene.h"

namespace planbench {

/// In the shape's frame; not of a half-space.
Eigen::AlignedBox3d BoxAround(const Shape& shape);

/// Small balls that together hold an object (without half-spaces), in the frame that its pose is
/// given in: one a shape, and as long as these are no more than `most`, more of smaller ones.
std::vector<Ball> CoverOf(const SceneObject& object, std::size_t most);

/// The radius of a ball about a point of that frame that is inside of the object, m; 0 or less
/// where none is known.
double DepthIn(const SceneObject& object, const Eigen::Vector3d& point);

}  // namespace planbench
