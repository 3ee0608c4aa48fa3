#include "collision/simd/simd_checker.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "collision/at.h"
#include "common/numbers.h"

namespace planbench {
namespace {

using kernels::BlockQuery;
using kernels::BlockVerdict;
using kernels::kBlock;

kernels::LaneMask FirstLanes(int num) {
  return static_cast<kernels::LaneMask>((std::uint64_t{1} << num) - 1);
}

/// Within this distance of contact, m, the verdict may err towards collision.
constexpr double kBand_m = 1e-4;

/// The least margin that is tried for a clearance, as a fraction of the largest.
constexpr double kLeastMargin = 1e-3;

constexpr double kTurn = 2 * std::numbers::pi;

/// Joint position as the kernels take it: angles at most 2 pi.
float Reduced(double position, bool slides) {
  if (std::abs(position) <= kTurn || slides) return static_cast<float>(position);
  return static_cast<float>(std::remainder(position, kTurn));
}

}  // namespace

SimdChecker::SimdChecker(const Robot& robot, const PlanningGroup& group, CollisionModel model)
    : CollisionChecker(robot, group, model),
      exact_(robot, group, model),
      compiled_(robot, group, model) {
  const auto n = static_cast<std::size_t>(group.space.size());
  q_.resize(n * kBlock);
  half_widths_.resize(n * kBlock);
  start_.resize(n);
  motion_.resize(n);
  for (const JointSpace::Joint& joint : space().joints()) {
    const double tolerance = joint.continuous ? kInfinity : JointSpace::kLimitTolerance;
    joints_.slides.push_back(joint.prismatic ? 1 : 0);
    joints_.lower.push_back(joint.lower - tolerance);
    joints_.upper.push_back(joint.upper + tolerance);
  }
}

MotionBound SimdChecker::DoSetScene(const Scene& scene, std::span<const double> base_positions) {
  exact_is_set_ = false;
  compiled_.Set(scene, base_positions, [&](const Scene& without_objects) {
    exact_.SetScene(without_objects, base_positions);
    return exact_.AlwaysCollides();
  });
  const CompiledScene::Standing& standing = compiled_.standing();
  always_collides_ = standing.collide || (standing.doubtful && Exact().AlwaysCollides());
  scratch_.Reset(compiled_.robot(), compiled_.world());
  return compiled_.motion_bound();
}

FclChecker& SimdChecker::Exact() {
  if (!exact_is_set_) {
    exact_.SetScene(compiled_.scene(), compiled_.base_positions());
    exact_.Select(compiled_.DoubtfulObjects());
    exact_is_set_ = true;
  }
  return exact_;
}

SimdChecker::LaneMask SimdChecker::SetLanes(std::span<const double> rows, int num) {
  return kernels::PlaceRows(joints_, rows.data(), num, q_.data());
}

void SimdChecker::PlaceManyTurns(std::span<const double> start, std::span<const double> motion,
                                 std::span<const MotionSample> samples) {
  for (std::size_t j = 0; j < start.size(); ++j) {
    if (joints_.slides[j] != 0 || std::abs(motion[j]) <= kTurn) continue;
    float* positions = &q_[j * kBlock];
    for (const MotionSample& sample : samples) {
      *positions++ =
          static_cast<float>(std::remainder(start[j] + sample.position * motion[j], kTurn));
    }
  }
}

template <typename Judge>
BlockVerdict SimdChecker::Check(int num, LaneMask unfit, const float* half_widths,
                                bool stop_at_first, Judge exact, kernels::Tests tests) {
  const LaneMask lanes = FirstLanes(num);
  if (always_collides_) return {lanes, lanes, 0};
  // Lanes of no meaning must hold numbers all the same: NaN would be slow, not wrong.
  BlockQuery query;
  query.q = q_.data();
  query.half_widths = half_widths;
  // The field's verdict holds beyond the joint limits, too.
  query.lanes = model() == CollisionModel::kVoxels ? lanes : lanes & ~unfit;
  query.stop_at_first = stop_at_first;
  query.tests = tests;
  BlockVerdict verdict =
      kernels::CheckBlock(compiled_.robot(), compiled_.world(), &scratch_, query);
  if (stop_at_first && verdict.certain != 0) return verdict;
  for (LaneMask open = (verdict.doubts | unfit) & ~verdict.hits; open != 0; open &= open - 1) {
    const int lane = std::countr_zero(open);
    const SampleVerdicts judged = exact(
        lane, (unfit >> lane & 1) != 0 ? FclChecker::Pairs::kAll : FclChecker::Pairs::kSelected);
    verdict.hits |= static_cast<LaneMask>(judged.blocked) << lane;
    verdict.certain |= static_cast<LaneMask>(judged.certain) << lane;
    if (judged.certain != 0 && stop_at_first) break;
  }
  return verdict;
}

bool SimdChecker::DoIsFree(std::span<const double> q) {
  const LaneMask unfit = SetLanes(q, 1);
  const auto exact = [&](int, FclChecker::Pairs pairs) {
    return Exact().CheckStretch(q, {}, 0, pairs);
  };
  return Check(1, unfit, nullptr, true, exact).certain == 0;
}

void SimdChecker::DoCheckAll(std::span<const double> qs, int num, std::span<unsigned char> free) {
  CheckRows(qs, num, kernels::Tests::kAll, free);
}

// Of unlike configurations the hulls of links are compared lane by lane: that costs more than
// edges whose ends collide so, which are seldom. Spheres against spheres cost little.
void SimdChecker::DoScreen(std::span<const double> qs, int num, std::span<unsigned char> free) {
  const bool is_mesh = model() == CollisionModel::kMeshes && HasPatches();
  CheckRows(qs, num, is_mesh ? kernels::Tests::kScreen : kernels::Tests::kAll, free);
}

void SimdChecker::CheckRows(std::span<const double> qs, int num, kernels::Tests tests,
                            std::span<unsigned char> free) {
  const auto n = static_cast<std::size_t>(space().size());
  for (int first = 0; first < num; first += kBlock) {
    const int count = std::min(kBlock, num - first);
    const auto rows = qs.subspan(static_cast<std::size_t>(first) * n);
    const LaneMask unfit = SetLanes(rows, count);
    const auto exact = [&](int lane, FclChecker::Pairs pairs) {
      return Exact().CheckStretch(rows.subspan(static_cast<std::size_t>(lane) * n, n), {}, 0,
                                  pairs);
    };
    const BlockVerdict verdict = Check(count, unfit, nullptr, false, exact, tests);
    for (int lane = 0; lane < count; ++lane) {
      At(free, first + lane) = (verdict.hits >> lane & 1) == 0 ? 1 : 0;
    }
  }
}

SampleVerdicts SimdChecker::DoCheckSamples(std::span<const double> start,
                                           std::span<const double> motion,
                                           std::span<const MotionSample> samples, SampleRole role) {
  const std::size_t n = start.size();
  kernels::SampleBlock block;
  block.start = start_.data();
  block.motion = motion_.data();
  // Between ends within the limits everything is.
  bool fits = true;
  double widest = 0;
  for (std::size_t j = 0; j < n; ++j) {
    widest = std::max(widest, std::abs(motion[j]));
    start_[j] = Reduced(start[j], joints_.slides[j] != 0);
    motion_[j] = static_cast<float>(motion[j]);
    const double end = start[j] + motion[j];
    fits = fits && std::min(start[j], end) >= joints_.lower[j] &&
           std::max(start[j], end) <= joints_.upper[j];
  }
  if (role == SampleRole::kMotion) scratch_.ForgetOpen();
  const auto tests =
      role == SampleRole::kMotion ? kernels::Tests::kFindOpen : kernels::Tests::kOpen;
  std::vector<double> q;
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
    kernels::PlaceSamples(joints_, block, q_.data(), half_widths_.data());
    if (widest > kTurn) PlaceManyTurns(start, motion, lanes);
    const auto exact = [&](int lane, FclChecker::Pairs pairs) {
      const MotionSample& sample = At(lanes, lane);
      q.assign(start.begin(), start.end());
      for (std::size_t j = 0; j < n; ++j) q[j] += sample.position * motion[j];
      return Exact().CheckStretch(q, motion, sample.half_length, pairs);
    };
    const BlockVerdict verdict = Check(count, fits ? 0 : FirstLanes(count),
                                       around ? half_widths_.data() : nullptr, true, exact, tests);
    verdicts.blocked |= static_cast<std::uint64_t>(verdict.hits) << first;
    verdicts.certain |= static_cast<std::uint64_t>(verdict.certain) << first;
    if (verdict.certain != 0) break;
  }
  return verdicts;
}

