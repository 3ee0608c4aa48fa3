#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "messaging/field_rules.h"
#include "messaging/fields.h"
#include "messaging/messages.h"
#include "messaging/scene_fields.h"
#include "planning/improvement_rule.h"

/// The field lists (fields.h) of all messages.
namespace planbench {

// What stands inside messages.

template <>
struct Fields<std::pair<std::string, std::string>> : On<lcmt_key_value> {
  static constexpr const char* kKey = "key";
  static void List(auto& io, auto& entry, auto& w) {
    io.Field("key", entry.first, w.key, kNotEmpty);
    io.Field("value", entry.second, w.value);
  }
};
template <>
struct Fields<std::pair<const std::string, std::string>>
    : Fields<std::pair<std::string, std::string>> {};

template <>
struct Fields<std::pair<std::string, double>> : On<lcmt_named_value> {
  static constexpr const char* kKey = "name";
  static void List(auto& io, auto& entry, auto& w) {
    io.Field("name", entry.first, w.name, kNotEmpty);
    io.Field("value", entry.second, w.value, kDistance);  // Measures of paths may be distances.
  }
};
template <>
struct Fields<std::pair<const std::string, double>> : Fields<std::pair<std::string, double>> {};

template <>
struct Fields<JointState> : On<lcmt_joint_state> {
  static void List(auto& io, auto& state, auto& w) {
    io.List("joint_name", state.names, w.joint_name, w.num_joints, kNames);
    io.Beside("position", state.positions, w.position, w.num_joints);
  }
};

template <>
struct Fields<JointGoal> : On<lcmt_joint_goal> {
  static void List(auto& io, auto& goal, auto& w) {
    io.Field("joint_name", goal.joint, w.joint_name, kNotEmpty);
    io.Field("position", goal.position, w.position);
    io.Field("tolerance_above", goal.tolerance_above, w.tolerance_above, kNonNegative);
    io.Field("tolerance_below", goal.tolerance_below, w.tolerance_below, kNonNegative);
  }
};

/// A path and the joints of its waypoints. Without waypoints the names do not travel.
template <typename Names, typename Waypoints>
struct NamedPath {
  Names& joint_names;
  Waypoints& waypoints;
};
template <typename Names, typename Waypoints>
NamedPath(Names&, Waypoints&) -> NamedPath<Names, Waypoints>;

template <typename Names, typename Waypoints>
struct Fields<NamedPath<Names, Waypoints>> : On<lcmt_path> {
  template <typename Io>
  static void List(Io& io, auto& path, auto& w) {
    std::vector<std::string> names;
    if constexpr (!Io::kReads) {
      if (!path.waypoints.empty()) names = path.joint_names;
    }
    io.List("joint_name", names, w.joint_name, w.num_joints, kNames);
    io.Rows("position", path.waypoints, w.position, w.num_waypoints, w.num_joints);
    if constexpr (Io::kReads) {
      if (path.waypoints.empty()) return;
      io.Require(!names.empty(), "num_joints", "waypoints without joints");
      io.Require(path.joint_names.empty() || path.joint_names == names, "joint_name",
                 "other joints than those of path");
      path.joint_names = std::move(names);
    }
  }
};

// Nodes and problems.

template <>
struct Fields<DiscoverMessage> : On<lcmt_discover> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("sender", v.sender, w.sender);
  }
};

template <>
struct Fields<NodeStatusMessage> : On<lcmt_node_status> {
  static void List(auto& io, auto& v, auto& w) {
    io.Field("utime", v.utime, w.utime);
    io.Field("start_utime", v.start_utime, w.start_utime);
    io.Field("instance", v.instance, w.instance, kId);
    io.Field("name", v.name, w.name, kNodeName);
    io.Field("kind", v.kind, w.kind);
    io.Field("state", v.busy, w.state);
    io.Field("request_id", v.request_id, w.request_id);
    io.Field("trouble", v.trouble, w.trouble, kReason);
    io.Field("host", v.host, w.host);
    io.Field("pid", v.pid, w.pid);
    io.Field("version", v.version, w.version);
    io.Field("commit", v.commit, w.commit);
    io.Field("robot_name", v.robot_name, w.robot_name);
    io.Field("robot_id", v.robot_id, w.robot_id);
    io.Field("algorithm", v.algorithm, w.algorithm);
    io.Field("planner_class", v.planner_class, w.planner_class);
    io.Field("can_backward", v.can_backward, w.can_backward);
    io.Field("can_anytime", v.can_anytime, w.can_anytime);
    io.Field("can_improve", v.can_improve, w.can_improve);
    io.Field("bidirectional", v.bidirectional, w.bidirectional);
    io.Field("deterministic", v.deterministic, w.deterministic);
    io.List("collision_model", v.collision_models, w.collision_model, w.num_collision_models,
            kNames);
    io.List("unusable_model", v.unusable_models, w.unusable_model, w.num_unusable_models);
    io.List("setting", v.settings, w.setting, w.num_settings);
  }
};

