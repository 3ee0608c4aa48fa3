#include "collision/collision_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "common/error.h"

namespace planbench {
namespace {

bool AllFinite(std::span<const double> values) {
  // Without branches, so that it can be vectorised: blocks of configurations pass through here.
  std::uint64_t bad = 0;
  for (double value : values) {
    constexpr std::uint64_t kExponent = 0x7ff0000000000000;
    bad |=
        static_cast<std::uint64_t>((std::bit_cast<std::uint64_t>(value) & kExponent) == kExponent);
  }
  return bad == 0;
}

}  // namespace

std::string Describe(const Contact& contact) {
  constexpr double kLeastShown = 0.00005;  // m
  if (contact.depth_m < kLeastShown) {
    return fmt::format("'{}' and '{}' in contact", contact.body_a, contact.body_b);
  }
  return fmt::format("'{}' and '{}', {:.4f} m deep", contact.body_a, contact.body_b,
                     contact.depth_m);
}

void CollisionChecker::SetScene(const Scene& scene, std::span<const double> base_positions) {
  const int expected = robot_->model.num_positions();
  if (static_cast<int>(base_positions.size()) != expected) {
    throw InputError(fmt::format("collision checker: {} base positions given, robot '{}' has {}",
                                 base_positions.size(), robot_->name, expected));
  }
  if (!AllFinite(base_positions)) {
    throw InputError("collision checker: a base position is not finite");
  }
  has_scene_ = false;  // stays so if the engine refuses the scene
  motion_bound_ = DoSetScene(scene, base_positions);
  has_scene_ = true;
}

void CollisionChecker::RequireReady(std::span<const double> qs, int num) const {
  if (!has_scene_) throw InputError("collision checker: no scene is set");
  if (num < 0 || qs.size() != static_cast<std::size_t>(num) * group_->joints.size()) {
    throw InputError(
        fmt::format("collision checker: {} values given for {} configurations of the {} joints of "
                    "group '{}'",
                    qs.size(), num, group_->joints.size(), group_->name));
  }
  if (!AllFinite(qs)) throw InputError("collision checker: a joint position is not finite");
}

bool CollisionChecker::IsFree(std::span<const double> q) {
  RequireReady(q, 1);
  return DoIsFree(q);
}

void CollisionChecker::CheckAll(std::span<const double> qs, int num,
                                std::span<unsigned char> free) {
  RequireVerdicts(qs, num, free);
  DoCheckAll(qs, num, free);
}

void CollisionChecker::Screen(std::span<const double> qs, int num, std::span<unsigned char> free) {
  RequireVerdicts(qs, num, free);
  DoScreen(qs, num, free);
}

void CollisionChecker::RequireVerdicts(std::span<const double> qs, int num,
                                       std::span<const unsigned char> free) const {
  RequireReady(qs, num);
  if (free.size() != static_cast<std::size_t>(num)) {
    throw InputError(fmt::format("collision checker: room for {} verdicts on {} configurations",
                                 free.size(), num));
  }
}

SampleVerdicts CollisionChecker::CheckSamples(std::span<const double> start,
                                              std::span<const double> motion,
                                              std::span<const MotionSample> samples,
                                              SampleRole role) {
  RequireReady(start, 1);
  RequireReady(motion, 1);
  if (samples.size() > 64) {
    throw InputError(
        fmt::format("collision checker: {} samples given, at most 64 are taken", samples.size()));
  }
  return DoCheckSamples(start, motion, samples, role);
}

void CollisionChecker::FindDistances(std::span<const double> qs, int num, double at_most,
                                     std::span<double> distances) {
  RequireRoom(qs, num, at_most, distances);
  DoFindDistances(qs, num, at_most, distances);
}

void CollisionChecker::FindClearances(std::span<const double> qs, int num, double at_most,
                                      std::span<double> clearances) {
  RequireRoom(qs, num, at_most, clearances);
  DoFindClearances(qs, num, at_most, clearances);
}

void CollisionChecker::RequireRoom(std::span<const double> qs, int num, double at_most,
                                   std::span<double> distances) const {
  RequireReady(qs, num);
  if (distances.size() != static_cast<std::size_t>(num) || !(at_most > 0)) {
    throw InputError(
        fmt::format("collision checker: room for {} distances of {} configurations, at most {} m",
                    distances.size(), num, at_most));
  }
}

std::optional<Contact> CollisionChecker::FindContact(std::span<const double> q) {
  RequireReady(q, 1);
  return DoFindContact(q);
}

ClosestPair CollisionChecker::FindClosest(std::span<const double> q) {
  RequireReady(q, 1);
  return DoFindClosest(q);
}

void CollisionChecker::DoCheckAll(std::span<const double> qs, int num,
                                  std::span<unsigned char> free) {
  const std::size_t n = group_->joints.size();
  for (std::size_t i = 0; i < static_cast<std::size_t>(num); ++i) {
    free[i] = DoIsFree(qs.subspan(i * n, n)) ? 1 : 0;
  }
}

void CollisionChecker::DoScreen(std::span<const double> qs, int num,
                                std::span<unsigned char> free) {
  DoCheckAll(qs, num, free);
}

SampleVerdicts CollisionChecker::DoCheckSamples(std::span<const double> start,
                                                std::span<const double> motion,
                                                std::span<const MotionSample> samples,
                                                SampleRole /*role*/) {
  const std::size_t n = group_->joints.size();
  double motion_m = 0;  // bounds how far anything moves
  for (std::size_t j = 0; j < n; ++j) motion_m += std::abs(motion[j]) * motion_bound_.reach()[j];
  std::vector<double> q(n);
  SampleVerdicts verdicts;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const MotionSample& sample = samples[k];
    for (std::size_t j = 0; j < n; ++j) q[j] = start[j] + sample.position * motion[j];
    const std::uint64_t bit = std::uint64_t{1} << k;
    if (!DoIsFree(q)) return {verdicts.blocked | bit, bit};
    // Both bodies of a pair may move.
    const double approach_m = 2 * sample.half_length * motion_m;
    if (approach_m > 0 && !(DoFindClosest(q).distance_m > approach_m)) verdicts.blocked |= bit;
  }
  return verdicts;
}

void CollisionChecker::DoFindDistances(std::span<const double> qs, int num, double at_most,
                                       std::span<double> distances) {
  const std::size_t n = group_->joints.size();
  for (std::size_t i = 0; i < static_cast<std::size_t>(num); ++i) {
    distances[i] = std::min(at_most, DoFindClosest(qs.subspan(i * n, n)).distance_m);
  }
}

void CollisionChecker::DoFindClearances(std::span<const double> qs, int num, double at_most,
                                        std::span<double> clearances) {
  DoFindDistances(qs, num, at_most, clearances);
}

}  // namespace planbench
