#include "benchmark_driver/tables.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "benchmark_driver/published_study.h"
#include "results/statistics.h"

namespace planbench {
namespace {

bool Solved(const RunRecordMessage* record) {
  return record != nullptr && record->status == PlanStatus::kSolved;
}

bool HasStatus(const RunRecordMessage* record, std::initializer_list<PlanStatus> statuses) {
  if (record == nullptr) return false;
  for (const PlanStatus status : statuses) {
    if (record->status == status) return true;
  }
  return false;
}

/// Time an attempt took; of one without an answer, the time it was waited for.
double AttemptTime(const RunRecordMessage& record) {
  return record.status == PlanStatus::kNoAnswer ? record.roundtrip_time_s
                                                : record.result.result.planning_time_s;
}

struct Attempts {
  const RunRecordMessage* forward = nullptr;
  const RunRecordMessage* backward = nullptr;
};

/// One row group: a problem set and a planner.
struct Group {
  std::map<std::pair<int, int>, Attempts> attempts;  // by (problem, trial)
  std::vector<const RunRecordMessage*> records;
  bool has_forward = false;
  bool has_backward = false;
};

using GroupKey = std::pair<std::string, std::string>;  // set, planner
using Groups = std::map<GroupKey, Group>;

/// The study's figures that go below a group's rows: none but below the last group of a set, where
/// those of each algorithm stand that the session ran on it.
std::vector<const PublishedFigures*> PublishedBelow(const Groups& groups,
                                                    Groups::const_iterator group) {
  const std::string& set = group->first.first;
  const auto next = std::next(group);
  if (next != groups.end() && next->first.first == set) return {};
  std::set<std::string> algorithms;
  for (auto one = groups.lower_bound({set, ""}); one != next; ++one) {
    algorithms.insert(one->second.records.front()->algorithm);
  }
  std::vector<const PublishedFigures*> rows;
  for (const std::string& algorithm : algorithms) {
    if (const PublishedFigures* row = FindPublished(set, algorithm)) rows.push_back(row);
  }
  return rows;
}

std::string PublishedName(const PublishedFigures& row) {
  return "published " + std::string(row.algorithm);
}

/// Below a table that has such rows.
constexpr char kPublishedNote[] =
    "  published: arXiv 2406.09623, Xeon E5-6248R, 60 s a request, ARA* backward where forward had "
    "failed, RRT-Connect\n  once. Problems that planbench generates follow the study's recipe and "
    "are not the same files; --problems takes the\n  originals.";

std::string Count(bool present, int count) { return present ? fmt::format("{}", count) : "-"; }

std::string Milliseconds(double seconds) {
  if (std::isnan(seconds)) return "-";
  const double ms = seconds * 1e3;
  return ms < 10     ? fmt::format("{:.3f}", ms)
         : ms < 1000 ? fmt::format("{:.1f}", ms)
                     : fmt::format("{:.0f}", ms);
}

std::string Number(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

/// Columns aligned: the first `num_left` to the left, the others to the right.
class TextTable {
 public:
  TextTable(std::string title, std::vector<std::string> header, int num_left)
      : title_(std::move(title)), num_left_(num_left) {
    rows_.push_back(std::move(header));
  }
  void Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  std::string Format(const std::string& notes) const {
    std::vector<std::size_t> widths(rows_[0].size(), 0);
    for (const auto& row : rows_) {
      for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    }
    std::string text = title_ + "\n";
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      std::string line = " ";
      for (std::size_t c = 0; c < rows_[r].size(); ++c) {
        line += static_cast<int>(c) < num_left_ ? fmt::format(" {:<{}} ", rows_[r][c], widths[c])
                                                : fmt::format(" {:>{}} ", rows_[r][c], widths[c]);
      }
      line.erase(line.find_last_not_of(' ') + 1);
      text += line + "\n";
      if (r == 0) {
        std::size_t total = 1;
        for (const std::size_t width : widths) total += width + 2;
        text += "  " + std::string(total - 3, '-') + "\n";
      }
    }
    return text + notes + "\n";
  }

 private:
  std::string title_;
  int num_left_;
  std::vector<std::vector<std::string>> rows_;
};

std::string SuccessTable(const Groups& groups) {
  TextTable table("Success",
                  {"set", "planner", "problems", "forward", "backward", "failure", "unsolvable",
                   "other", "backward alone"},
                  2);
  std::string published_note;
  for (auto at = groups.begin(); at != groups.end(); ++at) {
    const auto& [key, group] = *at;
    int forward = 0, backward = 0, failure = 0, unsolvable = 0, other = 0, alone = 0;
    for (const auto& [problem, attempts] : group.attempts) {
      const ProblemOutcome outcome = FoldAttempts(attempts.forward, attempts.backward);
      using Kind = ProblemOutcome::Kind;
      forward += outcome.kind == Kind::kForward;
      backward += outcome.kind == Kind::kBackward;
      failure += outcome.kind == Kind::kFailure;
      unsolvable += outcome.kind == Kind::kUnsolvable;
      other += outcome.kind == Kind::kOther;
      alone += outcome.solved_backward;
    }
    table.Add({key.first, key.second, fmt::format("{}", group.attempts.size()),
               Count(group.has_forward, forward), Count(group.has_backward, backward),
               fmt::format("{}", failure), fmt::format("{}", unsolvable), fmt::format("{}", other),
               Count(group.has_backward, alone)});
    for (const PublishedFigures* row : PublishedBelow(groups, at)) {
      const auto known = [](std::optional<int> count) {
        return Count(count.has_value(), count.value_or(0));
      };
      table.Add({key.first, PublishedName(*row), fmt::format("{}", row->num_problems),
                 fmt::format("{}", row->solved_forward), known(row->solved_backward),
                 fmt::format("{}", row->failed), known(row->unsolvable), "-", "-"});
      published_note = std::string(kPublishedNote) + "\n";
    }
  }
  return table.Format(
      "  forward: solved start to goal. backward: solved goal to start where forward was not. "
      "failure: "
      "neither, by time,\n  memory or an exhausted search. unsolvable: start or goal invalid. "
      "other: path "
      "rejected by the referee, no answer,\n  request refused, cancelled. backward alone: all "
      "solved goal to "
      "start.\n" +
      published_note);
}

std::string TimeTable(const Groups& groups) {
  TextTable table(
      "Planning time of the solved, ms",
      {"set", "planner", "direction", "solved", "median", "mean", "25 %", "75 %", "95 %"}, 3);
  std::string published_note;
  for (auto at = groups.begin(); at != groups.end(); ++at) {
    const auto& [key, group] = *at;
    std::vector<double> forward, backward, either;
    for (const auto& [problem, attempts] : group.attempts) {
      const ProblemOutcome outcome = FoldAttempts(attempts.forward, attempts.backward);
      if (outcome.solved_forward) forward.push_back(outcome.forward_time_s);
      if (outcome.solved_backward) backward.push_back(outcome.backward_time_s);
      if (outcome.solved_forward || outcome.solved_backward) {
        either.push_back(outcome.either_time_s);
      }
    }
    const auto add = [&](const char* direction, std::vector<double> times) {
      const Summary s = Summarize(std::move(times));
      table.Add({key.first, key.second, direction, fmt::format("{}", s.count),
                 Milliseconds(s.median), Milliseconds(s.mean), Milliseconds(s.lower_quartile),
                 Milliseconds(s.upper_quartile), Milliseconds(s.percentile_95)});
    };
    if (group.has_forward) add("forward", std::move(forward));
    if (group.has_backward) add("backward", std::move(backward));
    if (group.has_forward && group.has_backward) add("either", std::move(either));
    for (const PublishedFigures* row : PublishedBelow(groups, at)) {
      const std::string median = row->median_from_s == row->median_to_s
                                     ? fmt::format("~{}", Milliseconds(row->median_from_s))
                                     : fmt::format("{}-{}", Milliseconds(row->median_from_s),
                                                   Milliseconds(row->median_to_s));
      const bool both = row->solved_backward.has_value();
      table.Add({key.first, PublishedName(*row), both ? "solving one" : "forward",
                 fmt::format("{}", row->solved_forward + row->solved_backward.value_or(0)), median,
                 "-", "-", "-", "-"});
      published_note = std::string(kPublishedNote) +
                       " Its medians are read off a plot. solving one: time of the attempt that\n"
                       "  succeeded, the failed one before it left out.\n";
    }
  }
  return table.Format(
      "  From request and scene at hand to the first solution; simplification and the bus "
      "excluded. either: "
      "forward, then\n  backward if forward failed, with the time of the failed attempt.\n" +
      published_note);
}

/// A column of the table of effort and quality: a median over solved runs.
struct EffortColumn {
  std::string heading;
  std::function<std::optional<double>(const RunRecordMessage&)> read;  ///< Nothing: left out.
  std::function<std::string(double)> format;
};

std::vector<EffortColumn> EffortColumns() {
  using Record = RunRecordMessage;
  const auto decimals = [](int count) {
    return [count](double value) { return Number(value, count); };
  };
  const auto counter = [](const char* name) {
    return [name](const Record& record) {
      const auto& counters = record.result.result.counters;
      const auto found = counters.find(name);
      return found == counters.end() ? 0 : found->second;
    };
  };
  std::vector<EffortColumn> columns = {
      {"bus ms",
       [](const Record& record) {
         const PlanResult& result = record.result.result;
         return record.roundtrip_time_s - result.total_time_s - result.phases.simplification_s;
       },
       Milliseconds},
      {"simplify ms",
       [](const Record& record) { return record.result.result.phases.simplification_s; },
       Milliseconds},
      {"checking %",
       [](const Record& record) -> std::optional<double> {
         const PlanResult& result = record.result.result;
         if (result.total_time_s == 0) return std::nullopt;
         return 100 * result.phases.collision_s / result.total_time_s;
       },
       decimals(0)},
      {"edges", counter("edges_checked"), decimals(0)},
      {"configurations", counter("configurations_checked"), decimals(0)},
  };
  for (const PathMeasure& measure : PathMeasures()) {
    const auto add = [&](const char* heading, PathCheckReplyMessage Record::*check) {
      if (heading == nullptr) return;
      const auto read = [&measure, check](const Record& record) -> std::optional<double> {
        const auto& verdict = (record.*check).verdict;
        auto value = verdict ? FindMeasure(verdict->measures, measure.name) : std::nullopt;
        if (value) *value *= measure.column.scale;
        return value;
      };
      columns.push_back({heading, read, decimals(measure.column.decimals)});
    };
    add(measure.column.heading, &Record::path_check);
    add(measure.column.heading_simplified, &Record::simplified_check);
  }
  return columns;
}

std::string EffortTable(const Groups& groups) {
  const std::vector<EffortColumn> columns = EffortColumns();
  std::vector<std::string> header = {"set", "planner"};
  for (const EffortColumn& column : columns) header.push_back(column.heading);
  TextTable table("Effort and quality over the solved runs, medians", std::move(header), 2);
  for (const auto& [key, group] : groups) {
    std::vector<std::string> row = {key.first, key.second};
    for (const EffortColumn& column : columns) {
      std::vector<double> values;
      for (const RunRecordMessage* record : group.records) {
        if (!Solved(record)) continue;
        if (const auto value = column.read(*record)) values.push_back(*value);
      }
      row.push_back(column.format(Summarize(std::move(values)).median));
    }
    table.Add(std::move(row));
  }
  return table.Format(
      "  bus: driver's round trip less the planner's own time. checking: share of collision "
      "checking in the "
      "search. length:\n  joint space, L2, rad and m. clearance: least along the raw path.\n");
}

std::string MeshTable(const Groups& groups) {
  TextTable table("Paths judged with the robot's meshes",
                  {"set", "planner", "solved", "mesh-valid", "simplified", "mesh-valid"}, 2);
  bool any = false;
  for (const auto& [key, group] : groups) {
    int judged = 0, valid = 0, simplified_judged = 0, simplified_valid = 0;
    for (const RunRecordMessage* record : group.records) {
      if (!Solved(record)) continue;
      if (const auto& verdict = record->path_check.mesh_verdict) {
        ++judged;
        valid += verdict->valid;
      }
      if (const auto& verdict = record->simplified_check.mesh_verdict) {
        ++simplified_judged;
        simplified_valid += verdict->valid;
      }
    }
    any = any || judged > 0;
    table.Add({key.first, key.second, fmt::format("{}", judged), fmt::format("{}", valid),
               fmt::format("{}", simplified_judged), fmt::format("{}", simplified_valid)});
  }
  if (!any) return "";
  return table.Format(
      "  Runs solved with the planners' own collision model, by what the mesh robot says of "
      "them.\n");
}

}  // namespace

ProblemOutcome FoldAttempts(const RunRecordMessage* forward, const RunRecordMessage* backward) {
  using Kind = ProblemOutcome::Kind;
  ProblemOutcome outcome;
  outcome.solved_forward = Solved(forward);
  outcome.solved_backward = Solved(backward);
  if (forward != nullptr) outcome.forward_time_s = AttemptTime(*forward);
  if (backward != nullptr) outcome.backward_time_s = AttemptTime(*backward);
  const auto either_has = [&](std::initializer_list<PlanStatus> statuses) {
    return HasStatus(forward, statuses) || HasStatus(backward, statuses);
  };
  if (outcome.solved_forward) {
    outcome.kind = Kind::kForward;
    outcome.either_time_s = outcome.forward_time_s;
  } else if (outcome.solved_backward) {
    outcome.kind = Kind::kBackward;
    outcome.either_time_s = outcome.forward_time_s + outcome.backward_time_s;
  } else if (either_has({PlanStatus::kStartInvalid, PlanStatus::kGoalInvalid})) {
    outcome.kind = Kind::kUnsolvable;
  } else if (either_has({PlanStatus::kNoAnswer, PlanStatus::kInvalidPath,
                         PlanStatus::kInvalidRequest, PlanStatus::kCancelled})) {
    outcome.kind = Kind::kOther;
  } else {
    outcome.kind = Kind::kFailure;
  }
  return outcome;
}

std::string FormatTables(const std::vector<RunRecordMessage>& records) {
  Groups groups;
  for (const RunRecordMessage& record : records) {
    Group& group = groups[{record.problem_set, record.planner}];
    group.records.push_back(&record);
    Attempts& attempts = group.attempts[{record.problem_index, record.trial}];
    if (record.request.direction == Direction::kForward) {
      attempts.forward = &record;
      group.has_forward = true;
    } else {
      attempts.backward = &record;
      group.has_backward = true;
    }
  }
  if (groups.empty()) return "No runs.\n";
  return SuccessTable(groups) + TimeTable(groups) + EffortTable(groups) + MeshTable(groups);
}

}  // namespace planbench