template <>
struct Fields<ProblemSetSummary> : On<lcmt_problem_set> {
  static constexpr const char* kKey = "name";
  static const std::string& Key(const ProblemSetSummary& set) { return set.name; }
  static void List(auto& io, auto& v, auto& w) {
    io.Field("name", v.name, w.name, kNotEmpty);
    io.List("problem_index", v.indices, w.problem_index, w.num_problems, kAscending);
    io.Field("content_id", v.content_id, w.content_id);
  }
};

template <>
struct Fields<ProblemSetsMessage> : On<lcmt_problem_sets> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("server", v.server, w.server, kNotEmpty);
    io.Field("robot_name", v.robot_name, w.robot_name);
    io.Field("robot_id", v.robot_id, w.robot_id);
    io.Field("edge_resolution_m", v.edge_resolution_m, w.edge_resolution_m, kPositive);
    io.Field("edge_check", v.edge_check, w.edge_check);
    io.Field("mesh_robot_id", v.mesh_robot_id, w.mesh_robot_id);
    io.Field("referee_robot_id", v.referee_robot_id, w.referee_robot_id);
    io.List("set", v.sets, w.set, w.num_sets);
  }
};

template <>
struct Fields<ProblemRequestMessage> : On<lcmt_problem_request> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("request_id", v.request_id, w.request_id, kId);
    io.Field("problem_set", v.problem_set, w.problem_set, kNotEmpty);
    io.Field("problem_index", v.problem_index, w.problem_index, kAtLeast<0>);
  }
};

template <>
struct Fields<ProblemMessage> : On<lcmt_problem> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("request_id", v.request_id, w.request_id, kId);
    io.Field("ok", v.ok, w.ok);
    io.Field("message", v.message, w.message, kReason);
    io.Field("problem_set", v.problem_set, w.problem_set);
    io.Field("problem_index", v.problem_index, w.problem_index, kAtLeast<0>);
    io.Field("scene_id", v.scene_id, w.scene_id);
    io.Field("group", v.group, w.group);
    io.Field("start", v.start, w.start);
    io.List("goal", v.goal, w.goal, w.num_goals);
    io.Field("time_limit_s", v.time_limit_s, w.time_limit_s, kSeconds);
    // A refusal may leave these empty.
    io.Require(!v.ok || !v.problem_set.empty(), "problem_set", "is empty");
    io.Require(!v.ok || !v.scene_id.empty(), "scene_id", "is empty");
  }
};

template <>
struct Fields<SceneRequestMessage> : On<lcmt_scene_request> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("request_id", v.request_id, w.request_id, kId);
    io.Field("scene_id", v.scene_id, w.scene_id, kNotEmpty);
  }
};

template <>
struct Fields<SceneMessage> : On<lcmt_scene> {
  template <typename Io>
  static void List(Io& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("request_id", v.request_id, w.request_id);
    io.Field("scene_id", v.scene_id, w.scene_id);
    io.Field("ok", v.ok, w.ok);
    io.Field("message", v.message, w.message, kReason);
    Fields<Scene>::List(io, v.scene, w);
    if constexpr (Io::kReads) {
      if (!v.ok) return;
      const std::string id = SceneId(v.scene);
      io.Require(id == v.scene_id, "scene_id", "the content is {}, not {}", id, v.scene_id);
    }
  }
};

// Planning.

template <>
struct Fields<PlanRequest> : On<lcmt_plan_request> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("run_id", v.run_id, w.run_id);
    io.Field("request_id", v.request_id, w.request_id, kId);
    io.Field("scene_id", v.scene_id, w.scene_id, kId);
    io.Field("robot_id", v.robot_id, w.robot_id);
    io.Field("group", v.group, w.group);
    io.Field("start", v.start, w.start);
    io.List("goal", v.goal, w.goal, w.num_goals);
    io.Field("direction", v.direction, w.direction);
    io.Field("time_limit_s", v.time_limit_s, w.time_limit_s, kSeconds);
    io.Field("seed", v.seed, w.seed);
    io.Field("collision_model", v.collision_model, w.collision_model);
    io.Field("edge_resolution_m", v.edge_resolution_m, w.edge_resolution_m, kNonNegative);
    io.Field("edge_check", v.edge_check, w.edge_check);
    io.Field("anytime", v.anytime, w.anytime);
    io.Field("simplify", v.simplify, w.simplify);
    NamedPath initial{v.initial_joint_names, v.initial_path};
    io.Field("initial_path", initial, w.initial_path);
    io.List("parameter", v.parameters, w.parameter, w.num_parameters);
  }
};

