#include <fmt/format.h>

#include "messaging/wire.h"
#include "planbench/lcmt_ack.hpp"
#include "planbench/lcmt_named_value.hpp"
#include "planbench/lcmt_plan_ack.hpp"
#include "planbench/lcmt_plan_cancel.hpp"
#include "planbench/lcmt_plan_progress.hpp"

namespace planbench {
namespace wire {
namespace {

lcmt_plan_progress ProgressToWire(const std::string& planner, const std::string& request_id,
                                  const PlanProgress& progress) {
  lcmt_plan_progress wire{};
  wire.utime = NowUtime();
  wire.planner = planner;
  wire.request_id = request_id;
  wire.elapsed_s = progress.elapsed_s;
  wire.epsilon = progress.epsilon;
  wire.cost = progress.cost;
  wire.expansions = progress.expansions;
  return wire;
}

PlanProgress ProgressFromWire(const lcmt_plan_progress& wire, const Field& at) {
  PlanProgress progress;
  progress.elapsed_s = NonNegative(wire.elapsed_s, at("elapsed_s"));
  progress.epsilon = NonNegative(wire.epsilon, at("epsilon"));
  progress.cost = Finite(wire.cost, at("cost"));
  progress.expansions = AtLeast(0, wire.expansions, at("expansions"));
  return progress;
}

}  // namespace

lcmt_plan_request ToWire(const PlanRequest& request) {
  lcmt_plan_request wire{};
  wire.utime = NowUtime();
  wire.run_id = request.run_id;
  wire.request_id = request.request_id;
  wire.scene_id = request.scene_id;
  wire.robot_id = request.robot_id;
  wire.group = request.group;
  wire.start = ToWire(request.start);
  wire.goal = ToWire(request.goal);
  wire.num_goals = Count(wire.goal.size());
  wire.direction = static_cast<std::int8_t>(request.direction);
  wire.time_limit_s = request.time_limit_s;
  wire.seed = static_cast<std::int64_t>(request.seed);
  wire.collision_model = EnumName(request.collision_model);
  wire.edge_resolution_m = request.edge_resolution_m;
  if (request.edge_check) wire.edge_check = EnumName(*request.edge_check);
  wire.anytime = request.anytime;
  wire.simplify = request.simplify;
  wire.parameter = ToWire(request.parameters);
  wire.num_parameters = Count(wire.parameter.size());
  return wire;
}

PlanRequest FromWire(const lcmt_plan_request& wire, const Field& at) {
  PlanRequest request;
  request.run_id = wire.run_id;
  request.request_id = wire.request_id;
  request.scene_id = wire.scene_id;
  request.robot_id = wire.robot_id;
  request.group = wire.group;
  request.start = FromWire(wire.start, at("start"));
  request.goal = FromWire(wire.goal, at, "goal");
  request.direction = EnumOf<Direction>(wire.direction, at("direction"));
  request.time_limit_s = NonNegative(wire.time_limit_s, at("time_limit_s"));
  request.seed = static_cast<std::uint64_t>(wire.seed);
  request.collision_model = Model(wire.collision_model, at("collision_model"));
  request.edge_resolution_m = NonNegative(wire.edge_resolution_m, at("edge_resolution_m"));
  if (!wire.edge_check.empty()) request.edge_check = Method(wire.edge_check, at("edge_check"));
  request.anytime = Bool(wire.anytime, at("anytime"));
  request.simplify = Bool(wire.simplify, at("simplify"));
  request.parameters = FromWire(wire.parameter, at, "parameter");
  return request;
}

lcmt_plan_result ToWire(const PlanResultMessage& message) {
  const PlanResult& result = message.result;
  lcmt_plan_result wire{};
  wire.utime = NowUtime();
  wire.planner = message.planner;
  wire.run_id = message.run_id;
  wire.request_id = message.request_id;
  wire.status = static_cast<std::int8_t>(result.status);
  wire.message = result.message;
  wire.planning_time_s = result.planning_time_s;
  wire.total_time_s = result.total_time_s;
  wire.setup_s = result.phases.setup_s;
  wire.collision_s = result.phases.collision_s;
  wire.guidance_s = result.phases.guidance_s;
  wire.search_s = result.phases.search_s;
  wire.simplification_s = result.phases.simplification_s;
  wire.path = ToWire(message.joint_names, result.path);
  wire.simplified_path = ToWire(message.joint_names, result.simplified_path);
  wire.epsilon = result.epsilon;
  wire.cost = result.cost;
  for (const PlanProgress& progress : result.progress) {
    wire.progress.push_back(ProgressToWire(message.planner, message.request_id, progress));
  }
  wire.num_progress = Count(wire.progress.size());
  for (const auto& [name, value] : result.counters) {
    wire.counter.emplace_back();
    wire.counter.back().name = name;
    wire.counter.back().value = value;
  }
  wire.num_counters = Count(wire.counter.size());
  wire.peak_memory_mb = result.peak_memory_mb;
  return wire;
}

PlanResultMessage FromWire(const lcmt_plan_result& wire, const Field& at) {
  PlanResultMessage message;
  message.planner = wire.planner;
  message.run_id = wire.run_id;
  message.request_id = wire.request_id;
  PlanResult& result = message.result;
  result.status = EnumOf<PlanStatus>(wire.status, at("status"));
  result.message = wire.message;
  result.planning_time_s = NonNegative(wire.planning_time_s, at("planning_time_s"));
  result.total_time_s = NonNegative(wire.total_time_s, at("total_time_s"));
  result.phases.setup_s = NonNegative(wire.setup_s, at("setup_s"));
  result.phases.collision_s = NonNegative(wire.collision_s, at("collision_s"));
  result.phases.guidance_s = NonNegative(wire.guidance_s, at("guidance_s"));
  result.phases.search_s = NonNegative(wire.search_s, at("search_s"));
  result.phases.simplification_s = NonNegative(wire.simplification_s, at("simplification_s"));
  NamedPath path = FromWire(wire.path, at("path"));
  NamedPath simplified = FromWire(wire.simplified_path, at("simplified_path"));
  if (!simplified.path.empty() && simplified.joint_names != path.joint_names) {
    at("simplified_path")("joint_name").Fail("other joints than those of path");
  }
  message.joint_names = std::move(path.joint_names);
  result.path = std::move(path.path);
  result.simplified_path = std::move(simplified.path);
  result.epsilon = NonNegative(wire.epsilon, at("epsilon"));
  result.cost = Finite(wire.cost, at("cost"));
  for (std::size_t i = 0; i < wire.progress.size(); ++i) {
    result.progress.push_back(ProgressFromWire(wire.progress[i], at("progress", i)));
  }
  for (std::size_t i = 0; i < wire.counter.size(); ++i) {
    const lcmt_named_value& counter = wire.counter[i];
    const Field where = at("counter", i);
    NotEmpty(counter.name, where("name"));
    if (!result.counters.emplace(counter.name, Finite(counter.value, where("value"))).second) {
      where("name").Fail(fmt::format("'{}' occurs twice", counter.name));
    }
  }
  result.peak_memory_mb = NonNegative(wire.peak_memory_mb, at("peak_memory_mb"));
  return message;
}

}  // namespace wire

using wire::Field;

template <>
std::vector<std::uint8_t> Encode(const PlanRequest& message) {
  return wire::Pack(wire::ToWire(message));
}

template <>
PlanRequest Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto message = wire::Unpack<lcmt_plan_request>(bytes, channel);
  const Field at(channel, message.request_id);
  wire::NotEmpty(message.request_id, at("request_id"));
  wire::NotEmpty(message.scene_id, at("scene_id"));
  return wire::FromWire(message, at);
}

