#pragma once

#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "collision/collision_model.h"
#include "collision/geometry_bound.h"
#include "collision/link_geometry.h"
#include "collision/pair_rules.h"
#include "collision/simd/compiled_robot.h"
#include "collision/simd/compiled_world.h"
#include "collision/simd/kernels/sphere_kernel.h"
#include "collision/simd/robot_meshes.h"
#include "collision/voxels/distance_field.h"
#include "robot_model/robot_folder.h"
#include "scene/scene.h"

namespace planbench {

/// A robot in a scene as the kernels take it: what a check reads. Only Set changes it; between
/// calls of Set any number of threads may check against it, each with scratch of its own. Holds
/// references to the robot and the group.
class CompiledScene {
 public:
  /// Pairs of bodies that do not move relative to each other.
  struct Standing {
    bool collide = false;
    bool doubtful = false;  ///< Some of them are for the exact engine to judge.
    double distance_m = 0;  ///< Of the nearest; at most CompiledWorld::kMaxDistance or infinite.
  };

  /// Throws InputError for a mesh that cannot be read; all shapes of the robot must be solid.
  CompiledScene(const Robot& robot, const PlanningGroup& group, CollisionModel model);

  /// Compiles anew; what depends on the held joints, the allowed-collision matrix or the attached
  /// objects alone is kept while they stay. Throws InputError as PairRules and RequireSolid do, and
  /// for a voxel grid that is too large. `collides`: whether the exact engine has the robot and
  /// what is attached to it, in a scene without objects, always collide; asked when these have
  /// changed.
  void Set(const Scene& scene, std::span<const double> base_positions,
           const std::function<bool(const Scene&)>& collides);

  /// What was set last.
  const Scene& scene() const { return scene_; }
  const std::vector<double>& base_positions() const { return base_positions_; }

  const kernels::SphereRobot& robot() const { return compiled_robot_->kernel; }
  const kernels::SphereWorld& world() const { return world_.kernel; }
  /// Of every link that has spheres or meshes, in link order.
  const std::vector<CompiledTree>& links() const { return compiled_robot_->links; }
  const Standing& standing() const { return standing_; }
  /// By object of the scene: whether the kernels know no more than bounds of some of its shapes.
  std::vector<unsigned char> DoubtfulObjects() const {
    return world_.DoubtfulObjects(scene_.objects.size());
  }
  const MotionBound& motion_bound() const { return motion_bound_; }

 private:
  CompiledScene(const Robot& robot, const PlanningGroup& group, CollisionModel model,
                const std::vector<LinkGeometry>& geometry);

  void CompilePairs(const PairRules& rules);
  bool StandingMeshesCollide() const;
  void AttachObjects(const PairRules& rules, const std::function<bool(const Scene&)>& collides);
  /// `balls`: a cover of the object.
  CompiledTree Attach(const SceneObject& object, int link, std::vector<Ball> balls);
  void CompileTrees(const PairRules& rules);
  void JudgeStandingTrees();
  void SetGrid();

  const Robot* robot_;
  const PlanningGroup* group_;
  CollisionModel model_;
  GeometryBound geometry_bound_;
  std::optional<RobotMeshes> meshes_;  ///< Of that model.

  // Of the held positions.
  std::vector<double> held_;  ///< That the following are of.
  std::optional<CompiledRobot> compiled_robot_;
  Ball robot_reach_W_;  ///< That no link leaves.
  CompiledRobot::Extent without_pairs_;
  std::unique_ptr<DistanceFieldBuilder> field_;  ///< Voxels.

  // Of the scene.
  Scene scene_;  ///< Its objects, what is attached, and the matrix.
  std::vector<double> base_positions_;
  /// Of the robot with its own pairs, as the matrix of scene_ has them; none: not compiled.
  std::optional<CompiledRobot::Extent> without_attached_;
  std::unordered_set<std::string> allowed_names_;  ///< Bodies that the matrix names.
  std::vector<std::pair<const AttachedObject*, CompiledTree>> attached_;  ///< Of scene_'s.
  std::list<RobotMeshes> attached_meshes_;  ///< Of these; trees point to them.
  bool attached_are_compiled_ = false;
  bool attached_collide_ = false;  ///< Always, with the robot or each other.
  bool attached_to_base_ = false;  ///< Some do not move.
  double links_distance_ = 0;      ///< Of links that do not move relative to each other, m.
  bool links_collide_ = false;     ///< Some of these do.
  CompiledWorld world_;
  Standing standing_;
  MotionBound motion_bound_;

  // To judge what does not move, once.
  kernels::SphereRobot base_;  ///< What of the robot does not move.
  kernels::SphereScratch base_scratch_;
};

}  // namespace planbench
