#pragma once

#include <vector>

#include "geometry/ball.h"
#include "sphere_fitting/link_body.h"

namespace planbench {

/// Balls in a link's frame, each provably inside what the link's closed meshes, boxes, cylinders
/// and spheres enclose: centre inside, no surface nearer than the radius. At most `most`, the
/// link's own spheres, which come first, among them; the others are taken one by one for what they
/// add to the volume, until they add hardly anything; none where nothing is enclosed.
std::vector<Ball> FitInnerSpheres(const LinkBody& link, int most);

}  // namespace planbench
