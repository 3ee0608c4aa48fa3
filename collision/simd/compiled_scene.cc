#include "collision/simd/compiled_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "collision/at.h"
#include "collision/balls.h"
#include "collision/model_spheres.h"
#include "collision/object_cover.h"
#include "collision/rigid_bodies.h"
#include "collision/shape_check.h"
#include "common/error.h"
#include "common/numbers.h"

namespace planbench {
namespace {

using kernels::kBlock;

/// Balls around an attached object.
constexpr std::size_t kAttachedBalls = 32;
/// Of meshes that are judged as they are.
constexpr std::size_t kMostTriangles = 5000;
/// What reaches further from its link, m, loses too much to single precision.
constexpr double kLargestAttached = 20;

/// Whether the kernels can judge an attached object, covered by these balls, at a set-up that is
/// worth it.
bool HasExactKernels(const SceneObject& object, const std::vector<Ball>& balls) {
  std::size_t num_triangles = 0;
  const auto is_exact = [&](const PlacedShape& placed) {
    if (const auto* mesh = std::get_if<Mesh>(&placed.shape)) {
      num_triangles += mesh->triangles->triangles.size();
      return num_triangles <= kMostTriangles;
    }
    return std::holds_alternative<Box>(placed.shape) ||
           std::holds_alternative<Cylinder>(placed.shape) ||
           std::holds_alternative<Sphere>(placed.shape);
  };
  return std::all_of(object.shapes.begin(), object.shapes.end(), is_exact) &&
         std::all_of(balls.begin(), balls.end(), [](const Ball& ball) {
           return ball.center.norm() + ball.radius <= kLargestAttached;
         });
}

BallTree TreeAround(const SceneObject& object, std::vector<Ball> balls) {
  BallTree tree(std::move(balls));
  tree.SetInner([&](const Eigen::Vector3d& point) { return DepthIn(object, point); });
  return tree;
}

/// A grid that no sphere leaves. Throws InputError if it is too large.
VoxelSettings VoxelsWithinReach(const CompiledRobot& robot) {
  VoxelSettings settings;
  settings.lower.setConstant(kInfinity);
  settings.upper.setConstant(-kInfinity);
  for (const CompiledTree& tree : robot.bodies) {
    const Eigen::Vector3d extent = Eigen::Vector3d::Constant(tree.reach_W.radius);
    settings.lower = settings.lower.cwiseMin(tree.reach_W.center - extent);
    settings.upper = settings.upper.cwiseMax(tree.reach_W.center + extent);
  }
  try {
    NumVoxels(settings);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("voxels of {} m wherever the robot reaches: {}; name a smaller or coarser grid "
                    "in robot.yaml (voxels)",
                    settings.resolution_m, error.what()));
  }
  return settings;
}

}  // namespace

CompiledScene::CompiledScene(const Robot& robot, const PlanningGroup& group, CollisionModel model)
    : CompiledScene(robot, group, model,
                    model == CollisionModel::kMeshes ? LoadLinkGeometry(robot)
                                                     : std::vector<LinkGeometry>()) {}

CompiledScene::CompiledScene(const Robot& robot, const PlanningGroup& group, CollisionModel model,
                             const std::vector<LinkGeometry>& geometry)
    : robot_(&robot),
      group_(&group),
      model_(model),
      geometry_bound_(
          robot.model, group,
          model == CollisionModel::kMeshes ? CoverOf(geometry) : ModelSpheres(robot, model)) {
  if (model == CollisionModel::kMeshes) {
    // Spheres that enclose a link are about as close to it as so many can be.
    meshes_.emplace(geometry,
                    robot.enclosing_spheres.empty() ? robot.spheres : robot.enclosing_spheres);
  }
}