template <>
struct Fields<PlanAckMessage> : On<lcmt_plan_ack> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("planner", v.planner, w.planner);
    io.Field("request_id", v.request_id, w.request_id, kId);
    io.Field("verdict", v.verdict, w.verdict);
    io.Field("message", v.message, w.message, kReason);
  }
};

template <>
struct Fields<PlanProgress> : On<lcmt_plan_progress> {
  static void List(auto& io, auto& v, auto& w) {
    io.Field("elapsed_s", v.elapsed_s, w.elapsed_s, kSeconds);
    io.Field("epsilon", v.epsilon, w.epsilon, kBound);
    io.Field("cost", v.cost, w.cost);
    io.Field("expansions", v.expansions, w.expansions, kAtLeast<0>);
  }
};

template <>
struct Fields<PlanProgressMessage> : On<lcmt_plan_progress> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("planner", v.planner, w.planner);
    io.Field("request_id", v.request_id, w.request_id, kId);
    Fields<PlanProgress>::List(io, v.progress, w);
  }
};

/// What a result's counters are by their names: what every planner's are called is a number of
/// things, a planner's own may be any finite number.
template <typename Io>
void RequireCounters(Io& io, const std::map<std::string, double>& counters) {
  for (const auto& [name, value] : counters) {
    const bool is_count = name == "edges_checked" || name == "configurations_checked";
    const bool ok = is_count ? rules::Count::Ok(value) : rules::Finite::Ok(value);
    if (ok) continue;
    io.Require(false, "counter", "{}: {}", name,
               is_count ? rules::Count::What(value) : rules::Finite::What(value));
  }
}

template <typename Io>
void RequireImprovements(Io& io, const std::vector<PlanProgress>& progress) {
  ImprovementRule rule;
  for (const PlanProgress& one : progress) {
    const std::string fault = rule.Take(one);
    io.Require(fault.empty(), "progress", "{}", fault);
  }
}

template <>
struct Fields<PlanResultMessage> : On<lcmt_plan_result> {
  template <typename Io>
  static void List(Io& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("planner", v.planner, w.planner);
    io.Field("run_id", v.run_id, w.run_id);
    io.Field("request_id", v.request_id, w.request_id, kId);
    auto& r = v.result;
    io.Field("status", r.status, w.status);
    const bool is_drivers =
        r.status == PlanStatus::kNoAnswer || r.status == PlanStatus::kInvalidPath;
    io.Require(v.request_id.empty() || !is_drivers, "status", "{} is the driver's to say",
               EnumName(r.status));
    io.Field("message", r.message, w.message, kReason);
    io.Field("planning_time_s", r.planning_time_s, w.planning_time_s, kSeconds);
    io.Field("total_time_s", r.total_time_s, w.total_time_s, kSeconds);
    auto& phases = r.phases;
    io.Field("setup_s", phases.setup_s, w.setup_s, kSeconds);
    io.Field("collision_s", phases.collision_s, w.collision_s, kSeconds);
    io.Field("guidance_s", phases.guidance_s, w.guidance_s, kSeconds);
    io.Field("search_s", phases.search_s, w.search_s, kSeconds);
    io.Field("simplification_s", phases.simplification_s, w.simplification_s, kSeconds);
    NamedPath path{v.joint_names, r.path};
    io.Field("path", path, w.path);
    NamedPath simplified{v.joint_names, r.simplified_path};
    io.Field("simplified_path", simplified, w.simplified_path);
    io.Require(r.simplified_path.empty() || !r.path.empty(), "simplified_path", "there is no path");
    io.Field("epsilon", r.epsilon, w.epsilon, kBound);
    io.Field("cost", r.cost, w.cost);
    io.List("progress", r.progress, w.progress, w.num_progress);
    io.List("counter", r.counters, w.counter, w.num_counters);
    if constexpr (Io::kReads) {
      RequireImprovements(io, r.progress);
      RequireCounters(io, r.counters);
    }
    io.Field("peak_memory_mb", r.peak_memory_mb, w.peak_memory_mb, kMemory);
  }
};

template <>
struct Fields<PlanCancelMessage> : On<lcmt_plan_cancel> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("request_id", v.request_id, w.request_id, kId);
  }
};

