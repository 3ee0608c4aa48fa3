#include <cmath>

#include "messaging/wire.h"
#include "planbench/lcmt_collision_reply.hpp"
#include "planbench/lcmt_collision_request.hpp"
#include "planbench/lcmt_collision_verdict.hpp"
#include "planbench/lcmt_path_check_request.hpp"
#include "planbench/lcmt_path_verdict.hpp"

namespace planbench {
namespace wire {
namespace {

// Distances are infinite where there is nothing to collide with.
double Distance(double value, const Field& at) {
  if (value == std::numeric_limits<double>::infinity()) return value;
  return Finite(value, at);
}

lcmt_collision_verdict ToWire(const CollisionVerdict& verdict) {
  lcmt_collision_verdict wire{};
  wire.within_limits = verdict.within_limits;
  wire.free = verdict.free;
  wire.body_a = verdict.body_a;
  wire.body_b = verdict.body_b;
  wire.depth_m = verdict.depth_m;
  wire.fraction = verdict.fraction;
  wire.distance_m = verdict.distance_m;
  wire.nearest_a = verdict.nearest_a;
  wire.nearest_b = verdict.nearest_b;
  return wire;
}

CollisionVerdict FromWire(const lcmt_collision_verdict& wire, const Field& at) {
  CollisionVerdict verdict;
  verdict.within_limits = Bool(wire.within_limits, at("within_limits"));
  verdict.free = Bool(wire.free, at("free"));
  verdict.body_a = wire.body_a;
  verdict.body_b = wire.body_b;
  verdict.depth_m = NonNegative(wire.depth_m, at("depth_m"));
  verdict.fraction = Fraction(wire.fraction, at("fraction"));
  verdict.distance_m = Distance(wire.distance_m, at("distance_m"));
  verdict.nearest_a = wire.nearest_a;
  verdict.nearest_b = wire.nearest_b;
  return verdict;
}

std::vector<lcmt_collision_verdict> VerdictsToWire(const std::vector<CollisionVerdict>& verdicts) {
  std::vector<lcmt_collision_verdict> wire;
  wire.reserve(verdicts.size());
  for (const CollisionVerdict& verdict : verdicts) wire.push_back(ToWire(verdict));
  return wire;
}

std::vector<CollisionVerdict> VerdictsFromWire(const std::vector<lcmt_collision_verdict>& wire,
                                               const Field& parent, const char* name) {
  std::vector<CollisionVerdict> verdicts;
  verdicts.reserve(wire.size());
  for (std::size_t i = 0; i < wire.size(); ++i) {
    verdicts.push_back(FromWire(wire[i], parent(name, i)));
  }
  return verdicts;
}

Configuration ConfigurationFromWire(const std::vector<double>& positions, const Field& at) {
  for (const double position : positions) Finite(position, at);
  return positions;
}

lcmt_path_verdict ToWire(const std::optional<PathVerdict>& verdict) {
  lcmt_path_verdict wire{};
  if (!verdict) return wire;
  wire.judged = true;
  wire.valid = verdict->valid;
  wire.reason = verdict->reason;
  wire.segment = verdict->segment;
  wire.fraction = verdict->fraction;
  if (verdict->contact) {
    wire.body_a = verdict->contact->body_a;
    wire.body_b = verdict->contact->body_b;
    wire.depth_m = verdict->contact->depth_m;
  }
  wire.length = verdict->length;
  wire.tip_travel_m = verdict->tip_travel_m;
  wire.smoothness = verdict->smoothness;
  wire.clearance_min_m = verdict->clearance_min_m;
  wire.clearance_mean_m = verdict->clearance_mean_m;
  wire.num_samples = verdict->num_samples;
  return wire;
}

std::optional<PathVerdict> FromWire(const lcmt_path_verdict& wire, const Field& at) {
  if (!Bool(wire.judged, at("judged"))) return std::nullopt;
  PathVerdict verdict;
  verdict.valid = Bool(wire.valid, at("valid"));
  verdict.reason = wire.reason;
  verdict.segment = static_cast<int>(AtLeast(-1, wire.segment, at("segment")));
  verdict.fraction = Fraction(wire.fraction, at("fraction"));
  NonNegative(wire.depth_m, at("depth_m"));
  if (!wire.body_a.empty()) verdict.contact = Contact{wire.body_a, wire.body_b, wire.depth_m};
  verdict.length = NonNegative(wire.length, at("length"));
  verdict.tip_travel_m = NonNegative(wire.tip_travel_m, at("tip_travel_m"));
  verdict.smoothness = Finite(wire.smoothness, at("smoothness"));
  verdict.clearance_min_m = Distance(wire.clearance_min_m, at("clearance_min_m"));
  verdict.clearance_mean_m = Distance(wire.clearance_mean_m, at("clearance_mean_m"));
  verdict.num_samples = static_cast<int>(AtLeast(0, wire.num_samples, at("num_samples")));
  return verdict;
}

}  // namespace

lcmt_path_check_reply ToWire(const PathCheckReplyMessage& reply) {
  lcmt_path_check_reply wire{};
  wire.utime = NowUtime();
  wire.request_id = reply.request_id;
  wire.ok = reply.ok;
  wire.message = reply.message;
  wire.engine = reply.engine;
  wire.step_m = reply.step_m;
  wire.verdict = ToWire(reply.verdict);
  wire.mesh_verdict = ToWire(reply.mesh_verdict);
  return wire;
}

PathCheckReplyMessage FromWire(const lcmt_path_check_reply& wire, const Field& at) {
  PathCheckReplyMessage reply;
  reply.request_id = wire.request_id;
  reply.ok = Bool(wire.ok, at("ok"));
  reply.message = wire.message;
  reply.engine = wire.engine;
  reply.step_m = NonNegative(wire.step_m, at("step_m"));
  reply.verdict = FromWire(wire.verdict, at("verdict"));
  reply.mesh_verdict = FromWire(wire.mesh_verdict, at("mesh_verdict"));
  return reply;
}

}  // namespace wire

using wire::Field;

template <>
std::vector<std::uint8_t> Encode(const CollisionRequestMessage& message) {
  lcmt_collision_request wire{};
  wire.utime = NowUtime();
  wire.request_id = message.request_id;
  wire.scene_id = message.scene_id;
  wire.group = message.group;
  wire.state = wire::ToWire(message.state);
  wire.collision_model = EnumName(message.collision_model);
  wire.edge_resolution_m = message.edge_resolution_m;
  wire.with_distance = message.with_distance;
  std::size_t num_joints = 0;
  if (!message.states.empty()) {
    num_joints = message.states.front().size();
  } else if (!message.edges.empty()) {
    num_joints = message.edges.front().from.size();
  }
  for (const Configuration& state : message.states) {
    wire::RequireSameSize(num_joints, state.size(), "states of a collision request");
    wire.position.push_back(state);
  }
  for (const EdgeQuery& edge : message.edges) {
    wire::RequireSameSize(num_joints, edge.from.size(), "edges of a collision request");
    wire::RequireSameSize(num_joints, edge.to.size(), "edges of a collision request");
    wire.edge_from.push_back(edge.from);
    wire.edge_to.push_back(edge.to);
  }
  wire.num_joints = wire::Count(num_joints);
  wire.num_states = wire::Count(wire.position.size());
  wire.num_edges = wire::Count(wire.edge_from.size());
  return wire::Pack(wire);
}

template <>
CollisionRequestMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto wire = wire::Unpack<lcmt_collision_request>(bytes, channel);
  const Field at(channel, wire.request_id);
  CollisionRequestMessage message;
  message.request_id = wire::NotEmpty(wire.request_id, at("request_id"));
  message.scene_id = wire::NotEmpty(wire.scene_id, at("scene_id"));
  message.group = wire.group;
  message.state = wire::FromWire(wire.state, at("state"));
  message.collision_model = wire::Model(wire.collision_model, at("collision_model"));
  message.edge_resolution_m = wire::NonNegative(wire.edge_resolution_m, at("edge_resolution_m"));
  message.with_distance = wire::Bool(wire.with_distance, at("with_distance"));
  wire::AtLeast(0, wire.num_joints, at("num_joints"));
  for (std::size_t i = 0; i < wire.position.size(); ++i) {
    message.states.push_back(wire::ConfigurationFromWire(wire.position[i], at("position", i)));
  }
  for (std::size_t i = 0; i < wire.edge_from.size(); ++i) {
    message.edges.push_back({wire::ConfigurationFromWire(wire.edge_from[i], at("edge_from", i)),
                             wire::ConfigurationFromWire(wire.edge_to[i], at("edge_to", i))});
  }
  return message;
}

