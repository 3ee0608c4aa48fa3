#include "results/untold_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <optional>

#include "common/numbers.h"
#include "results/statistics.h"

namespace planbench {
namespace {

/// So many times what the others leave untold is much,
constexpr double kMuchOfOthers = 10;
/// and so many times what is told itself.
constexpr double kMuchOfTold = 2;
/// Others leave at least so much untold, s, whatever they measured: a busy machine's noise.
constexpr double kLeastOfOthers_s = 2e-3;
/// What stands for others where there are none, s.
constexpr double kWithoutOthers_s = 10e-3;

struct Medians {
  double told_s = 0;
  double untold_s = 0;
};

Medians MediansOf(const std::vector<AnswerTimes>& runs) {
  std::vector<double> told_s, untold_s;
  for (const AnswerTimes& run : runs) {
    told_s.push_back(run.told_s);
    untold_s.push_back(std::max(0.0, run.roundtrip_s - run.told_s - run.waited_s));
  }
  return {Summarize(std::move(told_s)).median, Summarize(std::move(untold_s)).median};
}

/// The median of what the others leave untold, the lower one of two; nothing without others.
std::optional<double> OfOthers(const std::map<std::string, Medians>& medians,
                               const std::string& contestant) {
  std::vector<double> untold_s;
  for (const auto& [name, of_one] : medians) {
    if (name != contestant) untold_s.push_back(of_one.untold_s);
  }
  if (untold_s.empty()) return std::nullopt;
  std::sort(untold_s.begin(), untold_s.end());
  return untold_s[(untold_s.size() - 1) / 2];
}

/// In ms, as far as three digits hold them.
std::string WithUnit(double time_s) {
  return time_s < 0.9995 ? fmt::format("{:.3g} ms", kMsPerS * time_s)
                         : fmt::format("{:.3g} s", time_s);
}

using TimesByContestant = std::map<std::string, std::vector<AnswerTimes>>;

/// The runs that ended in one of these ways.
TimesByContestant WithStatus(const TimesByContestant& all,
                             std::initializer_list<PlanStatus> statuses) {
  TimesByContestant selected;
  for (const auto& [name, runs] : all) {
    for (const AnswerTimes& run : runs) {
      if (std::ranges::find(statuses, run.status) == statuses.end()) continue;
      selected[name].push_back(run);
    }
  }
  return selected;
}

/// Adds to the lines; `of_all`: the runs of all with which others are compared; `runs`: in words,
/// which they are.
void AddUntoldTimes(const TimesByContestant& by_contestant, const TimesByContestant& of_all,
                    const std::string& runs, std::map<std::string, std::string>* lines) {
  std::map<std::string, Medians> medians;
  for (const auto& [name, times] : of_all) medians[name] = MediansOf(times);
  for (const auto& [name, times] : by_contestant) {
    const Medians own = MediansOf(times);
    const std::optional<double> others_s = OfOthers(medians, name);
    const double typical_s = others_s ? std::max(*others_s, kLeastOfOthers_s) : kWithoutOthers_s;
    if (own.untold_s <= kMuchOfOthers * typical_s || own.untold_s <= kMuchOfTold * own.told_s) {
      continue;
    }
    std::string& line = (*lines)[name];
    if (!line.empty()) line += " ";
    line += fmt::format(
        "{}: its answers tell of {}, and {} more passed until they came{}: its times may be too "
        "short. Medians over {}, without waiting for a processor.",
        name, WithUnit(own.told_s), WithUnit(own.untold_s),
        others_s ? fmt::format(" (others: {})", WithUnit(*others_s)) : "", runs);
  }
}

}  // namespace

std::map<std::string, std::string> DescribeUntoldTimes(const TimesByContestant& by_contestant) {
  using enum PlanStatus;
  std::map<std::string, std::string> lines;
  const TimesByContestant confirmed = WithStatus(by_contestant, {kSolved});
  AddUntoldTimes(confirmed, confirmed, "the confirmed runs", &lines);
  const TimesByContestant failed =
      WithStatus(by_contestant, {kTimedOut, kExhausted, kMemoryLimit, kInvalidPath});
  // Who times out tells of half of the time, or is charged with it: that would hide the others.
  AddUntoldTimes(WithStatus(by_contestant, {kExhausted, kMemoryLimit, kInvalidPath}), failed,
                 "its failed runs but those that timed out, and the failed ones of others", &lines);
  return lines;
}

}  // namespace planbench
