#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/ball.h"
#include "sphere_fitting/link_body.h"

namespace planbench {

/// Proves that balls together contain a link's meshes, boxes and cylinders, and finds where they do
/// not.
///
/// Surfaces: a triangle within one ball (its corners are) is covered; any other is halved, and its
/// halves are looked at in turn. Insides: the surface being covered, what is left bare of the
/// inside is voids, parts of space that balls alone bound. The highest point of a void (in any
/// direction) lies on three spheres at least: were it on one or two, it could be left along them,
/// away from all balls, without going down. So there is no void if every point in which three
/// spheres meet is outside the body or within another ball. Both tests have margins above rounding,
/// and err towards "not covered".
class CoverProof {
 public:
  explicit CoverProof(const LinkBody& body);

  /// Points of the body that are in no ball, found down to pieces of `resolution_m`; of those in
  /// one cell of a grid of edges of `apart_m` the first. Not every such point, and no proof.
  std::vector<Eigen::Vector3d> FindBarePoints(const std::vector<Ball>& balls, double resolution_m,
                                              double apart_m) const;
  /// Enlarges balls, by as little as pieces of resolution() need, until they provably contain the
  /// body. Radii that grow are rounded up to whole micrometres. Needs one ball at least.
  void Close(std::vector<Ball>* balls) const;
  /// True if the balls provably contain the body: nothing would be enlarged.
  bool Holds(const std::vector<Ball>& balls) const;
  double resolution() const { return resolution_m_; }

 private:
  std::vector<Eigen::Vector3d> VoidCorners(std::span<const Ball> balls) const;
  Eigen::Vector3d InVoid(std::span<const Ball> balls, const Eigen::Vector3d& corner) const;

  const LinkBody& body_;
  double resolution_m_;
};

}  // namespace planbench
