#include "logger/run_columns.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "logger/utc_time.h"
#include "planning/told_edges.h"

namespace planbench {
namespace {

using Record = RunRecordMessage;

constexpr std::monostate kNull;

SqliteValue Text(const std::string& text) {
  if (text.empty()) return kNull;
  return text;
}

SqliteValue Int(std::int64_t value) { return value; }

SqliteValue Bool(bool value) { return static_cast<std::int64_t>(value); }

/// Infinite values (a clearance from nothing) are NULL, as in OMPL's databases.
SqliteValue Real(double value) {
  if (!std::isfinite(value)) return kNull;
  return value;
}

/// For fields whose 0 means "none".
SqliteValue RealUnlessZero(double value) { return value == 0 ? SqliteValue(kNull) : Real(value); }

using Check = PathCheckReplyMessage Record::*;
using Verdict = std::optional<PathVerdict> PathCheckReplyMessage::*;

/// Of the planner's answer: NULL if none came, so that a run without an answer does not look like
/// one that took no time.
RunColumn OfAnswer(std::string name, const char* type,
                   std::function<SqliteValue(const PlanResult&)> get) {
  return {std::move(name), type, [get = std::move(get)](const Record& r) {
            const bool answered = r.status != PlanStatus::kNoAnswer && !r.result.request_id.empty();
            return answered ? get(r.result.result) : SqliteValue(kNull);
          }};
}

RunColumn Time(std::string name, double PlanResult::*time) {
  return OfAnswer(std::move(name), "REAL", [time](const PlanResult& p) { return Real(p.*time); });
}

/// A part of the total time.
RunColumn Phase(std::string name, double PhaseTimes::*phase) {
  return OfAnswer(std::move(name), "REAL", [phase](const PlanResult& p) {
    return p.phases.AreTold() ? Real(p.phases.*phase) : SqliteValue(kNull);
  });
}

/// A number of which 0 means that there is none.
RunColumn Quantity(std::string name, double PlanResult::*value) {
  return OfAnswer(std::move(name), "REAL",
                  [value](const PlanResult& p) { return RealUnlessZero(p.*value); });
}

SqliteValue CounterValue(const PlanResult& result, const char* name) {
  const auto found = result.counters.find(name);
  if (found == result.counters.end()) return kNull;
  // INTEGER columns hold exact counts; what is none stays what it is.
  constexpr double kExact = 9007199254740992.0;  // 2^53
  const double value = found->second;
  if (std::abs(value) <= kExact && std::trunc(value) == value) {
    return static_cast<std::int64_t>(value);
  }
  return Real(value);
}

RunColumn Counter(const char* name, const char* type = "INTEGER") {
  return OfAnswer(name, type, [name](const PlanResult& p) { return CounterValue(p, name); });
}

RunColumn NumWaypoints(std::string name, Path PlanResult::*path) {
  return {std::move(name), "INTEGER", [path](const Record& r) {
            const auto count = static_cast<std::int64_t>((r.result.result.*path).size());
            return count == 0 ? SqliteValue(kNull) : Int(count);
          }};
}

RunColumn Valid(std::string name, Check check, Verdict verdict) {
  return {std::move(name), "BOOLEAN", [=](const Record& r) {
            const auto& found = r.*check.*verdict;
            return found ? Bool(found->valid) : SqliteValue(kNull);
          }};
}

/// Why a path is not valid, or could not be judged.
RunColumn Reason(std::string name, Check check, Verdict verdict) {
  return {std::move(name), "TEXT", [=](const Record& r) {
            const auto& found = r.*check.*verdict;
            if (found) return Text(found->reason);
            const bool not_judged = verdict == &PathCheckReplyMessage::verdict && !(r.*check).ok;
            return not_judged ? Text((r.*check).message) : SqliteValue(kNull);
          }};
}

/// Of the contact that makes a path invalid.
RunColumn ContactDepth(std::string name, Check check, Verdict verdict) {
  return {std::move(name), "REAL", [=](const Record& r) {
            const auto& found = r.*check.*verdict;
            return found && found->contact ? Real(found->contact->depth_m) : SqliteValue(kNull);
          }};
}

RunColumn Measure(std::string name, Check check, const char* measure) {
  return {std::move(name), "REAL", [=](const Record& r) {
            const auto& verdict = (r.*check).verdict;
            if (!verdict) return SqliteValue(kNull);
            const auto value = FindMeasure(verdict->measures, measure);
            return value ? Real(*value) : SqliteValue(kNull);
          }};
}

std::vector<RunColumn> MakeRunColumns() {
  constexpr Check kRaw = &Record::path_check;
  constexpr Check kSimplified = &Record::simplified_check;
  constexpr Verdict kOwn = &PathCheckReplyMessage::verdict;
  constexpr Verdict kMesh = &PathCheckReplyMessage::mesh_verdict;
  std::vector<RunColumn> columns;
  const auto add = [&](std::vector<RunColumn> more) {
    columns.insert(columns.end(), std::make_move_iterator(more.begin()),
                   std::make_move_iterator(more.end()));
  };
  add({
      Time("time", &PlanResult::planning_time_s),
      Quantity("memory", &PlanResult::peak_memory_mb),
      {"solved", "BOOLEAN", [](const Record& r) { return Bool(r.status == PlanStatus::kSolved); }},
      {"status", "ENUM", [](const Record& r) { return Int(static_cast<int>(r.status)); }},
      {"message", "TEXT", [](const Record& r) { return Text(r.message); }},
      {"claimed", "BOOLEAN", [](const Record& r) { return Bool(r.result.result.Solves()); }},

      {"direction", "TEXT",
       [](const Record& r) { return Text(std::string(EnumName(r.request.direction))); }},
      {"problem_set", "TEXT", [](const Record& r) { return Text(r.problem_set); }},
      {"problem_index", "INTEGER", [](const Record& r) { return Int(r.problem_index); }},
      {"trial", "INTEGER", [](const Record& r) { return Int(r.trial); }},
      // Unsigned 64 bit, which INTEGER cannot hold.
      {"seed", "TEXT", [](const Record& r) { return Text(std::to_string(r.request.seed)); }},
      {"request_id", "TEXT", [](const Record& r) { return Text(r.request_id); }},
      {"run_id", "TEXT", [](const Record& r) { return Text(r.run_id); }},
      {"scene_id", "TEXT", [](const Record& r) { return Text(r.request.scene_id); }},
      {"start_time", "TEXT", [](const Record& r) { return Text(IsoTime(r.start_utime)); }},
      {"collision_model", "TEXT",
       [](const Record& r) { return Text(std::string(EnumName(r.request.collision_model))); }},
      {"edge_resolution", "REAL",
       [](const Record& r) {
         const auto step_m =
             SamplingOf(r.request.edge_check, r.request.edge_resolution_m, r.settings).resolution_m;
         return step_m ? Real(*step_m) : SqliteValue(kNull);
       }},
      {"edge_check", "TEXT",
       [](const Record& r) {
         const auto& method = r.request.edge_check;
         return Text(method ? std::string(EnumName(*method)) : "");
       }},
      {"time_limit", "REAL", [](const Record& r) { return Real(r.request.time_limit_s); }},
      {"anytime", "BOOLEAN", [](const Record& r) { return Bool(r.request.anytime); }},

      {"roundtrip_time", "REAL",
       [](const Record& r) { return RealUnlessZero(r.roundtrip_time_s); }},
      Time("total_time", &PlanResult::total_time_s),
      Phase("setup_time", &PhaseTimes::setup_s),
      Phase("collision_time", &PhaseTimes::collision_s),
      Phase("guidance_time", &PhaseTimes::guidance_s),
      Phase("search_time", &PhaseTimes::search_s),
      OfAnswer("simplification_time", "REAL",
               [](const PlanResult& p) { return RealUnlessZero(p.phases.simplification_s); }),
  });
  for (const PathMeasure& measure : PathMeasures()) {
    add({Measure(measure.name, kRaw, measure.name),
         Measure(std::string(measure.name) + "_simplified", kSimplified, measure.name)});
  }
  add({
      NumWaypoints("num_waypoints", &PlanResult::path),
      NumWaypoints("num_waypoints_simplified", &PlanResult::simplified_path),

      Valid("referee_valid", kRaw, kOwn),
      Reason("referee_reason", kRaw, kOwn),
      {"referee_engine", "TEXT", [](const Record& r) { return Text(r.path_check.engine); }},
      {"referee_step", "REAL", [](const Record& r) { return RealUnlessZero(r.path_check.step_m); }},
      Valid("simplified_valid", kSimplified, kOwn),
      Reason("simplified_reason", kSimplified, kOwn),
      Valid("mesh_valid", kRaw, kMesh),
      Reason("mesh_reason", kRaw, kMesh),
      ContactDepth("mesh_depth", kRaw, kMesh),
      Valid("mesh_valid_simplified", kSimplified, kMesh),
      Reason("mesh_reason_simplified", kSimplified, kMesh),
      ContactDepth("mesh_depth_simplified", kSimplified, kMesh),

      Quantity("epsilon", &PlanResult::epsilon),
      OfAnswer("cost", "REAL",
               [](const PlanResult& p) {
                 return TellsCost(p.cost, p.epsilon) ? Real(p.cost) : SqliteValue(kNull);
               }),
      Counter("edges_checked"),
      Counter("configurations_checked"),
      Counter("iterations"),
      Counter("expansions"),
      Counter("states"),

      Counter("load_before", "REAL"),
      Counter("waiting_time", "REAL"),
      Counter("steal_time", "REAL"),
      Counter("disturbed", "BOOLEAN"),
      // Of a repeat that no answer came to, too: which record stands hangs on it (asked_runs.h).
      {"repeats", "INTEGER",
       [](const Record& r) { return CounterValue(r.result.result, "repeats"); }},
  });
  // OMPL's names of quantities that have names used throughout here.
  const auto ompl = [&](std::string name, const std::string& own, auto convert) {
    const auto column = std::find_if(columns.begin(), columns.end(),
                                     [&](const RunColumn& one) { return one.name == own; });
    RunColumn copy = *column;
    copy.name = std::move(name);
    copy.value = [value = column->value, convert](const Record& r) { return convert(value(r)); };
    columns.push_back(std::move(copy));
  };
  const auto same = [](SqliteValue value) { return value; };
  const auto one_less = [](SqliteValue value) {
    if (auto* count = std::get_if<std::int64_t>(&value)) --*count;
    return value;
  };
  for (const char* measure : {"length", "clearance", "smoothness"}) {
    const std::string own = std::string(measure) == "length" ? "path_length" : measure;
    ompl(std::string("solution_") + measure, own, same);
    ompl(std::string("simplified_solution_") + measure, own + "_simplified", same);
  }
  ompl("solution_segments", "num_waypoints", one_less);
  ompl("simplified_solution_segments", "num_waypoints_simplified", one_less);
  ompl("correct_solution", "referee_valid", same);
  ompl("simplified_correct_solution", "simplified_valid", same);
  return columns;
}

}  // namespace

const std::vector<RunColumn>& RunColumns() {
  static const std::vector<RunColumn> columns = MakeRunColumns();
  return columns;
}

}  // namespace planbench
