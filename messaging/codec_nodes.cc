#include <fmt/format.h>

#include <chrono>

#include "messaging/channels.h"
#include "messaging/wire.h"
#include "planbench/lcmt_discover.hpp"
#include "planbench/lcmt_problem.hpp"
#include "planbench/lcmt_problem_request.hpp"
#include "planbench/lcmt_problem_set.hpp"
#include "planbench/lcmt_problem_sets.hpp"

namespace planbench {

std::int64_t NowUtime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

namespace wire {
namespace {

lcmt_problem_set SetToWire(const ProblemSetSummary& set) {
  lcmt_problem_set wire{};
  wire.name = set.name;
  wire.problem_index.assign(set.indices.begin(), set.indices.end());
  wire.num_problems = Count(wire.problem_index.size());
  return wire;
}

ProblemSetSummary SetFromWire(const lcmt_problem_set& wire, const Field& at) {
  ProblemSetSummary set;
  set.name = NotEmpty(wire.name, at("name"));
  for (std::size_t i = 0; i < wire.problem_index.size(); ++i) {
    const int index = wire.problem_index[i];
    AtLeast(0, index, at("problem_index", i));
    if (i > 0 && index <= set.indices.back()) {
      at("problem_index", i).Fail(fmt::format("{} is not ascending", index));
    }
    set.indices.push_back(index);
  }
  return set;
}

}  // namespace

lcmt_node_status ToWire(const NodeStatusMessage& status) {
  lcmt_node_status wire{};
  wire.utime = status.utime;
  wire.start_utime = status.start_utime;
  wire.name = status.name;
  wire.kind = static_cast<std::int8_t>(status.kind);
  wire.state = status.busy ? lcmt_node_status::STATE_BUSY : lcmt_node_status::STATE_IDLE;
  wire.request_id = status.request_id;
  wire.host = status.host;
  wire.pid = status.pid;
  wire.version = status.version;
  wire.commit = status.commit;
  wire.robot_name = status.robot_name;
  wire.robot_id = status.robot_id;
  wire.algorithm = status.algorithm;
  wire.planner_class = status.planner_class;
  wire.can_backward = status.can_backward;
  wire.can_anytime = status.can_anytime;
  wire.collision_model = status.collision_models;
  wire.num_collision_models = Count(wire.collision_model.size());
  wire.setting = ToWire(status.settings);
  wire.num_settings = Count(wire.setting.size());
  return wire;
}

NodeStatusMessage FromWire(const lcmt_node_status& wire, const Field& at) {
  NodeStatusMessage status;
  status.utime = wire.utime;
  status.start_utime = wire.start_utime;
  try {
    RequireNodeName(wire.name);
  } catch (const InputError& error) {
    at("name").Fail(error.what());
  }
  status.name = wire.name;
  status.kind = EnumOf<NodeKind>(wire.kind, at("kind"));
  status.busy = Bool(wire.state, at("state"));
  status.request_id = wire.request_id;
  status.host = wire.host;
  status.pid = wire.pid;
  status.version = wire.version;
  status.commit = wire.commit;
  status.robot_name = wire.robot_name;
  status.robot_id = wire.robot_id;
  status.algorithm = wire.algorithm;
  status.planner_class = wire.planner_class;
  status.can_backward = Bool(wire.can_backward, at("can_backward"));
  status.can_anytime = Bool(wire.can_anytime, at("can_anytime"));
  status.collision_models = Names(wire.collision_model, at, "collision_model");
  status.settings = FromWire(wire.setting, at, "setting");
  return status;
}

}  // namespace wire

using wire::Field;

template <>
std::vector<std::uint8_t> Encode(const DiscoverMessage& message) {
  lcmt_discover wire{};
  wire.utime = NowUtime();
  wire.sender = message.sender;
  return wire::Pack(wire);
}

template <>
DiscoverMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  return {wire::Unpack<lcmt_discover>(bytes, channel).sender};
}

template <>
std::vector<std::uint8_t> Encode(const NodeStatusMessage& message) {
  return wire::Pack(wire::ToWire(message));
}

template <>
NodeStatusMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto message = wire::Unpack<lcmt_node_status>(bytes, channel);
  return wire::FromWire(message, Field(channel, message.request_id));
}

