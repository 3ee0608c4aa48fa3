#include "messaging/wire.h"
#include "planbench/lcmt_run_record.hpp"
#include "planbench/lcmt_session.hpp"

namespace planbench {

using wire::Field;

template <>
std::vector<std::uint8_t> Encode(const SessionMessage& message) {
  lcmt_session wire{};
  wire.utime = NowUtime();
  wire.run_id = message.run_id;
  wire.start_utime = message.start_utime;
  wire.finished = message.finished;
  wire.total_time_s = message.total_time_s;
  wire.num_runs = message.num_runs;
  wire.version = message.version;
  wire.commit = message.commit;
  wire.host = message.host;
  wire.cpu = message.cpu;
  wire.time_limit_s = message.time_limit_s;
  wire.seed = static_cast<std::int64_t>(message.seed);
  wire.robot_name = message.robot_name;
  wire.robot_id = message.robot_id;
  wire.setting = wire::ToWire(message.settings);
  wire.num_settings = wire::Count(wire.setting.size());
  for (const NodeStatusMessage& node : message.nodes) wire.node.push_back(wire::ToWire(node));
  wire.num_nodes = wire::Count(wire.node.size());
  return wire::Pack(wire);
}

template <>
SessionMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto wire = wire::Unpack<lcmt_session>(bytes, channel);
  const std::string no_request_id;
  const Field at(channel, no_request_id);
  SessionMessage message;
  message.run_id = wire::NotEmpty(wire.run_id, at("run_id"));
  message.start_utime = wire.start_utime;
  message.finished = wire::Bool(wire.finished, at("finished"));
  message.total_time_s = wire::NonNegative(wire.total_time_s, at("total_time_s"));
  message.num_runs = static_cast<int>(wire::AtLeast(0, wire.num_runs, at("num_runs")));
  message.version = wire.version;
  message.commit = wire.commit;
  message.host = wire.host;
  message.cpu = wire.cpu;
  message.time_limit_s = wire::NonNegative(wire.time_limit_s, at("time_limit_s"));
  message.seed = static_cast<std::uint64_t>(wire.seed);
  message.robot_name = wire.robot_name;
  message.robot_id = wire.robot_id;
  message.settings = wire::FromWire(wire.setting, at, "setting");
  for (std::size_t i = 0; i < wire.node.size(); ++i) {
    message.nodes.push_back(wire::FromWire(wire.node[i], at("node", i)));
  }
  return message;
}

template <>
std::vector<std::uint8_t> Encode(const RunRecordMessage& message) {
  lcmt_run_record wire{};
  wire.utime = NowUtime();
  wire.run_id = message.run_id;
  wire.request_id = message.request_id;
  wire.planner = message.planner;
  wire.algorithm = message.algorithm;
  wire.planner_class = message.planner_class;
  wire.setting = wire::ToWire(message.settings);
  wire.num_settings = wire::Count(wire.setting.size());
  wire.problem_set = message.problem_set;
  wire.problem_index = message.problem_index;
  wire.trial = message.trial;
  wire.start_utime = message.start_utime;
  wire.status = static_cast<std::int8_t>(message.status);
  wire.message = message.message;
  wire.roundtrip_time_s = message.roundtrip_time_s;
  wire.request = wire::ToWire(message.request);
  wire.result = wire::ToWire(message.result);
  wire.path_check = wire::ToWire(message.path_check);
  wire.simplified_check = wire::ToWire(message.simplified_check);
  return wire::Pack(wire);
}

template <>
RunRecordMessage Decode(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const auto wire = wire::Unpack<lcmt_run_record>(bytes, channel);
  const Field at(channel, wire.request_id);
  RunRecordMessage message;
  message.run_id = wire::NotEmpty(wire.run_id, at("run_id"));
  message.request_id = wire::NotEmpty(wire.request_id, at("request_id"));
  message.planner = wire::NotEmpty(wire.planner, at("planner"));
  message.algorithm = wire.algorithm;
  message.planner_class = wire.planner_class;
  message.settings = wire::FromWire(wire.setting, at, "setting");
  message.problem_set = wire.problem_set;
  message.problem_index =
      static_cast<int>(wire::AtLeast(0, wire.problem_index, at("problem_index")));
  message.trial = static_cast<int>(wire::AtLeast(1, wire.trial, at("trial")));
  message.start_utime = wire.start_utime;
  message.status = wire::EnumOf<PlanStatus>(wire.status, at("status"));
  message.message = wire.message;
  message.roundtrip_time_s = wire::NonNegative(wire.roundtrip_time_s, at("roundtrip_time_s"));
  message.request = wire::FromWire(wire.request, at("request"));
  message.result = wire::FromWire(wire.result, at("result"));
  message.path_check = wire::FromWire(wire.path_check, at("path_check"));
  message.simplified_check = wire::FromWire(wire.simplified_check, at("simplified_check"));
  return message;
}

}  // namespace planbench
