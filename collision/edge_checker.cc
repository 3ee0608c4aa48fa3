#include "collision/edge_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>

#include "common/error.h"

namespace planbench {
namespace {

/// One call in this many is timed: two readings of a clock cost as much as a short edge.
constexpr std::int64_t kTimedCalls = 8;
/// Samples that CheckSamples takes at once.
constexpr int kMaxBlock = 64;
/// Certified edges are first cut into stretches of this many edge resolutions ...
constexpr double kFirstStretch = 4;
/// ... and those not proven free into this many parts.
constexpr int kCuts = 4;

/// Adds the time a call takes to a total, times kTimedCalls.
class Stopwatch {
 public:
  /// Null: takes no time, and none is taken.
  explicit Stopwatch(double* total_s) : total_s_(total_s) {
    if (total_s_ != nullptr) begin_ = std::chrono::steady_clock::now();
  }
  ~Stopwatch() {
    if (total_s_ == nullptr) return;
    *total_s_ += kTimedCalls *
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double* total_s_;
  std::chrono::steady_clock::time_point begin_;
};

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

bool EdgeChecker::IsValidState(std::span<const double> q) {
  RequireSize(q);
  const Stopwatch stopwatch(num_calls_++ % kTimedCalls == 0 ? &counters_.seconds : nullptr);
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
  const Stopwatch stopwatch(num_calls_++ % kTimedCalls == 0 ? &counters_.seconds : nullptr);
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
  RequireSize(to);
  unsigned char valid = 0;
  CheckEdges(from, to, 1, {&valid, 1}, from_is_free);
  return valid != 0;
}

void EdgeChecker::CheckEdges(std::span<const double> from, std::span<const double> tos, int num,
                             std::span<unsigned char> valid, bool from_is_free) {
  RequireSize(from);
  const auto n = static_cast<std::size_t>(space().size());
  const auto count = static_cast<std::size_t>(std::max(num, 0));
  if (num < 0 || tos.size() != count * n || valid.size() != count) {
    throw InputError(fmt::format("edge checker: {} values and room for {} verdicts for {} edges",
                                 tos.size(), valid.size(), num));
  }
  const Stopwatch stopwatch(num_calls_++ % kTimedCalls == 0 ? &counters_.seconds : nullptr);
  counters_.edges += num;
  std::fill(valid.begin(), valid.end(), 0);
  if (!space().WithinLimits(from)) return;
  edges_.resize(count);
  motions_.resize(count * n);
  for (std::size_t i = 0; i < count; ++i) {
    const auto to = tos.subspan(i * n, n);
    edges_[i].open = space().WithinLimits(to);
    valid[i] = edges_[i].open ? 1 : 0;
    if (!edges_[i].open) {
      std::fill_n(motions_.begin() + static_cast<std::ptrdiff_t>(i * n), n, 0.0);
      continue;
    }
    edges_[i].motion_m = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const double motion = space().Difference(static_cast<int>(j), from[j], to[j]);
      motions_[i * n + j] = motion;
      edges_[i].motion_m += std::abs(motion) * checker_->motion_bound().reach()[j];
    }
  }
  if (method_ == EdgeCheck::kFixed) {
    CheckFixed(from, valid, from_is_free);
  } else {
    CheckCertified(from, valid);
  }
}

SampleVerdicts EdgeChecker::CheckBlock(std::span<const double> from, bool stop_at_first) {
  counters_.configurations += static_cast<std::int64_t>(block_.size());
  return checker_->CheckSamples(from, motions_, block_, stop_at_first);
}

void EdgeChecker::CheckFixed(std::span<const double> from, std::span<unsigned char> valid,
                             bool from_is_free) {
  for (Edge& edge : edges_) {
    if (!edge.open) continue;
    edge.num_parts = NumIntervals(edge.motion_m);
    edge.next_part = 0;
  }
  const auto batch = static_cast<std::size_t>(std::min(checker_->BatchSize(), kMaxBlock));
  const bool alone = edges_.size() == 1;
  bool start_is_due = !from_is_free;  // one sample serves all edges
  bool is_first = true;
  std::size_t turn = 0;
  // The next edge that has samples left, each in turn; the number of edges if none has.
  const auto next_edge = [&] {
    for (std::size_t tried = 0; tried < edges_.size(); ++tried) {
      const std::size_t edge = turn;
      turn = turn + 1 == edges_.size() ? 0 : turn + 1;
      if (edges_[edge].open) return edge;
    }
    return edges_.size();
  };
  while (true) {
    block_.clear();
    while (block_.size() < batch) {
      if (start_is_due && !is_first) {
        block_.push_back({0, 0.0});
        start_is_due = false;
        continue;
      }
      const std::size_t i = next_edge();
      if (i == edges_.size()) break;
      Edge& edge = edges_[i];
      block_.push_back({static_cast<int>(i), SamplePosition(edge.next_part, edge.num_parts)});
      edge.next_part = NextSample(edge.next_part, edge.num_parts);
      if (edge.next_part < 0) edge.open = false;
      is_first = false;
    }
    if (block_.empty()) return;
    SampleVerdicts verdicts = CheckBlock(from, alone);
    for (; verdicts.blocked != 0; verdicts.blocked &= verdicts.blocked - 1) {
      const MotionSample& sample =
          block_[static_cast<std::size_t>(std::countr_zero(verdicts.blocked))];
      if (sample.position == 0) {
        std::fill(valid.begin(), valid.end(), 0);
        return;
      }
      valid[static_cast<std::size_t>(sample.motion)] = 0;
      edges_[static_cast<std::size_t>(sample.motion)].open = false;
    }
  }
}

void EdgeChecker::CheckCertified(std::span<const double> from, std::span<unsigned char> valid) {
  const std::int64_t batch = std::min(checker_->BatchSize(), kMaxBlock);
  pending_.clear();
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    Edge& edge = edges_[i];
    if (!edge.open) continue;
    // Coarser than the fixed method: in open space few stretches do. One edge alone fills a block.
    std::int64_t parts = NumIntervals(edge.motion_m / kFirstStretch);
    if (edges_.size() == 1) parts = (parts + batch - 1) / batch * batch;
    const double half_length = 0.5 / static_cast<double>(parts);
    for (std::int64_t part = 0; part >= 0; part = NextSample(part, parts)) {
      // The sample at the far end of interval `part` stands for the interval.
      pending_.push_back(
          {static_cast<int>(i), SamplePosition(part, parts) - half_length, half_length});
    }
  }
  for (std::size_t next = 0; next < pending_.size();) {
    block_.clear();
    while (next < pending_.size() && static_cast<std::int64_t>(block_.size()) < batch) {
      const MotionSample& stretch = pending_[next++];
      if (edges_[static_cast<std::size_t>(stretch.motion)].open) block_.push_back(stretch);
    }
    if (block_.empty()) return;
    const SampleVerdicts verdicts = CheckBlock(from, edges_.size() == 1);
    for (std::uint64_t open = verdicts.blocked; open != 0; open &= open - 1) {
      const int k = std::countr_zero(open);
      const MotionSample stretch = block_[static_cast<std::size_t>(k)];
      Edge& edge = edges_[static_cast<std::size_t>(stretch.motion)];
      const bool certain = (verdicts.certain >> k & 1) != 0;
      if (certain || 2 * stretch.half_length * edge.motion_m <= kCertifiedDepth) {
        valid[static_cast<std::size_t>(stretch.motion)] = 0;
        edge.open = false;
        if (edges_.size() == 1) return;
        continue;
      }
      const double half_length = stretch.half_length / kCuts;
      for (int cut = 0; cut < kCuts; ++cut) {
        pending_.push_back(
            {stretch.motion, stretch.position + (2 * cut + 1 - kCuts) * half_length, half_length});
      }
    }
  }
}

int EdgeChecker::NumIntervals(std::span<const double> from, std::span<const double> to) const {
  RequireSize(from);
  RequireSize(to);
  return NumIntervals(checker_->motion_bound().Between(space(), from, to));
}

int EdgeChecker::NumIntervals(double motion_m) const {
  const double intervals = std::ceil(motion_m / edge_resolution_m_);
  if (!(intervals < std::numeric_limits<int>::max() / 2)) {
    throw InputError(fmt::format("edge resolution {} m divides an edge into too many parts",
                                 edge_resolution_m_));
  }
  return std::max(1, static_cast<int>(intervals));
}

}  // namespace planbench