template <>
std::vector<std::uint8_t> Encode(const PlanAckMessage& message) {
  lcmt_plan_ack wire{};
  wire.utime = NowUtime();
  wire.planner = message.planner;
  wire.request_id = message.request_id;
  wire.verdict = static_cast<std::int8_t>(message.verdict);
  wire.message = message.message;
  return wire::Pack(wire);
}

template <>
PlanAckMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto message = wire::Unpack<lcmt_plan_ack>(bytes, channel);
  const Field at(channel, message.request_id);
  return {message.planner, wire::NotEmpty(message.request_id, at("request_id")),
          wire::EnumOf<PlanAckVerdict>(message.verdict, at("verdict")), message.message};
}

template <>
std::vector<std::uint8_t> Encode(const PlanProgressMessage& message) {
  return wire::Pack(wire::ProgressToWire(message.planner, message.request_id, message.progress));
}

template <>
PlanProgressMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto message = wire::Unpack<lcmt_plan_progress>(bytes, channel);
  const Field at(channel, message.request_id);
  return {message.planner, wire::NotEmpty(message.request_id, at("request_id")),
          wire::ProgressFromWire(message, at)};
}

template <>
std::vector<std::uint8_t> Encode(const PlanResultMessage& message) {
  return wire::Pack(wire::ToWire(message));
}

template <>
PlanResultMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto message = wire::Unpack<lcmt_plan_result>(bytes, channel);
  const Field at(channel, message.request_id);
  wire::NotEmpty(message.request_id, at("request_id"));
  return wire::FromWire(message, at);
}

template <>
std::vector<std::uint8_t> Encode(const PlanCancelMessage& message) {
  lcmt_plan_cancel wire{};
  wire.utime = NowUtime();
  wire.request_id = message.request_id;
  return wire::Pack(wire);
}

template <>
PlanCancelMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto message = wire::Unpack<lcmt_plan_cancel>(bytes, channel);
  const Field at(channel, message.request_id);
  return {wire::NotEmpty(message.request_id, at("request_id"))};
}

template <>
std::vector<std::uint8_t> Encode(const AckMessage& message) {
  lcmt_ack wire{};
  wire.utime = NowUtime();
  wire.id = message.id;
  wire.sender = message.sender;
  wire.ok = message.ok;
  wire.message = message.message;
  return wire::Pack(wire);
}

template <>
AckMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto message = wire::Unpack<lcmt_ack>(bytes, channel);
  const std::string no_request_id;
  const Field at(channel, no_request_id);
  return {wire::NotEmpty(message.id, at("id")), message.sender, wire::Bool(message.ok, at("ok")),
          message.message};
}

}  // namespace planbench
