#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "collision/collision_model.h"
#include "robot_model/motion_bound.h"
#include "robot_model/robot_folder.h"
#include "scene/scene.h"

namespace planbench {

/// Two bodies that touch. A body is a link, an object or an attached object, by name.
struct Contact {
  std::string body_a;  ///< A link or attached object.
  std::string body_b;
  /// Depth of the deepest pair of their shapes, m, >= 0: exact for spheres, unless closed parts of
  /// a mesh overlap (then it may be less); of other shapes how far one would have to be moved,
  /// along the best of the directions tried, to come free.
  double depth_m = 0;
  bool operator==(const Contact&) const = default;
};

/// "'arm' and 'table', 0.0120 m deep", or without a depth to tell "'arm' and 'table' in contact".
std::string Describe(const Contact& contact);

/// The two nearest bodies.
struct ClosestPair {
  double distance_m =
      0;  ///< > 0 apart; <= 0 in collision (minus the depth where the engine knows it).
  std::string body_a;  ///< Empty if there is no pair to check (distance_m is then infinity).
  std::string body_b;
};

/// A configuration on a straight joint motion, or a stretch of the motion.
struct MotionSample {
  double position;         ///< Fraction of the motion, in [0, 1].
  double half_length = 0;  ///< The stretch position +- half_length; 0 for the configuration alone.
};

/// What need not be asked again of samples.
enum class SampleRole {
  kMotion,  ///< Nothing was asked.
  /// They are cut of stretches that the last call of kMotion, of the same motion in the same scene,
  /// left blocked, none of them for certain.
  kCuts,
};

/// Verdicts on up to 64 samples, by bit.
struct SampleVerdicts {
  std::uint64_t blocked = 0;  ///< In collision, or not proven free over its whole stretch.
  std::uint64_t certain = 0;  ///< In collision at its position. A subset of `blocked`.
};

/// Decides whether configurations of a planning group collide: with the scene's objects, with
/// attached objects, and with the robot itself, over the pairs that PairRules has. Touching counts
/// as collision. Bodies are solid: one wholly inside another collides with it, as far as a mesh is
/// a closed surface. Joint limits are not its business. Public functions validate (InputError for
/// wrong sizes, values that are not finite, or a check before SetScene), the Do... functions
/// compute.
///
/// Not thread-safe: one instance a thread. Holds references to the robot and the group, which must
/// outlive it. tests/contract/collision_checker_contract.h is the suite every engine passes.
class CollisionChecker {
 public:
  virtual ~CollisionChecker() = default;
  CollisionChecker(const CollisionChecker&) = delete;
  CollisionChecker& operator=(const CollisionChecker&) = delete;

  /// Name of the engine, e.g. "fcl".
  virtual std::string_view EngineName() const = 0;
  CollisionModel model() const { return model_; }
  const Robot& robot() const { return *robot_; }
  const PlanningGroup& group() const { return *group_; }
  const JointSpace& space() const { return group_->space; }

  /// Takes the world and the positions of the joints outside the group (`base_positions`: full
  /// positions; those of the group's joints do not matter). Must be called before any check; may be
  /// called again. Throws InputError, naming the body, for what cannot be represented: an attached
  /// object on an unknown link, a mesh without triangles.
  void SetScene(const Scene& scene, std::span<const double> base_positions);

