#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "report/figures.h"
#include "report/tables.h"
#include "tests/report/statistics_by_definition.h"
#include "tests/support/session_database.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

// Every number of the report, of a session with ties, failures, rejections and both directions,
// against the same worked out from the runs as they were made (statistics_by_definition.h).

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kLimit = 10;  // s, as MakeRecord has it
constexpr int kTrials = 3, kProblems = 8;
const std::vector<std::string> kNames = {"alpha", "beta", "gamma"};
const std::vector<std::string> kSets = {"desk", "shelf"};

/// A contestant's trial at a problem.
struct Trial {
  std::string set;
  int problem = 0;
  std::vector<MadeRun> attempts;
  bool claimed = false;
  double time_s = kNever;  ///< To the confirmed path.
};
using Trials = std::vector<Trial>;

MadeRun Attempt(int c, const std::string& set, int problem, int trial) {
  const int mixed = 7 * problem + 3 * trial + 5 * c + (set == "desk" ? 2 : 0);
  MadeRun run{.contestant = kNames[static_cast<std::size_t>(c)],
              .set = set,
              .problem = problem,
              .trial = trial,
              .time_s = 0.05 * (1 + mixed % 13) * (1 + 0.5 * c),
              .length = 1.0 + mixed % 7,
              .length_simplified = 0.5 + mixed % 5};
  if ((problem + trial + 2 * c) % 5 == 0 || (c == 2 && problem == 5)) {
    run.status = PlanStatus::kTimedOut;
    run.time_s = kLimit;
    run.reason = problem % 2 == 0 ? "even" : "odd";
  } else if (c == 2 && problem == 3 && trial == 1) {
    run.status = PlanStatus::kInvalidPath;
    run.reason = "touches";
  }
  return run;
}

Trials TrialsOf(int c) {
  Trials trials;
  for (const std::string& set : kSets) {
    for (int problem = 1; problem <= kProblems; ++problem) {
      for (int number = 1; number <= kTrials; ++number) {
        Trial trial{set, problem, {Attempt(c, set, problem, number)}};
        MadeRun last = trial.attempts.front();
        double time_s = last.time_s;
        if (c == 1 && last.status == PlanStatus::kTimedOut) {
          last.direction = Direction::kBackward;
          if (problem % 2 == 0) {
            last.status = PlanStatus::kSolved;
            last.time_s = 0.7 * problem;
            last.reason = "";
          }
          time_s += last.time_s;
          trial.attempts.push_back(last);
        }
        trial.claimed = last.status != PlanStatus::kTimedOut;
        if (last.status == PlanStatus::kSolved) trial.time_s = time_s;
        trials.push_back(trial);
      }
    }
  }
  return trials;
}

class NumbersTest : public testing::Test {
 protected:
  static ComparedSessions Read() {
    std::vector<MadeRun> runs;
    for (int c = 0; c < 3; ++c) {
      for (const Trial& trial : TrialsOf(c)) {
        runs.insert(runs.end(), trial.attempts.begin(), trial.attempts.end());
      }
    }
    const TemporaryFolder folder;
    WriteSession(folder / "example", runs);
    return ComparedSessions(ReadSessions(folder / "example").sessions);
  }