void SimdChecker::FindBounds(std::span<const double> qs, int num, double most,
                             std::span<double> distances) {
  const auto n = static_cast<std::size_t>(space().size());
  const double limit = std::min(most, compiled_.standing().distance_m);
  for (int first = 0; first < num; first += kBlock) {
    const int count = std::min(kBlock, num - first);
    const LaneMask unfit = SetLanes(qs.subspan(static_cast<std::size_t>(first) * n), count);
    float block[kBlock];
    kernels::BlockDistances(compiled_.robot(), compiled_.world(), &scratch_, q_.data(),
                            static_cast<float>(limit), block);
    for (int lane = 0; lane < count; ++lane) {
      const auto q = qs.subspan(static_cast<std::size_t>(first + lane) * n, n);
      double& distance = At(distances, first + lane);
      distance = std::min(limit, static_cast<double>(block[lane]));
      if ((unfit >> lane & 1) != 0) distance = std::min(distance, ExactDistance(q, most));
    }
  }
}

void SimdChecker::DoFindDistances(std::span<const double> qs, int num, double at_most,
                                  std::span<double> distances) {
  const double most = std::min(at_most, CompiledWorld::kMaxDistance);
  FindBounds(qs, num, most, distances);
  if (!HasPatches()) return;
  const auto n = static_cast<std::size_t>(space().size());
  for (int i = 0; i < num; ++i) {
    const auto q = qs.subspan(static_cast<std::size_t>(i) * n, n);
    double& distance = At(distances, i);
    if (distance < most) {
      distance = PatchDistance(q, most);
    } else if (!DoIsFree(q)) {
      distance = 0;  // inside of something, far from its surface
    }
  }
}

