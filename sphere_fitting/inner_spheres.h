#pragma once

#include <vector>

#include "geometry/ball.h"
#include "sphere_fitting/link_body.h"

namespace planbench {

/// Balls in a link's frame, each provably inside what the link's closed meshes, boxes, cylinders
/// and spheres enclose: centre inside, no surface nearer than the radius. The link's own spheres
/// come first, all of them, however many; the others are taken one by one for what they add to the
/// volume, until there are `most` in all or they add hardly anything; none where nothing is
/// enclosed.
std::vector<Ball> FitInnerSpheres(const LinkBody& link, int most);

}  // namespace planbench