  /// `set` "all sets": of both.
  static Trials Of(const std::string& name, const std::string& set) {
    const auto place = std::find(kNames.begin(), kNames.end(), name) - kNames.begin();
    Trials trials = TrialsOf(static_cast<int>(place));
    std::erase_if(trials, [&](const Trial& one) { return set != kAllSets && one.set != set; });
    return trials;
  }
  /// What `value` gives of a problem's trials, problem by problem; NaN is left out.
  template <typename Value>
  static std::vector<double> ByProblem(const Trials& trials, Value value) {
    std::map<std::pair<std::string, int>, Trials> problems;
    for (const Trial& one : trials) problems[{one.set, one.problem}].push_back(one);
    std::vector<double> values;
    for (const auto& [key, of_problem] : problems) {
      const double one = value(of_problem);
      if (!std::isnan(one)) values.push_back(one);
    }
    return values;
  }
  /// Median over the trials of a problem, those not solved longer than any.
  static std::vector<double> ProblemTimes(const Trials& trials) {
    return ByProblem(trials, [](const Trials& problem) {
      std::vector<double> times;
      for (const Trial& one : problem) times.push_back(one.time_s);
      return QuantileOf(times, 0.5);
    });
  }
  /// Median of what the confirmed attempts of a problem measured; NaN if there are none.
  static double MedianLength(const Trials& problem, double MadeRun::*length) {
    std::vector<double> lengths;
    for (const Trial& trial : problem) {
      for (const MadeRun& run : trial.attempts) {
        if (run.status == PlanStatus::kSolved) lengths.push_back(run.*length);
      }
    }
    return lengths.empty() ? std::nan("") : QuantileOf(lengths, 0.5);
  }

  static std::size_t ColumnAt(const Table& table, const std::string& name) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      if (table.columns[i].name == name) return i;
    }
    throw std::out_of_range(name);
  }
  static double Value(const Table& table, const std::vector<Cell>& row, const std::string& name) {
    const Cell& cell = row.at(ColumnAt(table, name));
    if (const int* count = std::get_if<int>(&cell)) return *count;
    if (const double* number = std::get_if<double>(&cell)) return *number;
    return std::get<Estimate>(cell).value;
  }
  static std::optional<Interval> IntervalOf(const Table& table, const std::vector<Cell>& row,
                                            const std::string& name) {
    return std::get<Estimate>(row.at(ColumnAt(table, name))).interval;
  }
  static std::string Text(const Table& table, const std::vector<Cell>& row,
                          const std::string& name) {
    return std::get<std::string>(row.at(ColumnAt(table, name)));
  }
  static void ExpectNear(double expected, double value, const std::string& what) {
    EXPECT_NEAR(value, expected, 1e-5 * std::abs(expected) + 1e-12) << what;
  }
  static void ExpectInterval(const std::optional<Interval>& expected,
                             const std::optional<Interval>& interval, double unit,
                             const std::string& what) {
    ASSERT_EQ(expected.has_value(), interval.has_value()) << what;
    if (!expected) return;
    EXPECT_NEAR(interval->lower, unit * expected->lower, 1e-5 * unit) << what;
    EXPECT_NEAR(interval->upper, unit * expected->upper, 1e-5 * unit) << what;
  }

  const ComparedSessions compared_ = Read();
  const std::vector<ComparedPair> pairs_ = ComparePairs(compared_);
};

TEST_F(NumbersTest, Success) {
  const Table table = SuccessTable(compared_);
  ASSERT_EQ(table.rows.size(), 6u);
  for (const auto& row : table.rows) {
    const std::string set = Text(table, row, "set"), name = Text(table, row, "contestant");
    const Trials trials = Of(name, set);
    std::map<std::string, int> counts;
    for (const Trial& one : trials) {
      const PlanStatus first = one.attempts.front().status, last = one.attempts.back().status;
      counts["claimed"] += one.claimed;
      counts["confirmed"] += std::isfinite(one.time_s);
      counts["forward"] += first == PlanStatus::kSolved;
      counts["backward"] += first != last && last == PlanStatus::kSolved;
      counts["failed"] += last == PlanStatus::kTimedOut;
      counts["rejected"] += last == PlanStatus::kInvalidPath;
    }
    EXPECT_EQ(Value(table, row, "problems"), kProblems);
    EXPECT_EQ(Value(table, row, "runs"), trials.size());
    for (const char* column : {"claimed", "confirmed", "forward", "backward", "failed", "blocked",
                               "rejected", "no_answer", "refused"}) {
      EXPECT_EQ(Value(table, row, column), counts[column]) << name << " " << column;
    }
    const double share = counts["confirmed"] / static_cast<double>(trials.size());
    ExpectNear(100 * share, Value(table, row, "confirmed_percent"), name);
    ExpectInterval(ScoreInterval(share, kProblems), IntervalOf(table, row, "confirmed_percent"),
                   100, name);
  }
}

