#include "logger/run_columns.h"

#include <cmath>
#include <optional>

#include "logger/utc_time.h"

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

/// A field of the planner's answer: NULL if none came, so that a run without an answer does not
/// look like one that took no time.
template <typename Get>
SqliteValue OfAnswer(const Record& record, Get get) {
  const bool answered = record.status != PlanStatus::kNoAnswer && !record.result.request_id.empty();
  return answered ? SqliteValue(get(record.result.result)) : SqliteValue(kNull);
}

SqliteValue Time(const Record& record, double PhaseTimes::*phase) {
  return OfAnswer(record, [&](const PlanResult& result) { return Real(result.phases.*phase); });
}

SqliteValue Counter(const Record& record, const char* name) {
  return OfAnswer(record, [&](const PlanResult& result) -> SqliteValue {
    const auto found = result.counters.find(name);
    if (found == result.counters.end()) return kNull;
    // INTEGER columns hold exact counts; what is none stays what it is.
    constexpr double kExact = 9007199254740992.0;  // 2^53
    const double value = found->second;
    if (std::abs(value) <= kExact && std::trunc(value) == value) {
      return static_cast<std::int64_t>(value);
    }
    return Real(value);
  });
}

SqliteValue NumWaypoints(const Path& path) {
  return path.empty() ? SqliteValue(kNull) : Int(static_cast<std::int64_t>(path.size()));
}

SqliteValue Valid(const std::optional<PathVerdict>& verdict) {
  return verdict ? Bool(verdict->valid) : SqliteValue(kNull);
}

/// Why a path is not valid, or could not be judged.
SqliteValue Reason(const PathCheckReplyMessage& check, const std::optional<PathVerdict>& verdict) {
  if (verdict) return Text(verdict->reason);
  return check.ok ? SqliteValue(kNull) : Text(check.message);
}

SqliteValue Measure(const PathCheckReplyMessage& check, double PathVerdict::*measure) {
  return check.verdict ? Real(*check.verdict.*measure) : SqliteValue(kNull);
}

/// Clearances are only measured on valid paths and when asked for; both are 0 otherwise.
SqliteValue Clearance(const PathCheckReplyMessage& check, double PathVerdict::*measure) {
  const std::optional<PathVerdict>& verdict = check.verdict;
  if (!verdict || !verdict->valid) return kNull;
  if (verdict->clearance_min_m == 0 && verdict->clearance_mean_m == 0) return kNull;
  return Measure(check, measure);
}

