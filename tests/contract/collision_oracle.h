#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "geometry/polyhedra.h"
#include "geometry/shapes.h"
#include "robot_model/robot_folder.h"
#include "scene/scene.h"

namespace planbench {

/// Within this distance of contact a verdict of the vectorised engine may err towards collision, m.
inline constexpr double kBand_m = 1e-4;

/// Signed distance of a point from a solid shape, negative inside, by formulas written for the
/// tests alone. A mesh must be closed, but for triangles that are lines and points.
double OracleDistance(const Shape& shape, const Eigen::Vector3d& point);

/// The least value of a convex function on a line, found among 41 places again and again.
double OracleLeastAlong(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        const std::function<double(const Eigen::Vector3d&)>& convex);

/// What two bodies that must be checked against each other are apart: minus the depth of their
/// deepest pair of spheres or shapes if they collide.
struct OraclePair {
  std::string body_a;
  std::string body_b;
  double distance_m;
};

/// Every pair of bodies to check at a configuration of the group, brute force: all spheres against
/// all shapes and all other spheres, poses by ComputeLinkPoses, the rules of which pairs count
/// written out again. Of two shapes that meet (attached objects) one must be a sphere.
std::vector<OraclePair> OraclePairs(const Robot& robot, const PlanningGroup& group,
                                    const Scene& scene, std::span<const double> base_positions,
                                    std::span<const double> q);
/// The least of the distances, infinity without a pair.
double OracleClearance(const std::vector<OraclePair>& pairs);

/// The base positions with the group's joints at q.
std::vector<double> WithGroupAt(const Robot& robot, const PlanningGroup& group,
                                std::span<const double> base_positions, std::span<const double> q);
/// Uniform within the limits.
std::vector<double> RandomConfiguration(const JointSpace& space, std::mt19937_64* generator);
Eigen::Isometry3d RandomPose(std::mt19937_64* generator, double range_m);

}  // namespace planbench
