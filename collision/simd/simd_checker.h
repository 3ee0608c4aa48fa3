#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collision/collision_checker.h"
#include "collision/fcl/fcl_checker.h"
#include "collision/simd/compiled_scene.h"
#include "collision/simd/kernels/sphere_kernel.h"

namespace planbench {

/// The vectorised engine: many configurations at once, one SIMD lane each, in single precision
/// (kernels/sphere_kernel.h).
///
/// Its verdict is that of exact geometry wherever the exact distance is more than 0.1 mm from zero,
/// for robots that reach up to about 5 m; nearer than that it errs towards collision. What the
/// kernels do not know (some attached objects, prismatic joints far beyond their limits, objects of
/// tens of metres that are not boxes, cones against triangles) they pass on as doubts, which the
/// FCL engine decides, over the pairs that are in doubt; it also names contacts and nearest pairs,
/// in double precision.
///
/// Meshes: balls around the triangles of a link stand for its spheres; where one touches, planes
/// between hulls are looked for, and triangles decide.
///
/// Voxels: a sphere collides with the world if the distance field's value at its centre is less
/// than its radius. A stretch of a motion is free if no cell that a sphere's centre can reach on it
/// has such a value. Links that the group does not move are not checked against the field, and a
/// field cannot tell objects apart: the allowed-collision matrix's entries for objects do not
/// count. Attached objects are checked against the exact shapes. The grid is Robot::voxels, else
/// one that covers the robot's reach at 0.02 m.
class SimdChecker : public CollisionChecker {
 public:
  /// Throws InputError as FclChecker does, and for a grid that is too large.
  SimdChecker(const Robot& robot, const PlanningGroup& group,
              CollisionModel model = CollisionModel::kSpheres);

  std::string_view EngineName() const override { return "simd"; }
  int BatchSize() const override { return kernels::kBlock; }

 protected:
  MotionBound DoSetScene(const Scene& scene, std::span<const double> base_positions) override;
  bool DoIsFree(std::span<const double> q) override;
  void DoCheckAll(std::span<const double> qs, int num, std::span<unsigned char> free) override;
  void DoScreen(std::span<const double> qs, int num, std::span<unsigned char> free) override;
  SampleVerdicts DoCheckSamples(std::span<const double> start, std::span<const double> motion,
                                std::span<const MotionSample> samples, SampleRole role) override;
  void DoFindDistances(std::span<const double> qs, int num, double at_most,
                       std::span<double> distances) override;
  void DoFindClearances(std::span<const double> qs, int num, double at_most,
                        std::span<double> clearances) override;
  std::optional<Contact> DoFindContact(std::span<const double> q) override;
  ClosestPair DoFindClosest(std::span<const double> q) override;

 private:
  using LaneMask = kernels::LaneMask;

  FclChecker& Exact();
  /// Puts the first `num` configurations into lanes. Returns the lanes that the kernels cannot
  /// judge: what was left out because it cannot be reached is so within the limits only.
  LaneMask SetLanes(std::span<const double> rows, int num);
  /// Puts joints that turn further than once on a motion into lanes again, in double precision: as
  /// floats, positions and whole turns are not exact enough there.
  void PlaceManyTurns(std::span<const double> start, std::span<const double> motion,
                      std::span<const MotionSample> samples);
  /// Checks the first `num` lanes; `exact(lane, pairs)` is the verdict of the FCL engine (in bit
  /// 0), asked of all pairs for lanes in `unfit`, and of those in doubt where there are doubts.
  template <typename Judge>
  kernels::BlockVerdict Check(int num, LaneMask unfit, const float* half_widths, bool stop_at_first,
                              Judge exact, kernels::Tests tests = kernels::Tests::kAll);
  void CheckRows(std::span<const double> qs, int num, kernels::Tests tests,
                 std::span<unsigned char> free);
  /// Whether something is not made of balls: then those around it are but a lower bound of
  /// distances.
  bool HasPatches() const { return !compiled_.robot().patches.empty(); }
  /// Distances, where something is not made of balls lower bounds of those of surfaces; at most
  /// `most`.
  void FindBounds(std::span<const double> qs, int num, double most, std::span<double> distances);
  /// Of meshes: the largest of some margins, at most so large, that nothing is within.
  double MarginAround(std::span<const double> q, double at_most);
  double PatchDistance(std::span<const double> q, double at_most);
  double ExactDistance(std::span<const double> q, double at_most);
  /// The distance of a tree from the field alone, at most CompiledWorld::kMaxDistance.
  double FieldDistance(const CompiledTree& tree, std::span<const double> q);
  std::pair<double, std::string> NearestToField(std::span<const double> q);

  kernels::Joints joints_;  ///< Limits with kLimitTolerance added; infinite for continuous ones.
  FclChecker exact_;
  CompiledScene compiled_;
  bool always_collides_ = false;
  bool exact_is_set_ = false;  ///< exact_ has the scene.

  // Scratch.
  kernels::SphereScratch scratch_;
  std::vector<float> q_;            ///< Of the block at hand, [joint][kBlock].
  std::vector<float> half_widths_;  ///< Likewise.
  std::vector<float> start_, motion_;
};

}  // namespace planbench