template <>
std::vector<std::uint8_t> Encode(const ProblemSetsMessage& message) {
  lcmt_problem_sets wire{};
  wire.utime = NowUtime();
  wire.server = message.server;
  wire.robot_name = message.robot_name;
  wire.robot_id = message.robot_id;
  wire.edge_resolution_m = message.edge_resolution_m;
  wire.edge_check = EnumName(message.edge_check);
  wire.has_meshes = message.has_meshes;
  for (const ProblemSetSummary& set : message.sets) wire.set.push_back(wire::SetToWire(set));
  wire.num_sets = wire::Count(wire.set.size());
  return wire::Pack(wire);
}

template <>
ProblemSetsMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto wire = wire::Unpack<lcmt_problem_sets>(bytes, channel);
  const std::string no_request_id;
  const Field at(channel, no_request_id);
  ProblemSetsMessage message;
  message.server = wire::NotEmpty(wire.server, at("server"));
  message.robot_name = wire.robot_name;
  message.robot_id = wire.robot_id;
  message.edge_resolution_m = wire::Positive(wire.edge_resolution_m, at("edge_resolution_m"));
  message.edge_check = wire::Method(wire.edge_check, at("edge_check"));
  message.has_meshes = wire::Bool(wire.has_meshes, at("has_meshes"));
  for (std::size_t i = 0; i < wire.set.size(); ++i) {
    message.sets.push_back(wire::SetFromWire(wire.set[i], at("set", i)));
    for (std::size_t j = 0; j < i; ++j) {
      if (message.sets[j].name == wire.set[i].name) {
        at("set", i)("name").Fail(fmt::format("'{}' occurs twice", wire.set[i].name));
      }
    }
  }
  return message;
}

template <>
std::vector<std::uint8_t> Encode(const ProblemRequestMessage& message) {
  lcmt_problem_request wire{};
  wire.utime = NowUtime();
  wire.request_id = message.request_id;
  wire.problem_set = message.problem_set;
  wire.problem_index = message.problem_index;
  return wire::Pack(wire);
}

template <>
ProblemRequestMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto message = wire::Unpack<lcmt_problem_request>(bytes, channel);
  const Field at(channel, message.request_id);
  wire::AtLeast(0, message.problem_index, at("problem_index"));
  return {wire::NotEmpty(message.request_id, at("request_id")),
          wire::NotEmpty(message.problem_set, at("problem_set")), message.problem_index};
}

template <>
std::vector<std::uint8_t> Encode(const ProblemMessage& message) {
  lcmt_problem wire{};
  wire.utime = NowUtime();
  wire.request_id = message.request_id;
  wire.ok = message.ok;
  wire.message = message.message;
  wire.problem_set = message.problem_set;
  wire.problem_index = message.problem_index;
  wire.scene_id = message.scene_id;
  wire.group = message.group;
  wire.start = wire::ToWire(message.start);
  wire.goal = wire::ToWire(message.goal);
  wire.num_goals = wire::Count(wire.goal.size());
  wire.time_limit_s = message.time_limit_s;
  return wire::Pack(wire);
}

template <>
ProblemMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto wire = wire::Unpack<lcmt_problem>(bytes, channel);
  const Field at(channel, wire.request_id);
  ProblemMessage message;
  message.request_id = wire::NotEmpty(wire.request_id, at("request_id"));
  message.ok = wire::Bool(wire.ok, at("ok"));
  message.message = wire.message;
  message.problem_set = wire.problem_set;
  message.problem_index = wire.problem_index;
  message.scene_id = wire.scene_id;
  message.group = wire.group;
  message.start = wire::FromWire(wire.start, at("start"));
  message.goal = wire::FromWire(wire.goal, at, "goal");
  message.time_limit_s = wire::NonNegative(wire.time_limit_s, at("time_limit_s"));
  if (message.ok) {  // A refusal may leave these empty.
    wire::NotEmpty(message.problem_set, at("problem_set"));
    wire::AtLeast(0, message.problem_index, at("problem_index"));
    wire::NotEmpty(message.scene_id, at("scene_id"));
  }
  return message;
}

}  // namespace planbench
