#include "collision/simd/simd_checker.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "collision/shape_check.h"
#include "collision/simd/ball_tree.h"

namespace planbench {
namespace {

using kernels::BlockQuery;
using kernels::BlockVerdict;
using kernels::kBlock;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename Container, typename Index>
auto& At(Container& container, Index index) {
  return container[static_cast<std::size_t>(index)];
}

kernels::LaneMask FirstLanes(int num) {
  return static_cast<kernels::LaneMask>((std::uint64_t{1} << num) - 1);
}

/// Joint position as the kernels take it: angles at most 2 pi.
float Reduced(double position, bool slides) {
  if (std::abs(position) <= 2 * std::numbers::pi || slides) return static_cast<float>(position);
  return static_cast<float>(std::remainder(position, 2 * std::numbers::pi));
}

/// A grid that no sphere leaves.
VoxelSettings VoxelsWithinReach(const CompiledRobot& robot) {
  VoxelSettings settings;
  settings.lower.setConstant(kInfinity);
  settings.upper.setConstant(-kInfinity);
  for (const CompiledTree& tree : robot.bodies) {
    const Eigen::Vector3d extent = Eigen::Vector3d::Constant(tree.reach_W.radius);
    settings.lower = settings.lower.cwiseMin(tree.reach_W.center - extent);
    settings.upper = settings.upper.cwiseMax(tree.reach_W.center + extent);
  }
  return settings;
}

}  // namespace

SimdChecker::SimdChecker(const Robot& robot, const PlanningGroup& group, CollisionModel model)
    : CollisionChecker(robot, group, model), exact_(robot, group, CollisionModel::kSpheres) {
  const auto n = static_cast<std::size_t>(group.space.size());
  q_.resize(n * kBlock);
  half_widths_.resize(n * kBlock);
  start_.resize(n);
  motion_.resize(n);
  for (const JointSpace::Joint& joint : space().joints()) {
    lower_.push_back(joint.continuous ? -kInfinity : joint.lower - JointSpace::kLimitTolerance);
    slides_.push_back(joint.prismatic ? 1 : 0);
    upper_.push_back(joint.continuous ? kInfinity : joint.upper + JointSpace::kLimitTolerance);
  }
}

MotionBound SimdChecker::DoSetScene(const Scene& scene, std::span<const double> base_positions) {
  exact_is_set_ = false;
  const PairRules rules(robot(), scene);
  for (const AttachedObject& attached : scene.attached) {
    for (const PlacedShape& placed : attached.object.shapes) {
      RequireSolid(placed.shape, attached.object.id);
    }
  }

  std::vector<double> held(base_positions.begin(), base_positions.end());
  for (int joint : group().joints) {
    At(held, At(robot().model.joints(), joint).position_index) = 0;
  }
  const bool robot_holds = held == held_;
  if (!robot_holds) {
    held_.clear();
    rigid_bodies_.emplace(robot().model, group(), base_positions);
    compiled_.emplace(robot(), group(), *rigid_bodies_, base_positions);
    links_bound_ = BoundMotion({}, base_positions);
    if (model() == CollisionModel::kVoxels) {
      field_ = std::make_unique<DistanceFieldBuilder>(
          robot().voxels ? *robot().voxels : VoxelsWithinReach(*compiled_));
    }
    held_ = std::move(held);
  }

  const bool same_matrix = scene.allowed_collisions == scene_.allowed_collisions;
  if (!same_matrix) scene_.allowed_collisions = scene.allowed_collisions;
  scene_.objects = scene.objects;
  scene_.attached = scene.attached;
  base_positions_.assign(base_positions.begin(), base_positions.end());
  if (!robot_holds || !same_matrix || !pairs_hold_ || !scene.attached.empty()) {
    pairs_hold_ = false;
    NoteAllowedNames(scene.allowed_collisions);
    CompilePairs(rules, scene, base_positions);
    pairs_hold_ = scene.attached.empty();
  }
  if (field_ == nullptr) {
    world_.SetObjects(scene, *compiled_);
  } else {
    world_.SetObjects({}, *compiled_);
    const DistanceField& field = field_->Rebuild(scene);
    for (std::size_t k = 0; k < 3; ++k) {
      grid_.origin[k] = field.origin[k];
      grid_.size[k] = field.size[k];
    }
    grid_.resolution = field.resolution;
    grid_.outside = field.outside;
    grid_.values = field.values.data();
    world_.kernel.grid = &grid_;
  }
  CompileTrees(rules, scene);
  scratch_.Reset(compiled_->kernel, world_.kernel);
  return scene.attached.empty() ? links_bound_ : BoundMotion(scene, base_positions);
}

MotionBound SimdChecker::BoundMotion(const Scene& scene,
                                     std::span<const double> base_positions) const {
  std::vector<LinkBall> balls;
  for (const LinkSphere& s : robot().spheres) balls.push_back({s.link, s.p_LS, s.radius});
  for (const AttachedObject& attached : scene.attached) {
    const int link = robot().model.FindLink(attached.link);
    for (const PlacedShape& placed : attached.object.shapes) {
      const BoundingSphere bound = ComputeBoundingSphere(placed.shape);
      balls.push_back({link, attached.object.X_WO * (placed.X_FS * bound.center), bound.radius});
    }
  }
  return MotionBound(robot().model, group(), base_positions, balls);
}

void SimdChecker::NoteAllowedNames(const AllowedCollisionMatrix& matrix) {
  allowed_names_.clear();
  for (const auto& [names, allowed] : matrix.entries()) {
    allowed_names_.insert(names.first);
    allowed_names_.insert(names.second);
  }
}

void SimdChecker::CompilePairs(const PairRules& rules, const Scene& scene,
                               std::span<const double> base_positions) {
  compiled_->Truncate();
  links_collide_ = false;
  links_distance_ = kInfinity;
  const auto& links = compiled_->links;
  const auto checks = [&](const CompiledTree& a, const CompiledTree& b) {
    return rules.ChecksLinks(a.link, b.link);
  };
  for (const CompiledTree& a : compiled_->bodies) {
    for (const CompiledTree& b : compiled_->bodies) {
      if (b.body < a.body) continue;
      compiled_->AddPairs(*rigid_bodies_, a, b, checks, &links_distance_);
    }
  }
  links_collide_ = links_distance_ <= 0;

  attached_.clear();
  for (const AttachedObject& attached : scene.attached) {
    std::vector<Ball> balls;
    for (const PlacedShape& placed : attached.object.shapes) {
      const BoundingSphere bound = ComputeBoundingSphere(placed.shape);
      balls.push_back({attached.object.X_WO * (placed.X_FS * bound.center), bound.radius});
    }
    if (balls.empty()) continue;
    const CompiledTree tree = compiled_->AddBall(robot(), group(), *rigid_bodies_, base_positions,
                                                 rules.LinkOf(attached), EnclosingBall(balls));
    // Pairs of one body are the FCL engine's to judge, once; see CompileTrees.
    for (const CompiledTree& link : links) {
      if (link.body != tree.body && rules.ChecksAttachedWithLink(attached, link.link)) {
        compiled_->AddPair(*rigid_bodies_, link, tree, true);
      }
    }
    for (const CompiledTree& other : attached_) {
      if (other.body != tree.body) compiled_->AddPair(*rigid_bodies_, other, tree, true);
    }
    attached_.push_back(tree);
  }
}

void SimdChecker::CompileTrees(const PairRules& rules, const Scene& scene) {
  // Objects that the matrix does not name count for every link, unless links allow by default.
  const bool by_default = !scene.allowed_collisions.default_entries().empty();
  std::vector<unsigned char> all(scene.objects.size(), 1);
  std::vector<int> named;
  for (std::size_t i = 0; field_ == nullptr && i < scene.objects.size(); ++i) {
    if (by_default || allowed_names_.contains(scene.objects[i].id)) {
      named.push_back(static_cast<int>(i));
    }
  }
  const auto add = [&](const CompiledTree& tree) {
    std::vector<unsigned char> checked = all;
    for (int i : named) {
      At(checked, i) = rules.ChecksLinkWithObject(tree.link, At(scene.objects, i)) ? 1 : 0;
    }
    world_.AddTree(tree, checked, false);
  };
  const auto add_all = [&](bool moving) {
    for (const CompiledTree& tree : named.empty() ? compiled_->bodies : compiled_->links) {
      if ((tree.body != 0) == moving) named.empty() ? world_.AddTree(tree, all, false) : add(tree);
    }
  };

  // What does not move is judged here, once.
  always_collides_ = links_collide_;
  standing_distance_ = links_distance_;
  if (field_ == nullptr) add_all(false);
  if (!world_.kernel.trees.empty()) {
    base_.num_joints = compiled_->kernel.num_joints;
    base_.bodies.assign(1, kernels::Body());
    base_.nodes = compiled_->kernel.nodes;
    base_.reaches = compiled_->kernel.reaches;
    base_scratch_.Reset(base_, world_.kernel);
    BlockQuery query;
    query.q = q_.data();
    query.lanes = 1;
    BlockVerdict verdict = kernels::CheckBlock(base_, world_.kernel, &base_scratch_, query);
    float distances[kBlock];
    kernels::BlockDistances(base_, world_.kernel, &base_scratch_, q_.data(),
                            static_cast<float>(CompiledWorld::kMaxDistance), distances);
    standing_distance_ = std::min(standing_distance_, static_cast<double>(distances[0]));
    always_collides_ = always_collides_ || verdict.hits != 0;
    if (verdict.doubts != 0) always_collides_ = always_collides_ || Exact().AlwaysCollides();
    world_.kernel.trees.clear();
    world_.kernel.candidates.clear();
  }
  add_all(true);
  for (const CompiledTree& tree : attached_) world_.AddTree(tree, all, true);
  if (!attached_.empty()) always_collides_ = always_collides_ || Exact().AlwaysCollides();
}

FclChecker& SimdChecker::Exact() {
  if (!exact_is_set_) {
    exact_.SetScene(scene_, base_positions_);
    exact_is_set_ = true;
  }
  return exact_;
}

SimdChecker::LaneMask SimdChecker::SetLanes(std::span<const double> rows, int num) {
  kernels::RowBlock block;
  block.num_joints = space().size();
  block.num_rows = num;
  block.rows = rows.data();
  block.slides = slides_.data();
  block.lower = lower_.data();
  block.upper = upper_.data();
  return kernels::PlaceRows(block, q_.data());
}

template <typename Judge>
BlockVerdict SimdChecker::Check(int num, LaneMask unfit, const float* half_widths,
                                bool stop_at_first, Judge exact) {
  const LaneMask lanes = FirstLanes(num);
  if (always_collides_) return {lanes, lanes, 0};
  // Lanes of no meaning must hold numbers all the same: NaN would be slow, not wrong.
  BlockQuery query;
  query.q = q_.data();
  query.half_widths = half_widths;
  query.lanes = lanes & ~unfit;
  query.stop_at_first = stop_at_first;
  BlockVerdict verdict = kernels::CheckBlock(compiled_->kernel, world_.kernel, &scratch_, query);
  if (stop_at_first && verdict.certain != 0) return verdict;
  for (LaneMask open = (verdict.doubts & ~verdict.certain) | unfit; open != 0; open &= open - 1) {
    const int lane = std::countr_zero(open);
    const SampleVerdicts judged = exact(lane);
    verdict.hits |= static_cast<LaneMask>(judged.blocked) << lane;
    verdict.certain |= static_cast<LaneMask>(judged.certain) << lane;
    if (judged.certain != 0 && stop_at_first) break;
  }
  return verdict;
}

SampleVerdicts SimdChecker::ExactVerdict(std::span<const double> q) {
  const std::uint64_t collides = Exact().IsFree(q) ? 0 : 1;
  return {collides, collides};
}

bool SimdChecker::DoIsFree(std::span<const double> q) {
  const LaneMask unfit = SetLanes(q, 1);
  return Check(1, unfit, nullptr, true, [&](int) { return ExactVerdict(q); }).certain == 0;
}

void SimdChecker::DoCheckAll(std::span<const double> qs, int num, std::span<unsigned char> free) {
  const auto n = static_cast<std::size_t>(space().size());
  for (int first = 0; first < num; first += kBlock) {
    const int count = std::min(kBlock, num - first);
    const auto rows = qs.subspan(static_cast<std::size_t>(first) * n);
    const LaneMask unfit = SetLanes(rows, count);
    const BlockVerdict verdict = Check(count, unfit, nullptr, false, [&](int lane) {
      return ExactVerdict(rows.subspan(static_cast<std::size_t>(lane) * n, n));
    });
    for (int lane = 0; lane < count; ++lane) {
      At(free, first + lane) = (verdict.hits >> lane & 1) == 0 ? 1 : 0;
    }
  }
}

SampleVerdicts SimdChecker::DoCheckSamples(std::span<const double> start,
                                           std::span<const double> motion,
                                           std::span<const MotionSample> samples) {
  const std::size_t n = start.size();
  kernels::SampleBlock block;
  block.num_joints = static_cast<int>(n);
  block.start = start_.data();
  block.motion = motion_.data();
  block.slides = slides_.data();
  // Between ends within the limits everything is.
  bool fits = true;
  for (std::size_t j = 0; j < n; ++j) {
    start_[j] = Reduced(start[j], slides_[j] != 0);
    motion_[j] = static_cast<float>(motion[j]);
    const double end = start[j] + motion[j];
    fits = fits && std::min(start[j], end) >= lower_[j] && std::max(start[j], end) <= upper_[j];
  }
  SampleVerdicts verdicts;
  for (std::size_t first = 0; first < samples.size(); first += kBlock) {
    const int count = static_cast<int>(std::min<std::size_t>(kBlock, samples.size() - first));
    const auto lanes = samples.subspan(first, static_cast<std::size_t>(count));
    bool around = false;
    for (int lane = 0; lane < count; ++lane) {
      const MotionSample& sample = At(lanes, lane);
      block.position[lane] = static_cast<float>(sample.position);
      block.half_length[lane] = static_cast<float>(sample.half_length);
      around = around || sample.half_length > 0;
    }
    kernels::PlaceSamples(block, q_.data(), half_widths_.data());
    const BlockVerdict verdict =
        Check(count, fits ? 0 : FirstLanes(count), around ? half_widths_.data() : nullptr, true,
              [&](int lane) {
                return Exact().CheckSamples(start, motion, {&At(lanes, lane), 1});
              });
    verdicts.blocked |= static_cast<std::uint64_t>(verdict.hits) << first;
    verdicts.certain |= static_cast<std::uint64_t>(verdict.certain) << first;
    if (verdict.certain != 0) break;
  }
  return verdicts;
}

void SimdChecker::DoFindDistances(std::span<const double> qs, int num, double at_most,
                                  std::span<double> distances) {
  const auto n = static_cast<std::size_t>(space().size());
  const double limit = std::min({at_most, CompiledWorld::kMaxDistance, standing_distance_});
  for (int first = 0; first < num; first += kBlock) {
    const int count = std::min(kBlock, num - first);
    const LaneMask unfit = SetLanes(qs.subspan(static_cast<std::size_t>(first) * n), count);
    float block[kBlock];
    kernels::BlockDistances(compiled_->kernel, world_.kernel, &scratch_, q_.data(),
                            static_cast<float>(limit), block);
    for (int lane = 0; lane < count; ++lane) {
      const auto q = qs.subspan(static_cast<std::size_t>(first + lane) * n, n);
      const bool exact = (unfit >> lane & 1) != 0;
      At(distances, first + lane) = exact ? std::min(limit, Exact().FindClosest(q).distance_m)
                                          : std::min(limit, static_cast<double>(block[lane]));
    }
  }
}

double SimdChecker::FieldDistance(const CompiledTree& tree, std::span<const double> q) {
  kernels::SphereRobot robot = compiled_->kernel;
  robot.pairs.clear();
  kernels::SphereWorld world;
  world.grid = &grid_;
  world.trees.push_back({tree.root, tree.body, false, tree.reach, 0, 0, 0, -1});
  kernels::SphereScratch scratch;
  scratch.Reset(robot, world);
  SetLanes(q, 1);
  float distances[kBlock];
  kernels::BlockDistances(robot, world, &scratch, q_.data(),
                          static_cast<float>(CompiledWorld::kMaxDistance), distances);
  return distances[0];
}

std::pair<double, std::string> SimdChecker::NearestToField(std::span<const double> q) {
  std::pair<double, std::string> nearest = {kInfinity, ""};
  for (const CompiledTree& tree : compiled_->links) {
    if (tree.body == 0) continue;
    const double distance = FieldDistance(tree, q);
    if (distance < nearest.first) {
      nearest = {distance, At(robot().model.links(), tree.link).name};
    }
  }
  return nearest;
}

std::optional<Contact> SimdChecker::DoFindContact(std::span<const double> q) {
  if (field_ != nullptr) {
    if (DoIsFree(q)) return std::nullopt;
    // What is not the field's is the robot's own, or an attached object's.
    const auto [distance, link] = NearestToField(q);
    if (distance <= 0) return Contact{link, "voxels", -distance};
  }
  if (auto contact = Exact().FindContact(q)) return contact;
  if (DoIsFree(q)) return std::nullopt;
  // Within the band in which this engine errs towards collision.
  const ClosestPair closest = Exact().FindClosest(q);
  return Contact{closest.body_a, closest.body_b, 0};
}

ClosestPair SimdChecker::DoFindClosest(std::span<const double> q) {
  if (field_ == nullptr) return Exact().FindClosest(q);
  Scene without_objects = scene_;
  without_objects.objects.clear();
  exact_.SetScene(without_objects, base_positions_);
  exact_is_set_ = false;
  ClosestPair closest = exact_.FindClosest(q);
  const auto [distance, link] = NearestToField(q);
  if (distance < closest.distance_m) closest = {distance, link, "voxels"};
  return closest;
}

}  // namespace planbench