TEST_F(NumbersTest, Times) {
  const Table table = TimeTable(compared_);
  ASSERT_EQ(table.rows.size(), 6u);
  for (const auto& row : table.rows) {
    const std::string set = Text(table, row, "set"), name = Text(table, row, "contestant");
    const Trials trials = Of(name, set);
    const std::vector<double> medians = ByProblem(trials, [](const Trials& problem) {
      std::vector<double> times;
      for (const Trial& one : problem) {
        if (std::isfinite(one.time_s)) times.push_back(one.time_s);
      }
      return times.empty() ? std::nan("") : QuantileOf(times, 0.5);
    });
    std::vector<double> penalised;
    for (const Trial& one : trials) penalised.push_back(std::min(one.time_s, 10 * kLimit));
    EXPECT_EQ(Value(table, row, "problems_solved"), medians.size());
    ExpectNear(1e3 * QuantileOf(medians, 0.5), Value(table, row, "median_ms"), name);
    ExpectInterval(OrderInterval(medians), IntervalOf(table, row, "median_ms"), 1e3, name);
    ExpectNear(1e3 * MeanOf(medians), Value(table, row, "mean_ms"), name);
    ExpectNear(1e3 * QuantileOf(medians, 0.25), Value(table, row, "lower_quartile_ms"), name);
    ExpectNear(1e3 * QuantileOf(medians, 0.75), Value(table, row, "upper_quartile_ms"), name);
    ExpectNear(1e3 * QuantileOf(medians, 0.95), Value(table, row, "percentile_95_ms"), name);
    ExpectNear(1e3 * MeanOf(penalised), Value(table, row, "penalised_mean_ms"), name);
  }
}

TEST_F(NumbersTest, Pairs) {
  const Table table = PairTable(pairs_);
  ASSERT_EQ(table.rows.size(), 9u);  // three pairs of two sets, and of both
  std::map<std::string, std::vector<double>> p_values;
  for (const auto& row : table.rows) {
    const std::string set = Text(table, row, "set"), a = Text(table, row, "first"),
                      b = Text(table, row, "second");
    const std::string what = fmt::format("{} {} {}", set, a, b);
    const std::vector<double> first = ProblemTimes(Of(a, set)), second = ProblemTimes(Of(b, set));
    int faster = 0, slower = 0;
    std::vector<double> differences, logs;
    for (std::size_t i = 0; i < first.size(); ++i) {
      faster += first[i] < second[i];
      slower += first[i] > second[i];
      const double difference =
          first[i] == second[i] ? 0 : std::log(first[i]) - std::log(second[i]);
      differences.push_back(difference);
      if (std::isfinite(first[i]) && std::isfinite(second[i])) logs.push_back(difference);
    }
    EXPECT_EQ(Value(table, row, "problems"), first.size()) << what;
    EXPECT_EQ(Value(table, row, "faster"), faster) << what;
    EXPECT_EQ(Value(table, row, "slower"), slower) << what;
    EXPECT_EQ(Value(table, row, "tied"), static_cast<int>(first.size()) - faster - slower) << what;
    EXPECT_EQ(Value(table, row, "problems_in_ratio"), logs.size()) << what;
    ExpectNear(std::exp(MeanOf(logs)), Value(table, row, "time_ratio"), what);
    const auto interval = IntervalOf(table, row, "time_ratio");
    ASSERT_EQ(interval.has_value(), logs.size() >= 6) << what;
    if (interval) {
      const Interval expected = StudentInterval(logs);
      EXPECT_NEAR(std::log(interval->lower), expected.lower, 1e-5) << what;
      EXPECT_NEAR(std::log(interval->upper), expected.upper, 1e-5) << what;
    }
    const std::vector<double> ranks = SignedRanks(differences);
    p_values[set].push_back(ProbabilityBySigns(ranks));
    EXPECT_NEAR(Value(table, row, "p"), p_values[set].back(), 1e-9) << what;
    // Among all problems those that tie have the lowest ranks, and no side.
    const auto num_problems = static_cast<double>(differences.size());
    const double num_tied = num_problems - static_cast<double>(ranks.size());
    double signed_sum = 0;
    for (const double rank : ranks) signed_sum += rank + std::copysign(num_tied, rank);
    EXPECT_NEAR(Value(table, row, "effect"), signed_sum / (num_problems * (num_problems + 1) / 2),
                1e-9)
        << what;
  }
  // Holm: the smallest as many times as there are tests, the next once less; none below one before.
  for (auto& [set, of_set] : p_values) {
    std::vector<double> sorted = of_set;
    std::sort(sorted.begin(), sorted.end());
    std::size_t i = 0;
    for (const auto& row : table.rows) {
      if (Text(table, row, "set") != set) continue;
      double adjusted = 0;
      for (std::size_t k = 0; k < sorted.size() && sorted[k] <= of_set[i]; ++k) {
        adjusted =
            std::max(adjusted, std::min(1.0, static_cast<double>(sorted.size() - k) * sorted[k]));
      }
      EXPECT_NEAR(Value(table, row, "p_holm"), adjusted, 1e-9) << set;
      ++i;
    }
  }
}