template <>
std::vector<std::uint8_t> Encode(const CollisionReplyMessage& message) {
  lcmt_collision_reply wire{};
  wire.utime = NowUtime();
  wire.request_id = message.request_id;
  wire.ok = message.ok;
  wire.message = message.message;
  wire.engine = message.engine;
  wire.state = wire::VerdictsToWire(message.states);
  wire.num_states = wire::Count(wire.state.size());
  wire.edge = wire::VerdictsToWire(message.edges);
  wire.num_edges = wire::Count(wire.edge.size());
  return wire::Pack(wire);
}

template <>
CollisionReplyMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto wire = wire::Unpack<lcmt_collision_reply>(bytes, channel);
  const Field at(channel, wire.request_id);
  CollisionReplyMessage message;
  message.request_id = wire::NotEmpty(wire.request_id, at("request_id"));
  message.ok = wire::Bool(wire.ok, at("ok"));
  message.message = wire.message;
  message.engine = wire.engine;
  message.states = wire::VerdictsFromWire(wire.state, at, "state");
  message.edges = wire::VerdictsFromWire(wire.edge, at, "edge");
  return message;
}

template <>
std::vector<std::uint8_t> Encode(const PathCheckRequestMessage& message) {
  lcmt_path_check_request wire{};
  wire.utime = NowUtime();
  wire.request_id = message.request_id;
  wire.scene_id = message.scene_id;
  wire.group = message.group;
  wire.start = wire::ToWire(message.start);
  wire.goal = wire::ToWire(message.goal);
  wire.num_goals = wire::Count(wire.goal.size());
  wire.path = wire::ToWire(message.joint_names, message.path);
  wire.collision_model = EnumName(message.collision_model);
  wire.step_m = message.step_m;
  wire.with_clearance = message.with_clearance;
  return wire::Pack(wire);
}