template <>
struct Fields<AckMessage> : On<lcmt_ack> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("id", v.id, w.id, kNotEmpty);
    io.Field("sender", v.sender, w.sender);
    io.Field("ok", v.ok, w.ok);
    io.Field("message", v.message, w.message, kReason);
  }
};

// Checks.

template <>
struct Fields<CollisionRequestMessage> : On<lcmt_collision_request> {
  template <typename Io>
  static void List(Io& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("request_id", v.request_id, w.request_id, kId);
    io.Field("scene_id", v.scene_id, w.scene_id, kNotEmpty);
    io.Field("group", v.group, w.group);
    io.Field("state", v.state, w.state);
    io.Field("collision_model", v.collision_model, w.collision_model);
    io.Field("edge_resolution_m", v.edge_resolution_m, w.edge_resolution_m, kNonNegative);
    io.Field("edge_check", v.edge_check, w.edge_check);
    io.Field("with_distance", v.with_distance, w.with_distance);
    std::vector<Configuration> from, to;
    std::size_t num_joints = 0;
    if constexpr (!Io::kReads) {
      for (const EdgeQuery& edge : v.edges) {
        from.push_back(edge.from);
        to.push_back(edge.to);
      }
      num_joints = !v.states.empty() ? v.states.front().size()
                   : !from.empty()   ? from.front().size()
                                     : 0;
    }
    io.Field("num_joints", num_joints, w.num_joints, kAtLeast<0>);
    io.Rows("position", v.states, w.position, w.num_states, w.num_joints);
    io.Rows("edge_from", from, w.edge_from, w.num_edges, w.num_joints);
    io.Rows("edge_to", to, w.edge_to, w.num_edges, w.num_joints);
    if constexpr (Io::kReads) {
      for (std::size_t i = 0; i < from.size(); ++i) {
        v.edges.push_back({std::move(from[i]), std::move(to[i])});
      }
    }
  }
};

template <>
struct Fields<CollisionVerdict> : On<lcmt_collision_verdict> {
  static void List(auto& io, auto& v, auto& w) {
    io.Field("within_limits", v.within_limits, w.within_limits);
    io.Field("free", v.free, w.free);
    io.Field("body_a", v.body_a, w.body_a);
    io.Field("body_b", v.body_b, w.body_b);
    io.Field("depth_m", v.depth_m, w.depth_m, kNonNegative);
    io.Field("fraction", v.fraction, w.fraction, kFraction);
    io.Field("distance_m", v.distance_m, w.distance_m, kDistance);
    io.Field("nearest_a", v.nearest_a, w.nearest_a);
    io.Field("nearest_b", v.nearest_b, w.nearest_b);
  }
};

template <>
struct Fields<CollisionReplyMessage> : On<lcmt_collision_reply> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("request_id", v.request_id, w.request_id, kId);
    io.Field("ok", v.ok, w.ok);
    io.Field("message", v.message, w.message, kReason);
    io.Field("engine", v.engine, w.engine);
    io.List("state", v.states, w.state, w.num_states);
    io.List("edge", v.edges, w.edge, w.num_edges);
  }
};

template <>
struct Fields<PathCheckRequestMessage> : On<lcmt_path_check_request> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("request_id", v.request_id, w.request_id, kId);
    io.Field("scene_id", v.scene_id, w.scene_id, kNotEmpty);
    io.Field("group", v.group, w.group);
    io.Field("start", v.start, w.start);
    io.List("goal", v.goal, w.goal, w.num_goals);
    NamedPath path{v.joint_names, v.path};
    io.Field("path", path, w.path);
    io.Field("collision_model", v.collision_model, w.collision_model);
    io.Field("step_m", v.step_m, w.step_m, kPositive);
    io.Field("with_clearance", v.with_clearance, w.with_clearance);
  }
};

template <>
struct Fields<PathVerdict> : On<lcmt_path_verdict> {
  template <typename Io>
  static void List(Io& io, auto& v, auto& w) {
    io.Field("valid", v.valid, w.valid);
    io.Field("reason", v.reason, w.reason, kReason);
    io.Field("segment", v.segment, w.segment, kAtLeast<-1>);
    io.Field("fraction", v.fraction, w.fraction, kFraction);
    Contact contact;
    if constexpr (!Io::kReads) contact = v.contact.value_or(Contact{});
    io.Field("body_a", contact.body_a, w.body_a);
    io.Field("body_b", contact.body_b, w.body_b);
    io.Field("depth_m", contact.depth_m, w.depth_m, kNonNegative);
    if constexpr (Io::kReads) {
      if (!contact.body_a.empty()) v.contact = std::move(contact);
    }
    io.List("measure", v.measures, w.measure, w.num_measures);
    io.Field("num_samples", v.num_samples, w.num_samples, kAtLeast<0>);
  }
};