TEST_F(NumbersTest, Quality) {
  const Table table = QualityTable(compared_);
  ASSERT_EQ(table.rows.size(), 12u);  // sets, contestants, raw and simplified
  const std::string& leader = compared_.contestants().front().name;
  for (const auto& row : table.rows) {
    const std::string set = Text(table, row, "set"), name = Text(table, row, "contestant");
    const auto length =
        Text(table, row, "path") == "raw" ? &MadeRun::length : &MadeRun::length_simplified;
    const auto values = [&](const std::string& of) {
      return ByProblem(Of(of, set),
                       [&](const Trials& problem) { return MedianLength(problem, length); });
    };
    const std::vector<double> lengths = values(name);
    EXPECT_EQ(Value(table, row, "problems"), lengths.size());
    ExpectNear(QuantileOf(lengths, 0.25), Value(table, row, "lower_quartile"), name);
    ExpectNear(QuantileOf(lengths, 0.5), Value(table, row, "median"), name);
    ExpectNear(QuantileOf(lengths, 0.75), Value(table, row, "upper_quartile"), name);
    if (name == leader) continue;
    std::vector<double> logs;
    for (int problem = 1; problem <= kProblems; ++problem) {
      const auto of_problem = [&](const std::string& of) {
        Trials trials = Of(of, set);
        std::erase_if(trials, [&](const Trial& one) { return one.problem != problem; });
        return MedianLength(trials, length);
      };
      const double log = std::log(of_problem(name) / of_problem(leader));
      if (!std::isnan(log)) logs.push_back(log);
    }
    EXPECT_EQ(Text(table, row, "reference"), leader);
    EXPECT_EQ(Value(table, row, "problems_in_ratio"), logs.size());
    ExpectNear(std::exp(MeanOf(logs)), Value(table, row, "ratio_to_reference"), name);
    const Interval expected = StudentInterval(logs);
    const Interval interval = IntervalOf(table, row, "ratio_to_reference").value();
    EXPECT_NEAR(std::log(interval.lower), expected.lower, 1e-5) << name;
    EXPECT_NEAR(std::log(interval.upper), expected.upper, 1e-5) << name;
  }
}

