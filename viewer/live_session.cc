#include "viewer/live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <span>
#include <string_view>

#include "common/error.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/node_registry.h"
#include "report/session_robot.h"
#include "report/view_data.h"

namespace planbench {
namespace {

constexpr std::size_t kRunsShown = 30;
constexpr std::size_t kImprovementsShown = 200;
/// More names than any session has are a stranger's.
constexpr std::size_t kMostNodes = 256;
constexpr std::size_t kScenesKept = 200;
constexpr int kFrames = 60;

constexpr std::string_view kRequestPrefix = "PLAN_REQUEST_";

/// Takes from the id of a request of the driver's (RUN/SET/INDEX/PLANNER/DIRECTION/TRIAL, for what,
/// '@' and what makes it unique) what it tells of the run. Others have ids of their own.
void ReadRequestId(const PlanRequest& request, RunRecordMessage* run) {
  static const std::regex form(
      "(.+)/([0-9]{1,9})/([^/]+)/[a-z]+/([0-9]{1,9})(/first-path)?@[^@/]*(/warm-up)?");
  const std::string prefix = request.run_id + "/";
  std::smatch parts;
  if (!request.request_id.starts_with(prefix)) return;
  const std::string rest = request.request_id.substr(prefix.size());
  if (!std::regex_match(rest, parts, form)) return;
  run->problem_set = parts[1];
  run->problem_index = std::stoi(parts[2]);
  run->planner = parts[3];
  run->trial = std::stoi(parts[4]);
  if (parts[5].matched) run->message = "a first path is being planned";
  if (parts[6].matched) run->message = "is being planned to warm up";
}

/// A number, or null where 0 means that there is none.
Json UnlessZero(double value) { return value == 0 ? Json() : Json(value); }

}  // namespace

LiveSession::LiveSession(std::filesystem::path robot_folder,
                         std::map<std::string, std::filesystem::path> packages)
    : robot_folder_(std::move(robot_folder)), packages_(std::move(packages)) {
  if (!robot_folder_.empty()) LoadedRobot();
}

void LiveSession::Hear(const ReceivedMessage& message, TimePoint now) {
  const std::string& name = message.channel;
  try {
    if (name == channel::kNodeStatus) {
      HearStatus(Decode<NodeStatusMessage>(message.bytes, name), now);
    } else if (name == channel::kSession) {
      auto session = Decode<SessionMessage>(message.bytes, name);
      if (!session_ || session_->run_id != session.run_id) {
        tallies_.clear();
        records_.clear();
        seen_.clear();
        robot_.reset();
        session_heard_ = now;
      }
      session_ = std::move(session);
    } else if (name == channel::kScene) {
      auto answer = Decode<SceneMessage>(message.bytes, name);
      if (!answer.ok) return;
      if (scenes_.size() >= kScenesKept) scenes_.clear();  // planners ask anew for what they lack
      scenes_.insert_or_assign(answer.scene_id, std::move(answer.scene));
      ++view_number_;
    } else if (name.starts_with(kRequestPrefix)) {
      HearRequest(Decode<PlanRequest>(message.bytes, name), name.substr(kRequestPrefix.size()));
    } else if (name.starts_with("PLAN_PROGRESS_")) {
      HearProgress(Decode<PlanProgressMessage>(message.bytes, name));
    } else if (name.starts_with("PLAN_RESULT_")) {
      HearResult(Decode<PlanResultMessage>(message.bytes, name));
    } else if (name == channel::kRunRecord) {
      HearRecord(Decode<RunRecordMessage>(message.bytes, name));
    }
  } catch (const MessageError&) {
    ++num_undecodable_;
  }
}

bool LiveSession::IsGone(const Node& node, TimePoint now) {
  return now - node.heard > NodeRegistry::kLostAfter;
}

void LiveSession::HearStatus(NodeStatusMessage status, TimePoint now) {
  if (status.kind == NodeKind::kSceneServer) {
    if (!scene_server_ || scene_server_->robot_id != status.robot_id) {
      robot_.reset();
      ++view_number_;
    }
    scene_server_ = status;
  }
  const std::pair key(status.kind, status.name);
  if (nodes_.size() >= kMostNodes && !nodes_.contains(key)) {
    std::erase_if(nodes_, [&](const auto& node) { return IsGone(node.second, now); });
    if (nodes_.size() >= kMostNodes) return;
  }
  nodes_.insert_or_assign(key, Node{std::move(status), now});
}

void LiveSession::HearRequest(const PlanRequest& request, const std::string& planner) {
  if (shown_ && shown_->request_id == request.request_id) return;  // repeated
  RunRecordMessage run;
  run.request_id = request.request_id;
  run.request = request;
  run.message = "is being planned";
  if (session_) run.run_id = session_->run_id;
  ReadRequestId(request, &run);
  run.contestant = ContestantOf(run.planner.empty() ? planner : run.planner);
  shown_ = std::move(run);
  is_answered_ = false;
  progress_.clear();
  progress_rule_ = {};
  ++view_number_;
}

void LiveSession::HearProgress(const PlanProgressMessage& progress) {
  if (!shown_ || shown_->request_id != progress.request_id || is_answered_) return;
  if (progress_rule_.Take(progress.progress).empty()) {
    progress_.push_back(progress.progress);
  } else {
    ++num_undecodable_;
  }
}

void LiveSession::HearResult(const PlanResultMessage& result) {
  if (!shown_ || shown_->request_id != result.request_id || is_answered_) return;
  is_answered_ = true;
  shown_->result = result;
  shown_->status = result.result.status;
  shown_->message = result.result.message;
  progress_ = result.result.progress;
  ++view_number_;
}

/// Its name in tables, or, if the session does not tell of it, as it stands.
std::string LiveSession::ContestantOf(const std::string& planner) const {
  if (!session_) return planner;
  for (const Contestant& one : session_->conditions.contestants) {
    if (one.planner == planner) return one.name;
  }
  return planner;
}

void LiveSession::HearRecord(const RunRecordMessage& record) {
  // Recorded runs are repeated until they are acknowledged; a request's messages carry the process
  // of the driver behind the run's id.
  const RunStanding standing = StandingOf(record);
  const auto [seen, is_new] = seen_.try_emplace(record.request_id);
  if (!is_new && !Replaces(standing, seen->second.standing)) return;
  const bool is_solved = record.status == PlanStatus::kSolved;
  std::erase_if(records_, [&](const auto& one) { return one.request_id == record.request_id; });
  auto& [num_runs, num_solved] = tallies_[record.contestant];
  num_runs += is_new;
  num_solved += static_cast<int>(is_solved) - static_cast<int>(seen->second.is_solved);
  seen->second = {standing, is_solved};
  records_.push_front(record);
  if (records_.size() > kRunsShown) records_.pop_back();
  shown_ = record;
  progress_ = record.result.result.progress;
  is_answered_ = true;
  shown_->request_id =
      record.result.request_id.empty() ? record.request_id : record.result.request_id;
  ++view_number_;
}

Json LiveSession::State(TimePoint now, const Bus::Counters& counters) const {
  Json json;
  if (session_) {
    json["session"] = {{"run_id", session_->run_id},
                       {"robot", session_->robot_name},
                       {"num_runs", session_->num_runs},
                       {"finished", session_->finished}};
  }
  json["contestants"] = Json::array();
  for (const auto& [name, tally] : tallies_) {
    json["contestants"].push_back(
        {{"name", name}, {"runs", tally.first}, {"solved", tally.second}});
  }
  json["nodes"] = Json::array();
  for (const auto& [key, node] : nodes_) {
    const bool is_gone = IsGone(node, now);
    if (is_gone && node.heard < session_heard_) continue;  // an earlier session's
    json["nodes"].push_back({{"name", node.status.name},
                             {"kind", EnumName(node.status.kind)},
                             {"busy", node.status.busy},
                             {"request", node.status.request_id},
                             {"host", node.status.host},
                             {"gone", is_gone}});
  }
  json["progress"] = Json::array();
  const std::size_t num_shown = std::min(progress_.size(), kImprovementsShown);
  for (const PlanProgress& one : std::span(progress_).last(num_shown)) {
    json["progress"].push_back(
        {{"time_s", one.elapsed_s},
         {"cost", TellsCost(one.cost, one.epsilon) ? Json(one.cost) : Json()},
         {"bound", UnlessZero(one.epsilon)}});
  }
  json["runs"] = Json::array();
  for (const RunRecordMessage& record : records_) {
    const bool answered = record.status != PlanStatus::kNoAnswer;
    json["runs"].push_back(
        {{"contestant", record.contestant},
         {"problem", fmt::format("{} {}", record.problem_set, record.problem_index)},
         {"status", EnumName(record.status)},
         {"reason", record.message},
         {"time_s", answered ? Json(record.result.result.planning_time_s) : Json()}});
  }
  json["lost"] = counters.lost;
  json["dropped"] = counters.dropped;
  json["malformed"] = counters.malformed;
  json["undecodable"] = num_undecodable_;
  return json;
}

const ShownRobot& LiveSession::LoadedRobot() const {
  if (robot_) return *robot_;
  SessionMessage session = session_.value_or(SessionMessage());
  if (scene_server_) session.nodes.push_back(*scene_server_);
  robot_ = std::make_unique<const ShownRobot>(LoadSessionRobot(session, robot_folder_, packages_),
                                              session.conditions.mesh_robot_id);
  return *robot_;
}

std::optional<Json> LiveSession::View() const {
  if (!shown_) return std::nullopt;
  const auto scene = scenes_.find(shown_->request.scene_id);
  if (scene == scenes_.end()) {
    return Json{{"message",
                 "The scene has not been heard. If it was sent before this viewer listened, the "
                 "next problem is the first that is shown."}};
  }
  try {
    return is_answered_ ? RunView(LoadedRobot(), scene->second, *shown_, kFrames)
                        : RequestView(LoadedRobot(), scene->second, *shown_);
  } catch (const InputError& error) {
    return Json{{"message", error.what()}};
  }
}

}  // namespace planbench