void SimdChecker::DoFindClearances(std::span<const double> qs, int num, double at_most,
                                   std::span<double> clearances) {
  const double most = std::min(at_most, CompiledWorld::kMaxDistance);
  const auto n = static_cast<std::size_t>(space().size());
  // A robot's geometry may be spheres alone.
  const bool has_meshes = model() == CollisionModel::kMeshes && HasPatches();
  if (!has_meshes) FindBounds(qs, num, most, clearances);
  for (int i = 0; HasPatches() && i < num; ++i) {
    const auto q = qs.subspan(static_cast<std::size_t>(i) * n, n);
    double& clearance = At(clearances, i);
    if (has_meshes) {
      clearance = MarginAround(q, most);
    } else if (clearance <= 0) {
      clearance = PatchDistance(q, most);
    } else if (!DoIsFree(q)) {
      clearance = 0;  // likewise
    }
  }
}

double SimdChecker::MarginAround(std::span<const double> q, double at_most) {
  if (always_collides_ || at_most <= 0) return std::min(at_most, 0.0);
  if (SetLanes(q, 1) != 0) return ExactDistance(q, at_most);
  // The same configuration in all lanes, a margin each.
  std::array<float, kBlock> margins;
  for (std::size_t lane = 0; lane < kBlock; ++lane) {
    const double fraction = static_cast<double>(lane + 1) / kBlock;
    margins[lane] = static_cast<float>(at_most * std::pow(kLeastMargin, 1 - fraction));
  }
  for (auto joint = q_.begin(); joint != q_.end(); joint += kBlock) {
    std::fill_n(joint, kBlock, *joint);
  }
  std::fill(half_widths_.begin(), half_widths_.end(), 0.0f);
  BlockQuery query;
  query.q = q_.data();
  query.half_widths = half_widths_.data();
  query.margins = margins.data();
  query.lanes = FirstLanes(kBlock);
  const BlockVerdict verdict =
      kernels::CheckBlock(compiled_.robot(), compiled_.world(), &scratch_, query);
  const int num_clear = std::countr_zero((verdict.hits | verdict.doubts) | ~query.lanes);
  if (num_clear == 0) return 0;
  return num_clear == kBlock ? at_most : margins[static_cast<std::size_t>(num_clear) - 1];
}

double SimdChecker::PatchDistance(std::span<const double> q, double at_most) {
  const double distance = ExactDistance(q, at_most);
  // Next to contact the verdict decides the sign, so that the two never disagree.
  return distance > 0 && distance < kBand_m && !DoIsFree(q) ? 0 : distance;
}

double SimdChecker::ExactDistance(std::span<const double> q, double at_most) {
  double distance = 0;
  Exact().FindDistances(q, 1, at_most, {&distance, 1});
  return distance;
}

double SimdChecker::FieldDistance(const CompiledTree& tree, std::span<const double> q) {
  kernels::SphereRobot robot = compiled_.robot();
  robot.pairs.clear();
  kernels::SphereWorld world;
  world.grid = compiled_.world().grid;
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
  for (const CompiledTree& tree : compiled_.links()) {
    if (tree.body == 0) continue;
    const double distance = FieldDistance(tree, q);
    if (distance < nearest.first) {
      nearest = {distance, At(robot().model.links(), tree.link).name};
    }
  }
  return nearest;
}

std::optional<Contact> SimdChecker::DoFindContact(std::span<const double> q) {
  if (model() == CollisionModel::kVoxels) {
    if (DoIsFree(q)) return std::nullopt;
    // What is not the field's is the robot's own, or an attached object's.
    const auto [distance, link] = NearestToField(q);
    if (distance <= 0) return Contact{link, "voxels", std::max(0.0, -distance)};
  }
  if (auto contact = Exact().FindContact(q)) return contact;
  if (DoIsFree(q)) return std::nullopt;
  // Within the band in which this engine errs towards collision.
  const ClosestPair closest = Exact().FindClosest(q);
  return Contact{closest.body_a, closest.body_b, 0};
}

ClosestPair SimdChecker::DoFindClosest(std::span<const double> q) {
  ClosestPair closest = Exact().FindClosest(q);
  if (model() != CollisionModel::kVoxels) return closest;
  const auto [distance, link] = NearestToField(q);
  if (distance < closest.distance_m) closest = {distance, link, "voxels"};
  return closest;
}

}  // namespace planbench