TEST_F(NumbersTest, PhasesAndFailures) {
  const Table phases = PhaseTable(compared_);
  ASSERT_EQ(phases.rows.size(), 6u);
  for (const auto& row : phases.rows) {
    std::vector<double> times;
    for (const Trial& trial : Of(Text(phases, row, "contestant"), Text(phases, row, "set"))) {
      for (const MadeRun& run : trial.attempts) {
        if (run.status == PlanStatus::kSolved) times.push_back(run.time_s);
      }
    }
    EXPECT_EQ(Value(phases, row, "attempts"), times.size());
    const double mean_ms = 1e3 * MeanOf(times);
    ExpectNear(mean_ms / 8, Value(phases, row, "setup_ms"), "set-up");
    ExpectNear(mean_ms / 2, Value(phases, row, "collision_ms"), "collision");
    ExpectNear(mean_ms / 4, Value(phases, row, "guidance_ms"), "guidance");
    ExpectNear(mean_ms / 8, Value(phases, row, "search_ms"), "search");
    ExpectNear(250, Value(phases, row, "simplification_ms"), "simplification");
  }

  std::map<std::string, int> expected, found;
  for (const std::string& name : kNames) {
    for (const Trial& trial : Of(name, kAllSets)) {
      for (const MadeRun& run : trial.attempts) {
        if (run.status == PlanStatus::kSolved) continue;
        ++expected[fmt::format("{} {} {} {}", run.set, name, EnumName(run.status), run.reason)];
      }
    }
  }
  const Table failures = FailureTable(compared_);
  for (const auto& row : failures.rows) {
    found[fmt::format("{} {} {} {}", Text(failures, row, "set"), Text(failures, row, "contestant"),
                      Text(failures, row, "status"), Text(failures, row, "reason"))] +=
        static_cast<int>(Value(failures, row, "attempts"));
  }
  EXPECT_EQ(found, expected);
}

TEST_F(NumbersTest, Figures) {
  const Json json = FigureData(compared_, pairs_, AllTables(compared_, pairs_));
  ASSERT_EQ(json["sets"].size(), 3u);
  const auto name_of = [&](const Json& one) {
    return json["contestants"][one["contestant"].get<std::size_t>()]["name"].get<std::string>();
  };
  for (const Json& set_json : json["sets"]) {
    const std::string set = set_json["name"];
    const int num_problems = set == kAllSets ? 2 * kProblems : kProblems;
    for (const Json& curve : set_json["survival"]) {
      const Trials trials = Of(name_of(curve), set);
      std::set<double> times;
      for (const Trial& one : trials) {
        if (std::isfinite(one.time_s)) times.insert(std::round(1e9 * one.time_s));
      }
      ASSERT_EQ(curve["time"].size(), curve["share"].size());
      EXPECT_GE(curve["time"].size(), times.size());  // equal but for rounding
      for (std::size_t i = 0; i < curve["time"].size(); ++i) {
        const double by_s = curve["time"][i].get<double>() / 1e3;
        const auto solved = std::count_if(trials.begin(), trials.end(), [&](const Trial& one) {
          return one.time_s <= by_s * (1 + 1e-5);
        });
        // Of times equal but for rounding the last counts all.
        if (i + 1 < curve["time"].size() && curve["time"][i + 1] == curve["time"][i]) continue;
        const double share = static_cast<double>(solved) / static_cast<double>(trials.size());
        ExpectNear(share, curve["share"][i], set);
        const Interval interval = ScoreInterval(share, num_problems);
        EXPECT_NEAR(curve["lower"][i], interval.lower, 1e-5);
        EXPECT_NEAR(curve["upper"][i], interval.upper, 1e-5);
      }
    }
    std::map<std::string, std::vector<double>> times;
    std::vector<double> best(static_cast<std::size_t>(num_problems), kNever);
    for (const std::string& name : kNames) {
      times[name] = ProblemTimes(Of(name, set));
      for (std::size_t i = 0; i < best.size(); ++i) best[i] = std::min(best[i], times[name][i]);
    }
    for (const Json& curve : set_json["profile"]) {
      const std::vector<double>& own = times[name_of(curve)];
      for (std::size_t k = 0; k < curve["ratio"].size(); ++k) {
        if (k + 1 < curve["ratio"].size() && curve["ratio"][k + 1] == curve["ratio"][k]) continue;
        int within = 0;
        for (std::size_t i = 0; i < best.size(); ++i) {
          within += std::isfinite(own[i]) &&
                    own[i] / best[i] <= curve["ratio"][k].get<double>() * (1 + 1e-5);
        }
        ExpectNear(within / static_cast<double>(best.size()), curve["share"][k], set);
      }
    }
    if (set_json["all"]) continue;
    for (const Json& one : set_json["problem_times"]) {
      const std::vector<double>& own = times[name_of(one)];
      ASSERT_EQ(one["time"].size(), own.size());
      for (std::size_t i = 0; i < own.size(); ++i) {
        if (std::isfinite(own[i])) ExpectNear(1e3 * own[i], one["time"][i], set);
        EXPECT_EQ(one["time"][i].is_null(), !std::isfinite(own[i]));
      }
    }
    for (const Json& one : set_json["times"]) {
      const Trials trials = Of(name_of(one), set);
      ASSERT_EQ(one["time"].size(), trials.size());
      for (std::size_t i = 0; i < trials.size(); ++i) {
        EXPECT_EQ(one["problem"][i], trials[i].problem);
        if (std::isfinite(trials[i].time_s))
          ExpectNear(1e3 * trials[i].time_s, one["time"][i], set);
        EXPECT_EQ(one["time"][i].is_null(), !std::isfinite(trials[i].time_s));
      }
    }
  }
}