  /// True if nothing collides at q (n joints, group order, rad or m).
  bool IsFree(std::span<const double> q);
  /// free[i] = IsFree(configuration i), for `num` configurations (row-major, num x n).
  void CheckAll(std::span<const double> qs, int num, std::span<unsigned char> free);
  /// As CheckAll, but what would take the engine long may be left out: what is not free collides,
  /// what is free may collide all the same.
  void Screen(std::span<const double> qs, int num, std::span<unsigned char> free);
  /// Checks samples of a straight motion: sample k is the configuration start + position * motion
  /// (n joints, signed, rad or m), and a stretch about it is free only if provably no configuration
  /// of it collides, as far as the bounds on the motion of the geometry tell (so it may count as
  /// blocked though it is free). At most 64 samples. The engine may return once one certain
  /// collision is found; the other verdicts are then incomplete.
  SampleVerdicts CheckSamples(std::span<const double> start, std::span<const double> motion,
                              std::span<const MotionSample> samples,
                              SampleRole role = SampleRole::kMotion);
  /// Smaller of `at_most` (m, > 0) and the distance of the nearest pair, for `num` configurations;
  /// 0 or less in collision. Pairs of links that can never meet may be left out. An engine may end
  /// at a smaller distance of its own, of at least 0.5 m. May err downwards, by no more than the
  /// engine's tolerance where it is positive.
  void FindDistances(std::span<const double> qs, int num, double at_most,
                     std::span<double> distances);
  /// As FindDistances, but lower bounds that take little time, of the distances of what can be
  /// touched at all: a motion that is shorter, by motion_bound(), ends without contact. (Those of
  /// the voxels model are of cells, and may be too large by a diagonal of one.)
  void FindClearances(std::span<const double> qs, int num, double at_most,
                      std::span<double> clearances);
  /// Number of configurations or samples that are handled at once; callers that choose how many to
  /// hand over gain by multiples of it.
  virtual int BatchSize() const { return 1; }
  /// A pair of bodies in contact at q, nothing if free; the same q gives the same pair.
  std::optional<Contact> FindContact(std::span<const double> q);
  /// The nearest pair at q.
  ClosestPair FindClosest(std::span<const double> q);

  /// Bound on the motion of the geometry this engine checks, for the scene set last (attached
  /// objects included).
  const MotionBound& motion_bound() const { return motion_bound_; }

 protected:
  CollisionChecker(const Robot& robot, const PlanningGroup& group, CollisionModel model)
      : robot_(&robot), group_(&group), model_(model) {}

  /// Returns the bound on the motion of its geometry.
  virtual MotionBound DoSetScene(const Scene& scene, std::span<const double> base_positions) = 0;
  virtual bool DoIsFree(std::span<const double> q) = 0;
  /// The default asks DoIsFree.
  virtual void DoCheckAll(std::span<const double> qs, int num, std::span<unsigned char> free);
  /// The default asks DoCheckAll.
  virtual void DoScreen(std::span<const double> qs, int num, std::span<unsigned char> free);
  /// The default asks DoIsFree and DoFindClosest.
  virtual SampleVerdicts DoCheckSamples(std::span<const double> start,
                                        std::span<const double> motion,
                                        std::span<const MotionSample> samples, SampleRole role);
  /// The default asks DoFindClosest.
  virtual void DoFindDistances(std::span<const double> qs, int num, double at_most,
                               std::span<double> distances);
  /// The default asks DoFindDistances.
  virtual void DoFindClearances(std::span<const double> qs, int num, double at_most,
                                std::span<double> clearances);
  virtual std::optional<Contact> DoFindContact(std::span<const double> q) = 0;
  virtual ClosestPair DoFindClosest(std::span<const double> q) = 0;

 private:
  void RequireReady(std::span<const double> qs, int num) const;
  void RequireVerdicts(std::span<const double> qs, int num,
                       std::span<const unsigned char> free) const;
  void RequireRoom(std::span<const double> qs, int num, double at_most,
                   std::span<double> distances) const;

  const Robot* robot_;
  const PlanningGroup* group_;
  CollisionModel model_;
  MotionBound motion_bound_;
  bool has_scene_ = false;
};

/// The fastest engine for a model. A further engine has a folder of its own, derives from
/// CollisionChecker, takes the pairs to check from PairRules (pair_rules.h) and the poses from
/// RigidBodies (rigid_bodies.h), is instantiated in the contract suite
/// (tests/collision/engines_contract_test.cc), and is returned from here for the model it serves.
/// Throws InputError if the robot lacks the geometry (spheres or mesh files).
std::unique_ptr<CollisionChecker> MakeCollisionChecker(const Robot& robot,
                                                       const PlanningGroup& group,
                                                       CollisionModel model);

/// The engine that is exact, in double precision, where the model has one: for verdicts on what
/// others have found. Throws as MakeCollisionChecker does.
std::unique_ptr<CollisionChecker> MakeReferenceChecker(const Robot& robot,
                                                       const PlanningGroup& group,
                                                       CollisionModel model);

/// The vector instructions that engines use on this machine, chosen at run time: "SSE4", "AVX2",
/// "AVX-512", "NEON", or another name of Highway's.
std::string VectorInstructions();

}  // namespace planbench
