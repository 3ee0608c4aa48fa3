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

class Stopwatch {
 public:
  explicit Stopwatch(double* total_s) : total_s_(total_s) {}
  ~Stopwatch() {
    *total_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double* total_s_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// The lowest `bits` bits of `value` in reverse order.
std::uint32_t ReverseBits(std::uint32_t value, int bits) {
  std::uint32_t reversed = 0;
  for (int i = 0; i < bits; ++i) reversed |= ((value >> i) & 1u) << (bits - 1 - i);
  return reversed;
}

}  // namespace

EdgeChecker::EdgeChecker(CollisionChecker* checker, double edge_resolution_m)
    : checker_(checker), edge_resolution_m_(edge_resolution_m) {
  if (!std::isfinite(edge_resolution_m) || edge_resolution_m <= 0) {
    throw InputError(
        fmt::format("edge resolution must be a positive length in m, it is {}", edge_resolution_m));
  }
  block_.resize(static_cast<std::size_t>(checker_->BatchSize() * space().size()));
}

void EdgeChecker::RequireSize(std::span<const double> q) const {
  if (static_cast<int>(q.size()) != space().size()) {
    throw InputError(fmt::format("edge checker: a configuration of {} values given for {} joints",
                                 q.size(), space().size()));
  }
}

bool EdgeChecker::IsValidState(std::span<const double> q) {
  RequireSize(q);
  const Stopwatch stopwatch(&counters_.seconds);
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
  const Stopwatch stopwatch(&counters_.seconds);
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
  const Stopwatch stopwatch(&counters_.seconds);
  ++counters_.edges;
  if (!space().WithinLimits(from) || !space().WithinLimits(to)) return false;

  const auto n = static_cast<std::size_t>(space().size());
  const int batch = checker_->BatchSize();
  const int intervals = NumIntervals(from, to);
  int filled = 0;
  const auto block_is_free = [&] {
    if (filled == 0) return true;
    const std::int64_t before = checker_->num_checks();
    const int found = checker_->FindCollision(
        std::span(block_).first(static_cast<std::size_t>(filled) * n), filled);
    counters_.configurations += checker_->num_checks() - before;
    filled = 0;
    return found < 0;
  };
  const auto sample_is_free = [&](int sample) {
    space().Interpolate(from, to, static_cast<double>(sample) / intervals,
                        std::span(block_).subspan(static_cast<std::size_t>(filled) * n, n));
    ++filled;
    return filled < batch || block_is_free();
  };

  // Neighbouring samples collide together, so the next sample worth trying is the one furthest from
  // all before: the ends, the middle, the quarters, ... (the van der Corput sequence).
  if (!sample_is_free(intervals)) return false;
  if (!from_is_free && !sample_is_free(0)) return false;
  const int bits = std::bit_width(static_cast<std::uint32_t>(intervals - 1));
  for (std::uint32_t i = 1; i < (1u << bits); ++i) {
    const auto sample = static_cast<int>(ReverseBits(i, bits));
    if (sample < intervals && !sample_is_free(sample)) return false;
  }
  return block_is_free();
}

void EdgeChecker::CheckEdges(std::span<const double> from, std::span<const double> tos, int num,
                             std::span<unsigned char> valid, bool from_is_free) {
  const auto n = static_cast<std::size_t>(space().size());
  const auto count = static_cast<std::size_t>(num);
  if (num < 0 || tos.size() != count * n || valid.size() != count) {
    throw InputError(fmt::format("edge checker: {} values and room for {} verdicts for {} edges",
                                 tos.size(), valid.size(), num));
  }
  for (std::size_t i = 0; i < count; ++i) {
    valid[i] = IsValidEdge(from, tos.subspan(i * n, n), from_is_free) ? 1 : 0;
  }
}

int EdgeChecker::NumIntervals(std::span<const double> from, std::span<const double> to) const {
  RequireSize(from);
  RequireSize(to);
  const double intervals =
      std::ceil(checker_->motion_bound().Between(space(), from, to) / edge_resolution_m_);
  if (!(intervals < std::numeric_limits<int>::max() / 2)) {
    throw InputError(fmt::format("edge resolution {} m divides an edge into too many parts",
                                 edge_resolution_m_));
  }
  return std::max(1, static_cast<int>(intervals));
}

}  // namespace planbench