std::vector<RunColumn> MakeRunColumns() {
  return {
      {"time", "REAL",
       [](const Record& r) {
         return OfAnswer(r, [](const PlanResult& p) { return Real(p.planning_time_s); });
       }},
      {"memory", "REAL",
       [](const Record& r) {
         return OfAnswer(r, [](const PlanResult& p) { return RealUnlessZero(p.peak_memory_mb); });
       }},
      {"solved", "BOOLEAN", [](const Record& r) { return Bool(r.status == PlanStatus::kSolved); }},
      {"status", "ENUM", [](const Record& r) { return Int(static_cast<int>(r.status)); }},
      {"message", "TEXT", [](const Record& r) { return Text(r.message); }},

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
       [](const Record& r) { return RealUnlessZero(r.request.edge_resolution_m); }},
      {"edge_check", "TEXT",
       [](const Record& r) {
         const auto& method = r.request.edge_check;
         return Text(method ? std::string(EnumName(*method)) : "");
       }},
      {"time_limit", "REAL", [](const Record& r) { return Real(r.request.time_limit_s); }},
      {"anytime", "BOOLEAN", [](const Record& r) { return Bool(r.request.anytime); }},

      {"roundtrip_time", "REAL",
       [](const Record& r) { return RealUnlessZero(r.roundtrip_time_s); }},
      {"total_time", "REAL",
       [](const Record& r) {
         return OfAnswer(r, [](const PlanResult& p) { return Real(p.total_time_s); });
       }},
      {"setup_time", "REAL", [](const Record& r) { return Time(r, &PhaseTimes::setup_s); }},
      {"collision_time", "REAL", [](const Record& r) { return Time(r, &PhaseTimes::collision_s); }},
      {"guidance_time", "REAL", [](const Record& r) { return Time(r, &PhaseTimes::guidance_s); }},
      {"search_time", "REAL", [](const Record& r) { return Time(r, &PhaseTimes::search_s); }},
      {"simplification_time", "REAL",
       [](const Record& r) { return Time(r, &PhaseTimes::simplification_s); }},

      {"path_length", "REAL",
       [](const Record& r) { return Measure(r.path_check, &PathVerdict::length); }},
      {"path_length_simplified", "REAL",
       [](const Record& r) { return Measure(r.simplified_check, &PathVerdict::length); }},
      {"tip_travel", "REAL",
       [](const Record& r) { return Measure(r.path_check, &PathVerdict::tip_travel_m); }},
      {"tip_travel_simplified", "REAL",
       [](const Record& r) { return Measure(r.simplified_check, &PathVerdict::tip_travel_m); }},
      {"smoothness", "REAL",
       [](const Record& r) { return Measure(r.path_check, &PathVerdict::smoothness); }},
      {"smoothness_simplified", "REAL",
       [](const Record& r) { return Measure(r.simplified_check, &PathVerdict::smoothness); }},
      {"clearance", "REAL",
       [](const Record& r) { return Clearance(r.path_check, &PathVerdict::clearance_min_m); }},
      {"clearance_simplified", "REAL",
       [](const Record& r) {
         return Clearance(r.simplified_check, &PathVerdict::clearance_min_m);
       }},
      {"clearance_mean", "REAL",
       [](const Record& r) { return Clearance(r.path_check, &PathVerdict::clearance_mean_m); }},
      {"clearance_mean_simplified", "REAL",
       [](const Record& r) {
         return Clearance(r.simplified_check, &PathVerdict::clearance_mean_m);
       }},
      {"num_waypoints", "INTEGER",
       [](const Record& r) { return NumWaypoints(r.result.result.path); }},
      {"num_waypoints_simplified", "INTEGER",
       [](const Record& r) { return NumWaypoints(r.result.result.simplified_path); }},

      {"referee_valid", "BOOLEAN", [](const Record& r) { return Valid(r.path_check.verdict); }},
      {"referee_reason", "TEXT",
       [](const Record& r) { return Reason(r.path_check, r.path_check.verdict); }},
      {"referee_engine", "TEXT", [](const Record& r) { return Text(r.path_check.engine); }},
      {"referee_step", "REAL", [](const Record& r) { return RealUnlessZero(r.path_check.step_m); }},
      {"simplified_valid", "BOOLEAN",
       [](const Record& r) { return Valid(r.simplified_check.verdict); }},
      {"simplified_reason", "TEXT",
       [](const Record& r) { return Reason(r.simplified_check, r.simplified_check.verdict); }},
      {"mesh_valid", "BOOLEAN", [](const Record& r) { return Valid(r.path_check.mesh_verdict); }},
      {"mesh_reason", "TEXT",
       [](const Record& r) {
         return r.path_check.mesh_verdict ? Text(r.path_check.mesh_verdict->reason)
                                          : SqliteValue(kNull);
       }},
      {"mesh_valid_simplified", "BOOLEAN",
       [](const Record& r) { return Valid(r.simplified_check.mesh_verdict); }},
      {"mesh_reason_simplified", "TEXT",
       [](const Record& r) {
         return r.simplified_check.mesh_verdict ? Text(r.simplified_check.mesh_verdict->reason)
                                                : SqliteValue(kNull);
       }},

      {"epsilon", "REAL",
       [](const Record& r) {
         return OfAnswer(r, [](const PlanResult& p) { return RealUnlessZero(p.epsilon); });
       }},
      {"cost", "REAL",
       [](const Record& r) {
         return OfAnswer(r, [](const PlanResult& p) { return RealUnlessZero(p.cost); });
       }},
      {"edges_checked", "INTEGER", [](const Record& r) { return Counter(r, "edges_checked"); }},
      {"configurations_checked", "INTEGER",
       [](const Record& r) { return Counter(r, "configurations_checked"); }},
      {"iterations", "INTEGER", [](const Record& r) { return Counter(r, "iterations"); }},
      {"expansions", "INTEGER", [](const Record& r) { return Counter(r, "expansions"); }},
      {"states", "INTEGER", [](const Record& r) { return Counter(r, "states"); }},
  };
}

}  // namespace

const std::vector<RunColumn>& RunColumns() {
  static const std::vector<RunColumn> columns = MakeRunColumns();
  return columns;
}

}  // namespace planbench