/// What a figure and a table tell of the same thing is the same.
TEST_F(NumbersTest, FiguresAgreeWithTables) {
  const Json json = FigureData(compared_, pairs_, AllTables(compared_, pairs_));
  const Table success = SuccessTable(compared_), times = TimeTable(compared_),
              quality = QualityTable(compared_), phases = PhaseTable(compared_);
  const auto row_of = [&](const Table& table, const Json& set, const Json& one,
                          const std::string& path = "") {
    for (const auto& row : table.rows) {
      if (Text(table, row, "set") == set["name"] &&
          Text(table, row, "contestant") ==
              json["contestants"][one["contestant"].get<std::size_t>()]["name"] &&
          (path.empty() || Text(table, row, "path") == path)) {
        return row;
      }
    }
    throw std::out_of_range("no such row");
  };
  for (const Json& set : json["sets"]) {
    if (set["all"]) continue;
    for (const Json& one : set["success"]) {
      const auto row = row_of(success, set, one);
      const Interval interval = IntervalOf(success, row, "confirmed_percent").value();
      ExpectNear(Value(success, row, "confirmed_percent") / 100, one["share"], "share");
      ExpectNear(interval.lower / 100, one["lower"], "lower");
      ExpectNear(interval.upper / 100, one["upper"], "upper");
      ExpectNear(Value(success, row, "claimed") / Value(success, row, "runs"), one["claimed_share"],
                 "claimed");
    }
    for (const Json& one : set["times"]) {
      const auto row = row_of(times, set, one);
      ExpectNear(Value(times, row, "median_ms"), one["median"], "median");
      const auto interval = IntervalOf(times, row, "median_ms");
      ASSERT_EQ(interval.has_value(), !one["lower"].is_null());
      if (interval) ExpectNear(interval->lower, one["lower"], "lower");
      if (interval) ExpectNear(interval->upper, one["upper"], "upper");
      EXPECT_EQ(one["limit"], 1e3 * kLimit);
    }
    for (const Json& measure : set["quality"]) {
      for (const char* path : {"raw", "simplified"}) {
        for (const Json& one : measure[path]) {
          const auto row = row_of(quality, set, one, path);
          ExpectNear(Value(quality, row, "lower_quartile"), one["lower"], path);
          ExpectNear(Value(quality, row, "median"), one["median"], path);
          ExpectNear(Value(quality, row, "upper_quartile"), one["upper"], path);
          EXPECT_EQ(Value(quality, row, "problems"), one["problems"]);
        }
      }
    }
    for (const Json& one : set["phases"]) {
      const auto row = row_of(phases, set, one);
      double total = 0;
      for (const char* phase : {"setup_ms", "collision_ms", "guidance_ms", "search_ms"}) {
        total += Value(phases, row, phase);
      }
      ExpectNear(total, one["total"], "total");
      ExpectNear(Value(phases, row, "collision_ms") / total, one["shares"][1], "share");
    }
  }
}

}  // namespace
}  // namespace planbench
