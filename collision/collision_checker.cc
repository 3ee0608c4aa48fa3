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
  ++num_checks_;
  return DoIsFree(q);
}

int CollisionChecker::FindCollision(std::span<const double> qs, int num) {
  RequireReady(qs, num);
  const int found = DoFindCollision(qs, num);
  num_checks_ += found < 0 ? num : found + 1;
  return found;
}

void CollisionChecker::CheckAll(std::span<const double> qs, int num,
                                std::span<unsigned char> free) {
  RequireReady(qs, num);
  if (free.size() != static_cast<std::size_t>(num)) {
    throw InputError(fmt::format("collision checker: room for {} verdicts on {} configurations",
                                 free.size(), num));
  }
  num_checks_ += num;
  DoCheckAll(qs, num, free);
}

void CollisionChecker::CheckAround(std::span<const double> qs, std::span<const double> half_widths,
                                   int num, std::span<unsigned char> free) {
  RequireReady(qs, num);
  if (half_widths.size() != qs.size() || free.size() != static_cast<std::size_t>(num)) {
    throw InputError(fmt::format(
        "collision checker: {} half widths and room for {} verdicts for {} configurations",
        half_widths.size(), free.size(), num));
  }
  for (double width : half_widths) {
    if (!(width >= 0) || !std::isfinite(width)) {
      throw InputError(fmt::format("collision checker: half width {} is not a length", width));
    }
  }
  num_checks_ += num;
  DoCheckAround(qs, half_widths, num, free);
}

SampleVerdicts CollisionChecker::CheckSamples(std::span<const double> start,
                                              std::span<const double> motions,
                                              std::span<const MotionSample> samples,
                                              bool stop_at_first) {
  RequireReady(start, 1);
  const std::size_t n = group_->joints.size();
  RequireReady(motions, static_cast<int>(motions.size() / n));
  if (samples.size() > 64) {
    throw InputError(
        fmt::format("collision checker: {} samples given, at most 64 are taken", samples.size()));
  }
  for (const MotionSample& sample : samples) {
    if (sample.motion < 0 || static_cast<std::size_t>(sample.motion) >= motions.size() / n) {
      throw InputError(fmt::format("collision checker: a sample of motion {} of {}", sample.motion,
                                   motions.size() / n));
    }
  }
  num_checks_ += static_cast<std::int64_t>(samples.size());
  return DoCheckSamples(start, motions, samples, stop_at_first);
}

void CollisionChecker::FindDistances(std::span<const double> qs, int num, double at_most,
                                     std::span<double> distances) {
  RequireReady(qs, num);
  if (distances.size() != static_cast<std::size_t>(num) || !(at_most > 0)) {
    throw InputError(
        fmt::format("collision checker: room for {} distances of {} configurations, at most {} m",
                    distances.size(), num, at_most));
  }
  num_checks_ += num;
  DoFindDistances(qs, num, at_most, distances);
}

std::optional<Contact> CollisionChecker::FindContact(std::span<const double> q) {
  RequireReady(q, 1);
  ++num_checks_;
  return DoFindContact(q);
}

ClosestPair CollisionChecker::FindClosest(std::span<const double> q) {
  RequireReady(q, 1);
  ++num_checks_;
  return DoFindClosest(q);
}

int CollisionChecker::DoFindCollision(std::span<const double> qs, int num) {
  const std::size_t n = group_->joints.size();
  for (int i = 0; i < num; ++i) {
    if (!DoIsFree(qs.subspan(static_cast<std::size_t>(i) * n, n))) return i;
  }
  return -1;
}

void CollisionChecker::DoCheckAll(std::span<const double> qs, int num,
                                  std::span<unsigned char> free) {
  const std::size_t n = group_->joints.size();
  for (int i = 0; i < num; ++i) {
    const auto index = static_cast<std::size_t>(i);
    free[index] = DoIsFree(qs.subspan(index * n, n)) ? 1 : 0;
  }
}

void CollisionChecker::DoCheckAround(std::span<const double> qs,
                                     std::span<const double> half_widths, int num,
                                     std::span<unsigned char> free) {
  const std::size_t n = group_->joints.size();
  for (std::size_t i = 0; i < static_cast<std::size_t>(num); ++i) {
    double motion = 0;
    for (std::size_t j = 0; j < n; ++j) motion += half_widths[i * n + j] * motion_bound_.reach()[j];
    const auto q = qs.subspan(i * n, n);
    // Both bodies of a pair may move.
    free[i] = motion == 0 ? DoIsFree(q) : DoFindClosest(q).distance_m > 2 * motion;
  }
}

SampleVerdicts CollisionChecker::DoCheckSamples(std::span<const double> start,
                                                std::span<const double> motions,
                                                std::span<const MotionSample> samples,
                                                bool stop_at_first) {
  const std::size_t n = group_->joints.size();
  std::vector<double> q(n);
  std::vector<double> half_widths(n);
  SampleVerdicts verdicts;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const MotionSample& sample = samples[k];
    const auto motion = motions.subspan(static_cast<std::size_t>(sample.motion) * n, n);
    for (std::size_t j = 0; j < n; ++j) {
      q[j] = start[j] + sample.position * motion[j];
      half_widths[j] = sample.half_length * std::abs(motion[j]);
    }
    const std::uint64_t bit = std::uint64_t{1} << k;
    unsigned char free = 1;
    if (!DoIsFree(q)) {
      verdicts.certain |= bit;
      free = 0;
      if (stop_at_first) return {verdicts.blocked | bit, verdicts.certain};
    } else if (sample.half_length > 0) {
      DoCheckAround(q, half_widths, 1, {&free, 1});
    }
    if (free == 0) verdicts.blocked |= bit;
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

}  // namespace planbench
