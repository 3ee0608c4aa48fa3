#pragma once

#include <string>
#include <vector>

#include "robot_model/robot_model.h"

namespace planbench {

/// A sphere model, sorted by link, as text that ReadLinkSpheres reads.

/// spheres.yaml; `comment` is its first lines, without "# ".
std::string SpheresYaml(const RobotModel& model, const std::vector<LinkSphere>& spheres,
                        const std::vector<std::string>& comment);
/// An SRDF that holds nothing but <link_sphere_approximation> elements.
std::string SpheresSrdf(const RobotModel& model, const std::vector<LinkSphere>& spheres);
/// The URDF with the spheres as the only collision geometry. `urdf_text` is that of the model.
std::string SpheresUrdf(const std::string& urdf_text, const RobotModel& model,
                        const std::vector<LinkSphere>& spheres);

}  // namespace planbench