void CompiledScene::Set(const Scene& scene, std::span<const double> base_positions,
                        const std::function<bool(const Scene&)>& collides) {
  const PairRules rules(*robot_, scene);
  for (const AttachedObject& attached : scene.attached) {
    for (const PlacedShape& placed : attached.object.shapes) {
      RequireSolid(placed.shape, attached.object.id);
    }
  }

  std::vector<double> held = HeldPositions(robot_->model, *group_, base_positions);
  const bool robot_holds = held == held_;
  if (!robot_holds) {
    held_.clear();
    compiled_robot_.emplace(*robot_, *group_, base_positions, ModelSpheres(*robot_, model_),
                            meshes_ ? &*meshes_ : nullptr);
    std::vector<Ball> reaches;
    for (const CompiledTree& tree : compiled_robot_->bodies) reaches.push_back(tree.reach_W);
    robot_reach_W_ = EnclosingBall(reaches);
    without_pairs_ = compiled_robot_->extent();
    base_ = robot();
    base_.bodies.resize(1);
    if (model_ == CollisionModel::kVoxels) {
      field_ = std::make_unique<DistanceFieldBuilder>(
          robot_->voxels ? *robot_->voxels : VoxelsWithinReach(*compiled_robot_));
    }
    held_ = std::move(held);
  }

  const bool same_matrix = scene.allowed_collisions == scene_.allowed_collisions;
  if (!same_matrix) scene_.allowed_collisions = scene.allowed_collisions;
  scene_.objects = scene.objects;
  base_positions_.assign(base_positions.begin(), base_positions.end());
  if (!robot_holds || !same_matrix || !without_attached_) {
    without_attached_.reset();
    CompilePairs(rules);
    without_attached_ = compiled_robot_->extent();
    attached_are_compiled_ = false;
  }
  if (!attached_are_compiled_ || scene.attached != scene_.attached) {
    attached_are_compiled_ = false;
    scene_.attached = scene.attached;
    AttachObjects(rules, collides);
    attached_are_compiled_ = true;
  }
  Ball reach_W = robot_reach_W_;
  if (!attached_.empty()) {
    std::vector<Ball> reaches = {reach_W};
    for (const auto& [attached, tree] : attached_) reaches.push_back(tree.reach_W);
    reach_W = EnclosingBall(reaches);
  }
  world_.SetObjects(scene_, *compiled_robot_, reach_W);
  if (field_ != nullptr) SetGrid();
  CompileTrees(rules);
  geometry_bound_.Set(scene_, base_positions);
  motion_bound_ = geometry_bound_.OfAll();
}

void CompiledScene::SetGrid() {
  const DistanceField& field = field_->Rebuild(scene_);
  kernels::DistanceGrid& grid = world_.kernel.grid.emplace();
  for (std::size_t k = 0; k < 3; ++k) {
    grid.origin[k] = field.origin[k];
    grid.size[k] = field.size[k];
  }
  grid.resolution = field.resolution;
  grid.outside = field.outside;
  // Of positions, and of the grid's own.
  const double padding =
      PaddingWithin(std::max(robot_reach_W_.center.norm() + robot_reach_W_.radius,
                             Eigen::Vector3f::Map(grid.origin).cast<double>().norm()));
  grid.rounding = static_cast<float>(padding);
  grid.is_far = padding > kRadiusPadding;
  grid.values = field.values.data();
}

void CompiledScene::CompilePairs(const PairRules& rules) {
  allowed_names_.clear();
  for (const auto& [names, allowed] : scene_.allowed_collisions.entries()) {
    allowed_names_.insert(names.first);
    allowed_names_.insert(names.second);
  }

  compiled_robot_->Truncate(without_pairs_);
  compiled_robot_->standing = {};
  links_distance_ = kInfinity;
  const auto checks = [&](const CompiledTree& a, const CompiledTree& b) {
    return rules.ChecksLinks(a.link, b.link);
  };
  for (const CompiledTree& a : compiled_robot_->bodies) {
    for (const CompiledTree& b : compiled_robot_->bodies) {
      if (b.body >= a.body) compiled_robot_->AddPairs(a, b, checks, &links_distance_);
    }
  }
  links_collide_ = meshes_ ? StandingMeshesCollide() : links_distance_ <= 0;
}

bool CompiledScene::StandingMeshesCollide() const {
  kernels::SphereRobot links = robot();
  links.pairs = compiled_robot_->standing.pairs;
  links.inside_tests = compiled_robot_->standing.inside_tests;
  const kernels::SphereWorld nothing;
  kernels::SphereScratch scratch;
  scratch.Reset(links, nothing);
  std::vector<float> q;
  for (const JointSpace::Joint& joint : group_->space.joints()) {
    q.insert(q.end(), kBlock, static_cast<float>((joint.lower + joint.upper) / 2));
  }
  kernels::BlockQuery query;
  query.q = q.data();
  query.lanes = 1;
  return kernels::CheckBlock(links, nothing, &scratch, query).hits != 0;
}

