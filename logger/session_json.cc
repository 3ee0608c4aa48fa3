#include "logger/session_json.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/error.h"
#include "common/write_file.h"
#include "logger/utc_time.h"

namespace planbench {
namespace {

// Keeps the order in which keys are written, for the reader's sake.
using Json = nlohmann::ordered_json;

std::string Dump(const Json& json, int indent) {
  // Text that is no UTF-8 (a host's name, a message) must not cost the file.
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json NodeJson(const NodeStatusMessage& node) {
  Json json;
  json["name"] = node.name;
  json["kind"] = EnumName(node.kind);
  json["version"] = node.version;
  json["commit"] = node.commit;
  json["host"] = node.host;
  json["pid"] = node.pid;
  json["instance"] = node.instance;
  json["start_time"] = IsoTime(node.start_utime);
  if (!node.robot_name.empty()) {
    json["robot"] = {{"name", node.robot_name}, {"id", node.robot_id}};
  }
  if (node.kind == NodeKind::kPlanner) {
    json["algorithm"] = node.algorithm;
    json["planner_class"] = node.planner_class;
    json["backward"] = node.can_backward;
    json["anytime"] = node.can_anytime;
    json["improve"] = node.can_improve;
    json["bidirectional"] = node.bidirectional;
    json["deterministic"] = node.deterministic;
    json["collision_models"] = node.collision_models;
  }
  json["settings"] = node.settings;
  return json;
}

}  // namespace

std::string SessionJson(const SessionMessage& session) {
  const PlanRequest& request = session.conditions.request;
  Json json;
  json["run_id"] = session.run_id;
  json["start_time"] = IsoTime(session.start_utime);
  json["finished"] = session.finished;
  json["total_time_s"] = session.total_time_s;
  json["num_runs"] = session.num_runs;
  json["version"] = session.version;
  json["commit"] = session.commit;
  json["host"] = session.host;
  json["cpu"] = session.cpu;
  json["seed"] = request.seed;
  json["time_limit_s"] = request.time_limit_s;
  json["robot"] = {{"name", session.robot_name}, {"id", request.robot_id}};
  json["flags"] = session.settings;
  json["left_out"] = session.left_out;
  json["contestants"] = Json::array();
  for (const Contestant& one : session.conditions.contestants) {
    json["contestants"].push_back(one.name);
  }
  json["nodes"] = Json::array();
  for (const NodeStatusMessage& node : session.nodes) json["nodes"].push_back(NodeJson(node));
  return Dump(json, -1);
}

std::string BusJson(const Bus::Counters& counters,
                    const std::vector<Contradictions::Entry>& contradictions) {
  if (counters.malformed + counters.lost + counters.dropped == 0 && contradictions.empty()) {
    return "";
  }
  Json json;
  json["malformed_packets"] = counters.malformed;
  json["lost_messages"] = counters.lost;
  json["dropped_messages"] = counters.dropped;
  json["contradictions"] = Json::array();
  for (const Contradictions::Entry& entry : contradictions) {
    json["contradictions"].push_back({{"sender", entry.sender},
                                      {"channel", entry.channel},
                                      {"count", entry.count},
                                      {"first", entry.what}});
  }
  return Dump(json, -1);
}

void WriteRunJson(const std::filesystem::path& file, const std::vector<std::string>& sessions,
                  int num_event_log_files, const std::string& bus) {
  Json json;
  json["sessions"] = Json::array();
  for (const std::string& session : sessions) json["sessions"].push_back(Json::parse(session));
  json["event_log_files"] = num_event_log_files;
  if (!bus.empty()) json["bus"] = Json::parse(bus);
  try {
    WriteFile(file, Dump(json, 2) + "\n");
  } catch (const InputError& error) {
    // A full disk, say, is no bad use, of which a logger that ends would not be started again.
    throw std::runtime_error(error.what());
  }
}

}  // namespace planbench
