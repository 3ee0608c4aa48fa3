#include "benchmark_driver/effort_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "benchmark_driver/text_table.h"
#include "common/lookup.h"
#include "planning/path_measures.h"
#include "results/outcomes.h"
#include "results/quality.h"
#include "results/reason_count.h"

namespace planbench {
namespace {

/// A column of the tables of effort and path quality: a median over problems.
struct EffortColumn {
  std::string heading;
  std::function<std::optional<double>(const RunRecordMessage&)> read;  ///< Nothing: left out.
  std::function<std::string(double)> format;
  bool is_quality = false;
};

std::vector<EffortColumn> MakeEffortColumns() {
  using Record = RunRecordMessage;
  const auto decimals = [](int count) {
    return [count](double value) { return Number(value, count); };
  };
  const auto counter = [](const char* name) {
    return [name](const Record& record) { return Lookup(record.result.result.counters, name); };
  };
  std::vector<EffortColumn> columns = {
      {"bus ms",
       [](const Record& record) {
         const PlanResult& result = record.result.result;
         // What two machines' clocks differ by is no time on the bus.
         return std::max(
             0.0, record.roundtrip_time_s - result.total_time_s - result.phases.simplification_s);
       },
       Milliseconds},
      {"simplify ms",
       [](const Record& record) { return record.result.result.phases.Simplification(); },
       Milliseconds},
      {"checking %",
       [](const Record& record) -> std::optional<double> {
         const PlanResult& result = record.result.result;
         if (result.total_time_s == 0 || !result.phases.AreTold()) return std::nullopt;
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
        const bool counts =
            verdict && verdict->valid && !record.result.result.counters.contains(kOverrunTime);
        auto value = counts ? FindMeasure(verdict->measures, measure.name) : std::nullopt;
        if (value) *value *= measure.column.scale;
        return value;
      };
      columns.push_back({heading, read, decimals(measure.column.decimals), true});
    };
    add(measure.column.heading, &Record::path_check);
    add(measure.column.heading_simplified, &Record::simplified_check);
  }
  return columns;
}

const std::vector<EffortColumn>& EffortColumns() {
  static const std::vector<EffortColumn> columns = MakeEffortColumns();
  return columns;
}

/// Of the columns of path quality, or the others.
std::string MedianTable(const SessionResults& results, const std::string& title, bool is_quality,
                        const std::string& notes) {
  const std::vector<EffortColumn>& columns = EffortColumns();
  std::vector<std::string> header = {"contestant"};
  for (const EffortColumn& column : columns) {
    if (column.is_quality == is_quality) header.push_back(column.heading);
  }
  TextTable table(title, std::move(header), 1);
  for (const SetResults& set : results.sets()) {
    table.AddHeading(set.name);
    for (const ContestantResults& one : set.contestants) {
      const std::vector<const RunRow*> runs = ConfirmedRuns(one.runs);
      std::vector<std::string> row = {one.label()};
      for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i].is_quality != is_quality) continue;
        ValuesByProblem values;
        for (const RunRow* run : runs) {
          if (std::isnan(run->effort[i])) continue;
          values[run->problem_index].push_back(run->effort[i]);
        }
        row.push_back(columns[i].format(SummarizeByProblem(values).median));
      }
      table.Add(std::move(row));
    }
  }
  return table.Format(notes);
}

// What the mesh robot says of a number of paths.
struct MeshVerdicts {
  int judged = 0;
  int valid = 0;
  ReasonCount reasons;  // Of those that are not.

  void Add(std::optional<bool> verdict, const std::string& reason) {
    if (!verdict) return;
    ++judged;
    valid += *verdict ? 1 : 0;
    if (!*verdict) reasons.Add(reason);
  }
  void Add(const MeshVerdicts& others) {
    judged += others.judged;
    valid += others.valid;
  }
  double Share() const { return judged > 0 ? static_cast<double>(valid) / judged : 1; }
};

}  // namespace

std::vector<double> EffortValues(const RunRecordMessage& record) {
  std::vector<double> values;
  values.reserve(EffortColumns().size());
  for (const EffortColumn& column : EffortColumns()) {
    values.push_back(column.read(record).value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return values;
}

std::string EffortTables(const SessionResults& results) {
  return MedianTable(
             results, "Effort of confirmed runs, medians over problems", false,
             "A problem counts once, by the median of its runs; medians over different "
             "problems do not compare. A run confirmed in both directions counts by the "
             "attempt from start to goal. bus: the driver's round trip less the planner's own "
             "time. checking: share of collision checking in the search. edges, "
             "configurations: how many the planner checked, simplification aside. -: not "
             "told.\n\n") +
         MedianTable(results, "Path quality of confirmed runs, medians over problems", true,
                     "length: joint space, L2, rad and m, of the raw path; simplified: of the "
                     "simplified one, as each planner simplifies (alike those of planbench and "
                     "those built on its library alone). tip: travel of the tip link from sample "
                     "to sample of the "
                     "referee, on the raw path. clearance: least at these samples. -: not "
                     "measured.\n\n");
}

std::string MeshTable(const SessionResults& results, const std::string& referee_misfits) {
  TextTable table("Paths judged with the robot's meshes",
                  {"set", "contestant", "judged", "mesh-valid", "simplified", "mesh-valid"}, 2);
  MeshVerdicts raw_of_all;
  MeshVerdicts simplified_of_all;
  std::string notes =
      "Runs confirmed with the planners' own collision model, and simplified paths of such, that "
      "the mesh robot judged.\n";
  if (!referee_misfits.empty()) {
    notes += fmt::format("The mesh robot differs from the planners': {}.\n", referee_misfits);
  }
  for (const SetResults& set : results.sets()) {
    for (const ContestantResults& one : set.contestants) {
      MeshVerdicts raw;
      MeshVerdicts simplified;
      for (const RunRow* run : ConfirmedRuns(one.runs)) {
        raw.Add(run->mesh_valid, *run->mesh_reason);
        simplified.Add(run->mesh_valid_simple, "");
      }
      raw_of_all.Add(raw);
      simplified_of_all.Add(simplified);
      table.Add({set.name, one.label(), fmt::format("{}", raw.judged), fmt::format("{}", raw.valid),
                 fmt::format("{}", simplified.judged), fmt::format("{}", simplified.valid)});
      if (raw.valid == raw.judged) continue;
      notes += fmt::format("{}, {}: {} not mesh-valid, {}\n", set.name, one.label(),
                           raw.judged - raw.valid, raw.reasons.Summary());
    }
  }
  if (raw_of_all.judged == 0) return "";
  if (simplified_of_all.Share() < raw_of_all.Share()) {
    notes += fmt::format(
        "Simplified paths pass nearer to obstacles than the spheres tell: {:.1f} % of them are "
        "mesh-valid, {:.1f} % of the raw ones.\n",
        100 * simplified_of_all.Share(), 100 * raw_of_all.Share());
  }
  return table.Format(notes + "\n");
}

}  // namespace planbench
