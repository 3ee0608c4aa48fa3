#include "collision/edge_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "common/error.h"
#include "common/stopwatch.h"

namespace planbench {
namespace {

/// Samples that CheckSamples takes at once.
constexpr int kMaxBlock = 64;
/// Stretches that an edge seldom has more of: room for them is made before there is one.
constexpr std::size_t kUsualStretches = 256;
/// Whether to stop is asked after this many samples: seldom enough to cost nothing, often enough
/// where each is the work of an exact engine on meshes.
constexpr std::int64_t kSamplesUnasked = 64;
/// Certified edges are first cut into this many stretches, handed over at once, in the order of
/// NextSample as engines may take fewer at a time ...
constexpr int kFirstStretches = 16;
/// ... and those not proven free into this many parts.
constexpr int kCuts = 4;

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
    : checker_(checker), resolution_(edge_resolution_m), method_(method) {
  if (!std::isfinite(edge_resolution_m) || edge_resolution_m <= 0) {
    throw InputError(
        fmt::format("edge resolution must be a positive length in m, it is {}", edge_resolution_m));
  }
  Reserve();
}

EdgeChecker::EdgeChecker(CollisionChecker* checker, EdgeSampling sampling)
    : checker_(checker), resolution_(sampling.step), method_(EdgeCheck::kFixed) {
  if (!std::isfinite(resolution_) || resolution_ <= 0) {
    throw InputError(
        fmt::format("edge sampling: the step must be positive, it is {}", resolution_));
  }
  RequireSize(sampling.weights);
  sampling_ = std::move(sampling);
  Reserve();
}

// So that no edge has to wait for memory.
void EdgeChecker::Reserve() {
  motion_.reserve(static_cast<std::size_t>(space().size()));
  block_.reserve(kMaxBlock);
  pending_.reserve(kUsualStretches);
  constexpr double kHalfLength = 0.5 / kFirstStretches;
  for (std::int64_t k = 0; k >= 0; k = NextSample(k, kFirstStretches)) {
    pending_.push_back({SamplePosition(k, kFirstStretches) - kHalfLength, kHalfLength});
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
  unasked_ = 0;
}

bool EdgeChecker::GiveUp() {
  gave_up_ = false;
  if (!stopped_ && unasked_ < kSamplesUnasked) return false;
  unasked_ = 0;
  gave_up_ = should_stop_ && should_stop_();
  stopped_ = stopped_ || gave_up_;
  return gave_up_;
}

bool EdgeChecker::IsValidState(std::span<const double> q) {
  RequireSize(q);
  const ScopedTimer timer(&counters_.ticks);
  ++counters_.states;
  if (!space().WithinLimits(q)) return false;
  ++counters_.configurations;
  return checker_->IsFree(q);
}

void EdgeChecker::CheckStates(std::span<const double> qs, int num, std::span<unsigned char> valid) {
  CheckStatesBy(&CollisionChecker::CheckAll, qs, num, valid);
}

void EdgeChecker::ScreenStates(std::span<const double> qs, int num,
                               std::span<unsigned char> valid) {
  CheckStatesBy(&CollisionChecker::Screen, qs, num, valid);
}

void EdgeChecker::CheckStatesBy(JudgeStates judge, std::span<const double> qs, int num,
                                std::span<unsigned char> valid) {
  const auto n = static_cast<std::size_t>(space().size());
  const auto count = static_cast<std::size_t>(std::max(num, 0));
  if (num < 0 || qs.size() != count * n || valid.size() != count) {
    throw InputError(
        fmt::format("edge checker: {} values and room for {} verdicts given for {} states of {} "
                    "joints",
                    qs.size(), valid.size(), num, n));
  }
  const ScopedTimer timer(&counters_.ticks);
  counters_.states += num;
  std::size_t begin = 0;  // of a run of states within limits, which go to the engine together
  const auto check_run = [&](std::size_t end) {
    if (end == begin) return;
    counters_.configurations += static_cast<std::int64_t>(end - begin);
    (checker_->*judge)(qs.subspan(begin * n, (end - begin) * n), static_cast<int>(end - begin),
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

void EdgeChecker::FindClearances(std::span<const double> qs, int num, double at_most,
                                 std::span<double> clearances) {
  const ScopedTimer timer(&counters_.ticks);
  counters_.configurations += num;
  checker_->FindClearances(qs, num, at_most, clearances);
}

bool EdgeChecker::IsValidEdge(std::span<const double> from, std::span<const double> to,
                              bool from_is_free) {
  RequireSize(from);
  RequireSize(to);
  const ScopedTimer timer(&counters_.ticks);
  ++counters_.edges;
  gave_up_ = false;
  return space().WithinLimits(from) && space().WithinLimits(to) &&
         !FindBlocked(from, to, from_is_free);
}

std::optional<double> EdgeChecker::FindBlocked(std::span<const double> from,
                                               std::span<const double> to, bool from_is_free) {
  RequireSize(from);
  RequireSize(to);
  const double motion = Move(from, to, &motion_);
  return method_ == EdgeCheck::kFixed ? FindBlockedSample(from, motion, from_is_free)
                                      : FindBlockedStretch(from, motion);
}

double EdgeChecker::FindFreePart(std::span<const double> from, std::span<const double> to) {
  RequireSize(from);
  RequireSize(to);
  const ScopedTimer timer(&counters_.ticks);
  ++counters_.edges;
  gave_up_ = false;
  if (!space().WithinLimits(from) || !space().WithinLimits(to)) return 0;
  const double motion = Move(from, to, &motion_);
  return method_ == EdgeCheck::kFixed ? FreeSamples(from, motion) : FreeStretches(from, to, motion);
}

double EdgeChecker::FreeSamples(std::span<const double> from, double motion) {
  const std::int64_t num_parts = RequireFewIntervals(NumIntervals(motion));
  const std::int64_t batch = std::min(checker_->BatchSize(), kMaxBlock);
  std::int64_t free = 0;  // samples that are, in order
  bool is_blocked = false;
  while (free < num_parts && !is_blocked && !GiveUp()) {
    block_.clear();
    for (std::int64_t part = free + 1; part <= std::min(free + batch, num_parts); ++part) {
      block_.push_back({static_cast<double>(part) / static_cast<double>(num_parts)});
    }
    // Where one collides, the engine may not have looked at those before it.
    while (!block_.empty()) {
      const std::uint64_t blocked = CheckBlock(from, block_, SampleRole::kMotion).blocked;
      if (blocked == 0) break;
      is_blocked = true;
      block_.resize(static_cast<std::size_t>(std::countr_zero(blocked)));
    }
    free += static_cast<std::int64_t>(block_.size());
  }
  return static_cast<double>(free) / static_cast<double>(num_parts);
}

double EdgeChecker::FreeStretches(std::span<const double> from, std::span<const double> to,
                                  double motion_m) {
  if (!FindBlockedStretch(from, motion_m)) return 1;
  // What blocks first is within halves of halves: where it was found tells nothing here, since
  // which of several stretches is found depends on how many the engine handles at once.
  double free = 0;
  double blocked = 1;
  std::vector<double> begin(from.begin(), from.end()), end(from.size());
  while ((blocked - free) * motion_m > resolution_) {
    const double middle = (free + blocked) / 2;
    space().Interpolate(from, to, middle, end);
    if (FindBlocked(begin, end, /*from_is_free=*/true)) {
      blocked = middle;
    } else {
      free = middle;
      begin.swap(end);
    }
  }
  return free;
}

double EdgeChecker::Move(std::span<const double> from, std::span<const double> to,
                         std::vector<double>* motion) const {
  const bool squares = sampling_ && sampling_->euclidean;
  const std::vector<double>& weights =
      sampling_ ? sampling_->weights : checker_->motion_bound().reach();
  motion->resize(from.size());
  double sum = 0;
  for (std::size_t j = 0; j < from.size(); ++j) {
    (*motion)[j] = space().Difference(static_cast<int>(j), from[j], to[j]);
    const double weighted = std::abs((*motion)[j]) * weights[j];
    sum += squares ? weighted * weighted : weighted;
  }
  return squares ? std::sqrt(sum) : sum;
}

SampleVerdicts EdgeChecker::CheckBlock(std::span<const double> from,
                                       std::span<const MotionSample> block, SampleRole role) {
  counters_.configurations += static_cast<std::int64_t>(block.size());
  unasked_ += static_cast<std::int64_t>(block.size());
  return checker_->CheckSamples(from, motion_, block, role);
}

std::optional<double> EdgeChecker::FindBlockedSample(std::span<const double> from, double motion,
                                                     bool from_is_free) {
  const std::int64_t num_parts = RequireFewIntervals(NumIntervals(motion));
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
    const std::uint64_t blocked = CheckBlock(from, block_, SampleRole::kMotion).blocked;
    if (blocked != 0) return block_[static_cast<std::size_t>(std::countr_zero(blocked))].position;
  }
  return std::nullopt;
}

std::optional<double> EdgeChecker::FindBlockedStretch(std::span<const double> from,
                                                      double motion_m) {
  pending_.resize(kFirstStretches);  // without the cuts of the edge before
  for (std::size_t next = 0; next < pending_.size();) {
    const auto size = std::min<std::size_t>(kFirstStretches, pending_.size() - next);
    if (GiveUp()) return pending_[next].position;
    const SampleVerdicts verdicts = CheckBlock(from, {&pending_[next], size},
                                               next == 0 ? SampleRole::kMotion : SampleRole::kCuts);
    if (verdicts.certain != 0) {
      return pending_[next + static_cast<std::size_t>(std::countr_zero(verdicts.certain))].position;
    }
    for (std::uint64_t open = verdicts.blocked; open != 0; open &= open - 1) {
      const MotionSample stretch =
          pending_[next + static_cast<std::size_t>(std::countr_zero(open))];
      if (2 * stretch.half_length * motion_m <= kCertifiedDepth) return stretch.position;
      const double half_length = stretch.half_length / kCuts;
      for (int cut = 0; cut < kCuts; ++cut) {
        pending_.push_back({stretch.position + (2 * cut + 1 - kCuts) * half_length, half_length});
      }
    }
    next += size;
  }
  return std::nullopt;
}

double EdgeChecker::NumIntervals(std::span<const double> from, std::span<const double> to) const {
  RequireSize(from);
  RequireSize(to);
  std::vector<double> motion;
  return NumIntervals(Move(from, to, &motion));
}

double EdgeChecker::NumIntervals(double motion) const {
  return std::max(1.0, std::ceil(motion / resolution_));
}

std::int64_t EdgeChecker::RequireFewIntervals(double intervals) const {
  constexpr double kMost = 1 << 30;
  if (!(intervals < kMost)) {
    throw InputError(
        fmt::format("edge resolution {} divides an edge into too many parts", resolution_));
  }
  return static_cast<std::int64_t>(intervals);
}

}  // namespace planbench