template <>
PathCheckRequestMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto wire = wire::Unpack<lcmt_path_check_request>(bytes, channel);
  const Field at(channel, wire.request_id);
  PathCheckRequestMessage message;
  message.request_id = wire::NotEmpty(wire.request_id, at("request_id"));
  message.scene_id = wire::NotEmpty(wire.scene_id, at("scene_id"));
  message.group = wire.group;
  message.start = wire::FromWire(wire.start, at("start"));
  message.goal = wire::FromWire(wire.goal, at, "goal");
  wire::NamedPath path = wire::FromWire(wire.path, at("path"));
  message.joint_names = std::move(path.joint_names);
  message.path = std::move(path.path);
  message.collision_model = wire::Model(wire.collision_model, at("collision_model"));
  message.step_m = wire::Positive(wire.step_m, at("step_m"));
  message.with_clearance = wire::Bool(wire.with_clearance, at("with_clearance"));
  return message;
}

template <>
std::vector<std::uint8_t> Encode(const PathCheckReplyMessage& message) {
  return wire::Pack(wire::ToWire(message));
}

template <>
PathCheckReplyMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto message = wire::Unpack<lcmt_path_check_reply>(bytes, channel);
  const Field at(channel, message.request_id);
  wire::NotEmpty(message.request_id, at("request_id"));
  return wire::FromWire(message, at);
}

}  // namespace planbench
