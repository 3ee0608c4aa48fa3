#include "benchmark_driver/effort_table.h"

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "benchmark_driver/text_table.h"
#include "planning/path_measures.h"
#include "results/statistics.h"

namespace planbench {
namespace {

bool Confirmed(const RunRecordMessage& record) { return record.status == PlanStatus::kSolved; }

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

}  // namespace

std::string EffortTable(const SessionResults& results) {
  const std::vector<EffortColumn> columns = EffortColumns();
  std::vector<std::string> header = {"set", "contestant"};
  for (const EffortColumn& column : columns) header.push_back(column.heading);
  TextTable table("Effort and quality over the confirmed runs, medians", std::move(header), 2);
  for (const SetResults& set : results.sets()) {
    for (const ContestantResults& one : set.contestants) {
      std::vector<std::string> row = {set.name, one.contestant->name};
      for (const EffortColumn& column : columns) {
        std::vector<double> values;
        for (const RunRecordMessage* record : one.records) {
          if (!Confirmed(*record)) continue;
          if (const auto value = column.read(*record)) values.push_back(*value);
        }
        row.push_back(column.format(Summarize(std::move(values)).median));
      }
      table.Add(std::move(row));
    }
  }
  return table.Format(
      "bus: the driver's round trip less the planner's own time. checking: share of collision "
      "checking in the search. length: joint space, L2, rad and m. clearance: least along the raw "
      "path.\n\n");
}

std::string MeshTable(const SessionResults& results) {
  TextTable table("Paths judged with the robot's meshes",
                  {"set", "contestant", "confirmed", "mesh-valid", "simplified", "mesh-valid"}, 2);
  bool any = false;
  for (const SetResults& set : results.sets()) {
    for (const ContestantResults& one : set.contestants) {
      int judged = 0, valid = 0, simplified_judged = 0, simplified_valid = 0;
      for (const RunRecordMessage* record : one.records) {
        if (!Confirmed(*record)) continue;
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
      table.Add({set.name, one.contestant->name, fmt::format("{}", judged),
                 fmt::format("{}", valid), fmt::format("{}", simplified_judged),
                 fmt::format("{}", simplified_valid)});
    }
  }
  if (!any) return "";
  return table.Format(
      "Runs confirmed with the planners' own collision model, by what the mesh robot says of "
      "them.\n\n");
}

}  // namespace planbench