void CompiledScene::AttachObjects(const PairRules& rules,
                                  const std::function<bool(const Scene&)>& collides) {
  compiled_robot_->Truncate(*without_attached_);
  attached_.clear();
  attached_meshes_.clear();
  attached_to_base_ = false;
  bool some_stand = false;  // relative to something that they are checked with
  for (const AttachedObject& attached : scene_.attached) {
    std::vector<Ball> balls = CoverOf(attached.object, kAttachedBalls);
    if (balls.empty()) continue;
    const CompiledTree tree = Attach(attached.object, rules.LinkOf(attached), std::move(balls));
    attached_to_base_ = attached_to_base_ || tree.body == 0;
    for (const CompiledTree& link : compiled_robot_->links) {
      if (!rules.ChecksAttachedWithLink(attached, link.link)) continue;
      if (link.body == tree.body) {
        some_stand = true;
        continue;
      }
      compiled_robot_->AddAttachedPair(link, tree);
    }
    for (const auto& [other, other_tree] : attached_) {
      if (!rules.ChecksAttached(*other, attached)) continue;
      some_stand = some_stand || other_tree.body == tree.body;
      if (other_tree.body != tree.body) compiled_robot_->AddAttachedPair(other_tree, tree);
    }
    attached_.emplace_back(&attached, tree);
  }
  Scene without_objects;
  without_objects.attached = scene_.attached;
  without_objects.allowed_collisions = scene_.allowed_collisions;
  attached_collide_ = some_stand && collides(without_objects);
}

CompiledTree CompiledScene::Attach(const SceneObject& object, int link, std::vector<Ball> balls) {
  // With a field distances are the kernels', which know balls only.
  if (field_ == nullptr && HasExactKernels(object, balls)) {
    LinkGeometry geometry{link, object.shapes};
    for (PlacedShape& placed : geometry.shapes) placed.X_FS = object.X_WO * placed.X_FS;
    return compiled_robot_->AddTree(attached_meshes_.emplace_back(geometry, balls));
  }
  return compiled_robot_->AddTree(link, TreeAround(object, std::move(balls)));
}

void CompiledScene::CompileTrees(const PairRules& rules) {
  // Objects that the matrix does not name count for every link, unless links allow by default; with
  // a field none does.
  const bool by_default = !scene_.allowed_collisions.default_entries().empty();
  const int num_objects = static_cast<int>(world_.objects().size());
  const auto object = [this](int i) -> const SceneObject& {
    return At(scene_.objects, At(world_.objects(), i));
  };
  std::vector<unsigned char> checked(world_.objects().size(), field_ == nullptr ? 1 : 0);
  std::vector<int> named;
  for (int i = 0; field_ == nullptr && i < num_objects; ++i) {
    if (by_default || allowed_names_.contains(object(i).id)) named.push_back(i);
  }
  const auto add_all = [&](bool moving) {
    for (const CompiledTree& tree :
         named.empty() ? compiled_robot_->bodies : compiled_robot_->links) {
      if ((tree.body != 0) != moving) continue;
      for (int i : named) {
        At(checked, i) = rules.ChecksLinkWithObject(tree.link, object(i)) ? 1 : 0;
      }
      world_.AddTree(tree, checked);
    }
  };

  standing_ = {links_collide_ || attached_collide_, attached_to_base_, links_distance_};
  if (field_ == nullptr) add_all(false);
  if (!world_.kernel.trees.empty()) {
    JudgeStandingTrees();
    world_.kernel.trees.clear();
    world_.kernel.candidates.clear();
  }
  add_all(true);
  for (const auto& [attached, tree] : attached_) {
    for (int i = 0; i < num_objects; ++i) {
      At(checked, i) = rules.ChecksAttachedWithObject(*attached, object(i)) ? 1 : 0;
    }
    world_.AddTree(tree, checked);
  }
}

void CompiledScene::JudgeStandingTrees() {
  base_.triangles = robot().triangles;
  base_.points = robot().points;
  base_scratch_.Reset(base_, world());
  const float no_joints[kBlock] = {};
  kernels::BlockQuery query;
  query.q = no_joints;
  query.lanes = 1;
  const kernels::BlockVerdict verdict = kernels::CheckBlock(base_, world(), &base_scratch_, query);
  float distances[kBlock];
  kernels::BlockDistances(base_, world(), &base_scratch_, no_joints,
                          static_cast<float>(CompiledWorld::kMaxDistance), distances);
  standing_.distance_m = std::min(standing_.distance_m, static_cast<double>(distances[0]));
  standing_.collide = standing_.collide || verdict.hits != 0;
  standing_.doubtful = standing_.doubtful || verdict.doubts != 0;
}

}  // namespace planbench
