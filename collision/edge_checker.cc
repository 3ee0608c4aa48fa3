#include "collision/edge_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "common/error.h"
#include "common/stopwatch.h"

namespace planbench {
namespace {

/// One call in this many is timed: two readings of a clock cost as much as a short edge.
constexpr std::int64_t kTimedCalls = 8;
/// Samples that CheckSamples takes at once.
constexpr int kMaxBlock = 64;
/// Within an edge, whether to stop is asked after this many samples: seldom enough to cost nothing,
/// often enough where each is the work of an exact engine on meshes.
constexpr std::int64_t kSamplesUnasked = 64;
/// Certified edges are first cut into stretches of this many edge resolutions ...
constexpr double kFirstStretch = 4;
/// ... and those not proven free into this many parts.
constexpr int kCuts = 4;

/// Times one call in kTimedCalls, for all of them.
std::optional<ScopedTimer> TimeCall(std::int64_t* num_calls, double* total_s) {
  if ((*num_calls)++ % kTimedCalls != 0) return std::nullopt;
  return std::optional<ScopedTimer>(std::in_place, total_s, kTimedCalls);
}

/// Neighbouring samples collide together, so the next sample worth trying is the one furthest from
/// all before: the far end, the middle, the quarters, ... (van der Corput's sequence). Parts are
/// numbers whose bits, reversed, count through that order: 0 stands for the end, others for
/// interior samples. The part after `part`, -1 after the last.
std::int64_t NextSample(std::int64_t part, std::int64_t num_parts) {
  const auto high = static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(num_parts)));
  do {
    // Adds one in the reversed order: carries run towards the low bits.
    std::int64_t bit = high >> 1;
    while ((part & bit) != 0) {
      part ^= bit;
      bit >>= 1;
    }
    if (bit == 0) return -1;
    part |= bit;
  } while (part >= num_parts);
  return part;
}

/// Where on the edge the sample of a part is.
double SamplePosition(std::int64_t part, std::int64_t num_parts) {
  return part == 0 ? 1.0 : static_cast<double>(part) / static_cast<double>(num_parts);
}

}  // namespace

EdgeChecker::EdgeChecker(CollisionChecker* checker, double edge_resolution_m, EdgeCheck method)
    : checker_(checker), edge_resolution_m_(edge_resolution_m), method_(method) {
  if (!std::isfinite(edge_resolution_m) || edge_resolution_m <= 0) {
    throw InputError(
        fmt::format("edge resolution must be a positive length in m, it is {}", edge_resolution_m));
  }
}

void EdgeChecker::RequireSize(std::span<const double> q) const {
  if (static_cast<int>(q.size()) != space().size()) {
    throw InputError(fmt::format("edge checker: a configuration of {} values given for {} joints",
                                 q.size(), space().size()));
  }
}

void EdgeChecker::StopWhen(std::function<bool()> should_stop) {
  should_stop_ = std::move(should_stop);
  stopped_ = false;
}

bool EdgeChecker::GiveUp() {
  if (unasked_ < kSamplesUnasked) return false;
  unasked_ = 0;
  stopped_ = stopped_ || (should_stop_ && should_stop_());
  return stopped_;
}

bool EdgeChecker::IsValidState(std::span<const double> q) {
  RequireSize(q);
  const auto timer = TimeCall(&num_calls_, &counters_.seconds);
  ++counters_.states;
  if (!space().WithinLimits(q)) return false;
  ++counters_.configurations;
  return checker_->IsFree(q);
}

void EdgeChecker::CheckStates(std::span<const double> qs, int num, std::span<unsigned char> valid) {
  const auto n = static_cast<std::size_t>(space().size());
  const auto count = static_cast<std::size_t>(std::max(num, 0));
  if (num < 0 || qs.size() != count * n || valid.size() != count) {
    throw InputError(
        fmt::format("edge checker: {} values and room for {} verdicts given for {} states of {} "
                    "joints",
                    qs.size(), valid.size(), num, n));
  }
  const auto timer = TimeCall(&num_calls_, &counters_.seconds);
  counters_.states += num;
  std::size_t begin = 0;  // of a run of states within limits, which go to the engine together
  const auto check_run = [&](std::size_t end) {
    if (end == begin) return;
    counters_.configurations += static_cast<std::int64_t>(end - begin);
    checker_->CheckAll(qs.subspan(begin * n, (end - begin) * n), static_cast<int>(end - begin),
                       valid.subspan(begin, end - begin));
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (space().WithinLimits(qs.subspan(i * n, n))) continue;
    check_run(i);
    valid[i] = 0;
    begin = i + 1;
  }
  check_run(count);
}

