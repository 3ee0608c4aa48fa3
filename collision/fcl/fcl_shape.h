#pragma once

#include <Eigen/Core>
#include <memory>

#include "collision/rigid_bodies.h"
#include "geometry/segment.h"
#include "geometry/shapes.h"

namespace planbench {

/// A shape as FCL sees it: the one place (with its .cc) where FCL is used. Shapes are solid.
/// Touching counts as collision. Distances are signed: minus the depth inside for spheres against
/// any shape, 0 for other pairs in collision; their depth, which FCL does not give reliably, is
/// searched for when asked.
///
/// FCL's own view of a mesh is its surface; what lies wholly inside a closed one is found here by
/// ray parity. A mesh that is not closed remains a surface.
///
/// FCL is not asked where it has no distances (half-spaces: how far the other shape reaches down is
/// exact and simpler), has wrong ones (balls near thin triangles; triangles that are but lines or
/// points) or ends the process (distances of capsules that just touch).
class FclShape {
 public:
  /// Throws InputError naming `owner` if the shape has a negative or non-finite size, or is a mesh
  /// without triangles.
  FclShape(const Shape& shape, const std::string& owner);
  ~FclShape();
  FclShape(FclShape&&) noexcept;

  /// Bounding box along the axes of the shape's frame; infinite for a half-space.
  const Eigen::Vector3d& box_center() const { return box_center_; }
  const Eigen::Vector3d& box_half_size() const { return box_half_size_; }
  const BoundingSphere& bounding_sphere() const { return bounding_sphere_; }

  /// A ball in the shape's frame.
  bool TouchesBall(const Eigen::Vector3d& center, double radius) const;
  double BallDistance(const Eigen::Vector3d& center, double radius) const;

  /// Another shape, at pose X_SO in this shape's frame. Distance gives the smaller of the distance
  /// and `at_most`, sooner for a small `at_most`.
  bool Touches(const FclShape& other, const Pose& X_SO) const;
  double Distance(const FclShape& other, const Pose& X_SO, double at_most) const;
  /// How far another shape, which touches this one, has to be moved to come free, m: exact if one
  /// of them is a sphere, else along the best of the directions tried, so not less than the least.
  double Depth(const FclShape& other, const Pose& X_SO) const;

 private:
  struct Geometry;
  bool Contains(const FclShape& other, const Pose& X_SO) const;
  /// How far a segment in the shape's frame, or `at_most` if that is less; 0 in solids, but of
  /// meshes from their surface.
  double SegmentDistance(const Segment& segment, double at_most) const;
  /// By FCL: of what lines and points are not.
  double FaceDistance(const FclShape& other, const Pose& X_SO, double at_most) const;
  /// The least distance of the lines and points that either shape has from the other, or `at_most`;
  /// 0 if they touch.
  double LineDistance(const FclShape& other, const Pose& X_SO, double at_most) const;

  std::unique_ptr<Geometry> geometry_;
  BoundingSphere bounding_sphere_;
  Eigen::Vector3d box_center_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d box_half_size_ = Eigen::Vector3d::Zero();
};

/// Signed distance of a point from a cone (see Cone), negative inside. FCL has only an iterative
/// one.
double ConeDistance(const Cone& cone, const Eigen::Vector3d& point);

}  // namespace planbench
