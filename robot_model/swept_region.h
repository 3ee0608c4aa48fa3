#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace planbench {

/// A region of space that contains every position a point fixed to a link can take while the joints
/// between the link and the frame at hand move: a solid of revolution about the last revolute axis
/// (interval along the axis, largest radius about it), cut with a ball about a point of that axis,
/// then spread along the travel of the prismatic joints crossed since. Revolute joints count as
/// turning freely.
///
/// Carried from a link towards the root it gives the reach of every joint on the way: interval and
/// ball together stay tight where either alone grows (interval: along crossing axes; ball: across
/// an arm's bends).
class SweptRegion {
 public:
  /// A point at rest.
  explicit SweptRegion(const Eigen::Vector3d& point);

  /// Expresses the region in frame P, of which its present frame C has pose X_PC.
  void Transform(const Eigen::Isometry3d& X_PC);
  /// Lets a revolute joint turn the region about the axis through `origin` along `axis` (unit).
  /// Returns the largest distance of the region from the axis, m.
  double Revolve(const Eigen::Vector3d& origin, const Eigen::Vector3d& axis);
  /// Lets a prismatic joint carry the region along `axis` (unit) from `lower` to `upper`, m.
  void Slide(const Eigen::Vector3d& axis, double lower, double upper);

 private:
  /// The corners of the travel of the prismatic joints crossed, one displacement each.
  std::vector<Eigen::Vector3d> TravelCorners() const;

  Eigen::Vector3d origin_;  // Of the axis; intervals count from here.
  Eigen::Vector3d axis_ = Eigen::Vector3d::UnitX();
  double lower_ = 0;  // Interval along the axis.
  double upper_ = 0;
  double radius_ = 0;       // About the axis.
  double ball_center_ = 0;  // Along the axis.
  double ball_radius_ = 0;
  std::vector<Eigen::Vector3d> half_travels_;
};

/// Upper bound, tight to rounding, of |w + r e| over all points e of the ellipse with semi-axes 1
/// along x and s <= 1 along y.
double MaxDistanceToEllipse(const Eigen::Vector2d& w, double r, double s);

}  // namespace planbench