bool EdgeChecker::IsValidEdge(std::span<const double> from, std::span<const double> to,
                              bool from_is_free) {
  RequireSize(from);
  RequireSize(to);
  const auto timer = TimeCall(&num_calls_, &counters_.seconds);
  ++counters_.edges;
  return space().WithinLimits(from) && space().WithinLimits(to) &&
         !FindBlocked(from, to, from_is_free);
}

std::optional<double> EdgeChecker::FindBlocked(std::span<const double> from,
                                               std::span<const double> to, bool from_is_free) {
  RequireSize(from);
  RequireSize(to);
  motion_.resize(from.size());
  double motion_m = 0;
  for (std::size_t j = 0; j < motion_.size(); ++j) {
    motion_[j] = space().Difference(static_cast<int>(j), from[j], to[j]);
    motion_m += std::abs(motion_[j]) * checker_->motion_bound().reach()[j];
  }
  unasked_ = 0;
  return method_ == EdgeCheck::kFixed ? FindBlockedSample(from, motion_m, from_is_free)
                                      : FindBlockedStretch(from, motion_m);
}

SampleVerdicts EdgeChecker::CheckBlock(std::span<const double> from) {
  counters_.configurations += static_cast<std::int64_t>(block_.size());
  unasked_ += static_cast<std::int64_t>(block_.size());
  return checker_->CheckSamples(from, motion_, block_);
}

std::optional<double> EdgeChecker::FindBlockedSample(std::span<const double> from, double motion_m,
                                                     bool from_is_free) {
  const std::int64_t num_parts = RequireFewIntervals(NumIntervals(motion_m));
  const auto batch = static_cast<std::size_t>(std::min(checker_->BatchSize(), kMaxBlock));
  std::int64_t part = 0;
  bool start_is_due = !from_is_free;  // behind the far end
  while (part >= 0 || start_is_due) {
    block_.clear();
    while (block_.size() < batch && (part >= 0 || start_is_due)) {
      if (part != 0 && start_is_due) {
        block_.push_back({0});
        start_is_due = false;
        continue;
      }
      block_.push_back({SamplePosition(part, num_parts)});
      part = NextSample(part, num_parts);
    }
    if (GiveUp()) return block_.front().position;
    const std::uint64_t blocked = CheckBlock(from).blocked;
    if (blocked != 0) return block_[static_cast<std::size_t>(std::countr_zero(blocked))].position;
  }
  return std::nullopt;
}

std::optional<double> EdgeChecker::FindBlockedStretch(std::span<const double> from,
                                                      double motion_m) {
  const std::int64_t batch = std::min(checker_->BatchSize(), kMaxBlock);
  // Coarser than the fixed method, since in open space few stretches do, but whole blocks.
  std::int64_t parts = RequireFewIntervals(NumIntervals(motion_m / kFirstStretch));
  parts = (parts + batch - 1) / batch * batch;
  pending_.clear();
  for (std::int64_t part = 0; part >= 0; part = NextSample(part, parts)) {
    // The sample at the far end of interval `part` stands for the interval.
    const double half_length = 0.5 / static_cast<double>(parts);
    pending_.push_back({SamplePosition(part, parts) - half_length, half_length});
  }
  for (std::size_t next = 0; next < pending_.size(); next += block_.size()) {
    const auto size = std::min(static_cast<std::size_t>(batch), pending_.size() - next);
    const auto begin = pending_.begin() + static_cast<std::ptrdiff_t>(next);
    block_.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
    if (GiveUp()) return block_.front().position;
    const SampleVerdicts verdicts = CheckBlock(from);
    if (verdicts.certain != 0) {
      return block_[static_cast<std::size_t>(std::countr_zero(verdicts.certain))].position;
    }
    for (std::uint64_t open = verdicts.blocked; open != 0; open &= open - 1) {
      const MotionSample& stretch = block_[static_cast<std::size_t>(std::countr_zero(open))];
      if (2 * stretch.half_length * motion_m <= kCertifiedDepth) return stretch.position;
      const double half_length = stretch.half_length / kCuts;
      for (int cut = 0; cut < kCuts; ++cut) {
        pending_.push_back({stretch.position + (2 * cut + 1 - kCuts) * half_length, half_length});
      }
    }
  }
  return std::nullopt;
}

double EdgeChecker::NumIntervals(std::span<const double> from, std::span<const double> to) const {
  RequireSize(from);
  RequireSize(to);
  return NumIntervals(checker_->motion_bound().Between(space(), from, to));
}

double EdgeChecker::NumIntervals(double motion_m) const {
  return std::max(1.0, std::ceil(motion_m / edge_resolution_m_));
}

std::int64_t EdgeChecker::RequireFewIntervals(double intervals) const {
  constexpr double kMost = 1 << 30;
  if (!(intervals < kMost)) {
    throw InputError(fmt::format("edge resolution {} m divides an edge into too many parts",
                                 edge_resolution_m_));
  }
  return static_cast<std::int64_t>(intervals);
}

}  // namespace planbench