template <>
struct Fields<PathCheckReplyMessage> : On<lcmt_path_check_reply> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("request_id", v.request_id, w.request_id, kId);
    io.Field("ok", v.ok, w.ok);
    io.Field("message", v.message, w.message, kReason);
    io.Field("engine", v.engine, w.engine);
    io.Field("step_m", v.step_m, w.step_m, kNonNegative);
    io.Optional("verdict", v.verdict, w.verdict, "judged", w.verdict.judged);
    io.Optional("mesh_verdict", v.mesh_verdict, w.mesh_verdict, "judged", w.mesh_verdict.judged);
  }
};

// Sessions and runs.

template <>
struct Fields<Contestant> : On<lcmt_contestant> {
  static constexpr const char* kKey = "planner";
  static const std::string& Key(const Contestant& contestant) { return contestant.planner; }
  static void List(auto& io, auto& v, auto& w) {
    io.Field("planner", v.planner, w.planner, kNodeName);
    io.Field("name", v.name, w.name, kNotEmpty);
    io.Field("about", v.about, w.about);
    io.Field("published", v.published, w.published);
    io.Field("command", v.command, w.command);
    io.Field("first_path_of", v.first_path_of, w.first_path_of);
    io.Field("collision_model", v.collision_model, w.collision_model);
    io.Field("edge_resolution_m", v.edge_resolution_m, w.edge_resolution_m, kNonNegative);
    io.Field("edge_check", v.edge_check, w.edge_check);
  }
};

template <>
struct Fields<SessionConditions> : On<lcmt_session_conditions> {
  static void List(auto& io, auto& v, auto& w) {
    io.Field("request", v.request, w.request);
    io.Field("referee_step_m", v.referee_step_m, w.referee_step_m, kNonNegative);
    io.Field("with_clearance", v.with_clearance, w.with_clearance);
    io.Field("parallel", v.parallel, w.parallel);
    io.Field("mesh_robot_id", v.mesh_robot_id, w.mesh_robot_id);
    io.Field("referee_robot_id", v.referee_robot_id, w.referee_robot_id);
    io.List("problem_set", v.problem_sets, w.problem_set, w.num_problem_sets);
    io.List("contestant", v.contestants, w.contestant, w.num_contestants);
  }
};

template <>
struct Fields<SessionMessage> : On<lcmt_session> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("run_id", v.run_id, w.run_id, kId);
    io.Field("start_utime", v.start_utime, w.start_utime);
    io.Field("finished", v.finished, w.finished);
    io.Field("total_time_s", v.total_time_s, w.total_time_s, kSeconds);
    io.Field("num_runs", v.num_runs, w.num_runs, kAtLeast<0>);
    io.Field("version", v.version, w.version);
    io.Field("commit", v.commit, w.commit);
    io.Field("host", v.host, w.host);
    io.Field("cpu", v.cpu, w.cpu);
    io.Field("robot_name", v.robot_name, w.robot_name);
    io.Field("conditions", v.conditions, w.conditions);
    io.List("setting", v.settings, w.setting, w.num_settings);
    io.List("left_out", v.left_out, w.left_out, w.num_left_out);
    io.List("node", v.nodes, w.node, w.num_nodes);
  }
};

template <>
struct Fields<RunRecordMessage> : On<lcmt_run_record> {
  static void List(auto& io, auto& v, auto& w) {
    io.Utime(w.utime);
    io.Field("run_id", v.run_id, w.run_id, kId);
    io.Field("request_id", v.request_id, w.request_id, kId);
    io.Field("planner", v.planner, w.planner, kId);
    io.Field("contestant", v.contestant, w.contestant, kNotEmpty);
    io.Field("algorithm", v.algorithm, w.algorithm);
    io.Field("planner_class", v.planner_class, w.planner_class);
    io.List("setting", v.settings, w.setting, w.num_settings);
    io.Field("problem_set", v.problem_set, w.problem_set);
    io.Field("problem_index", v.problem_index, w.problem_index, kAtLeast<0>);
    io.Field("trial", v.trial, w.trial, kAtLeast<1>);
    io.Field("start_utime", v.start_utime, w.start_utime);
    io.Field("status", v.status, w.status);
    io.Field("message", v.message, w.message, kReason);
    io.Field("roundtrip_time_s", v.roundtrip_time_s, w.roundtrip_time_s, kSeconds);
    io.Field("request", v.request, w.request);
    io.Field("result", v.result, w.result);
    io.Field("path_check", v.path_check, w.path_check);
    io.Field("simplified_check", v.simplified_check, w.simplified_check);
  }
};

}  // namespace planbench
