#include "tests/benchmark_driver/fake_nodes.h"

#include <gtest/gtest.h>

#include <utility>

#include "messaging/asked_runs.h"

namespace planbench {
namespace {

NodeStatusMessage SceneServerStatus(const std::map<std::string, std::string>& settings) {
  NodeStatusMessage status = MakeNodeStatus("scene_server", NodeKind::kSceneServer);
  status.settings = settings;
  return status;
}

}  // namespace

Path FakePath() { return {{0, 0}, {1, 0.5}}; }

FakePlanner::FakePlanner(Bus* bus, const std::string& name)
    : status(MakeNodeStatus(name, NodeKind::kPlanner)),
      bus_(bus),
      channels_(name),
      handler_([this](const PlanRequest& request) { Solve(request); }),
      requests_(bus, channels_.request),
      cancels_(bus, channels_.cancel),
      subscription_(
          bus->Subscribe<PlanRequest>(channels_.request, [this](const PlanRequest& request) {
            const std::scoped_lock lock(mutex_);
            handler_(request);
          })) {
  status.robot_name = "robot";
  status.robot_id = kFakeRobotId;
  status.algorithm = "Fake*";
  status.planner_class = "sample-then-search";
  status.can_backward = true;
  status.collision_models = {"spheres"};
  status.settings = {{"step", "5"}};
  announcer_ = std::make_unique<NodeAnnouncer>(bus_, [now = status] { return now; });
}

void FakePlanner::OnRequest(std::function<void(const PlanRequest&)> handler) {
  const std::scoped_lock lock(mutex_);
  handler_ = std::move(handler);
}

void FakePlanner::Acknowledge(const PlanRequest& request, PlanAckVerdict verdict,
                              const std::string& message) {
  bus_->Publish(channels_.ack, PlanAckMessage{status.name, request.request_id, verdict, message});
}

void FakePlanner::SendResult(const std::string& request_id, PlanResult result) {
  PlanResultMessage message;
  message.planner = status.name;
  message.run_id = "run";
  message.request_id = request_id;
  if (!result.path.empty()) message.joint_names = {"a", "b"};
  message.result = std::move(result);
  bus_->Publish(channels_.result, message);
}

void FakePlanner::Solve(const PlanRequest& request) {
  SendResult(request.request_id, SolvedResult());
}

PlanResult FakePlanner::SolvedResult() {
  PlanResult result;
  result.status = PlanStatus::kSolved;
  result.planning_time_s = result.total_time_s = 1e-4;
  result.path = FakePath();
  return result;
}

void FakePlanner::Restart() {
  announcer_.reset();
  ++status.start_utime;
  status.instance += "+";
  announcer_ = std::make_unique<NodeAnnouncer>(bus_, [now = status] { return now; });
}

void Reannounce(NodeRegistry* registry, FakePlanner* planner) {
  planner->Restart();
  ASSERT_TRUE(registry->WaitUntil(
      [&] {
        const auto heard = registry->Find(planner->status.name, NodeKind::kPlanner);
        return heard && heard->instance == planner->status.instance;
      },
      kTestPatience));
}

FakeSceneServer::FakeSceneServer(Bus* bus, const std::map<std::string, std::string>& settings)
    : before_answers_([](const ProblemRequestMessage&) {}),
      judge_([](const PathCheckRequestMessage&) { return Verdict(true); }),
      problem_requests_(bus, channel::kProblemRequest),
      path_checks_(bus, channel::kPathCheckRequest),
      problems_(bus, channel::kProblemRequest, channel::kProblem,
                [this](const ProblemRequestMessage& request) {
                  if (request.problem_index > 3) throw InputError("no such problem");
                  std::unique_lock lock(mutex_);
                  const auto before_answer = before_answers_;
                  lock.unlock();
                  before_answer(request);
                  lock.lock();
                  const auto refused = refused_.find(request.problem_index);
                  if (refused != refused_.end()) throw InputError(refused->second);
                  ProblemMessage problem;
                  problem.problem_set = request.problem_set;
                  problem.problem_index = request.problem_index;
                  problem.scene_id = "scene-" + std::to_string(request.problem_index);
                  problem.group = "arm";
                  problem.start = {{"a", "b"}, {0, 0}};
                  problem.goal = {{"a", 1, 0, 0}, {"b", 0.5, 0, 0}};
                  problem.time_limit_s = 60;
                  alter_(&problem);
                  return problem;
                }),
      judgements_(bus, channel::kPathCheckRequest, channel::kPathCheckReply,
                  [this](const PathCheckRequestMessage& request) {
                    const std::scoped_lock lock(mutex_);
                    return judge_(request);
                  }),
      announcer_(
          bus, [status = SceneServerStatus(settings)] { return status; },
          [bus] {
            ProblemSetsMessage sets;
            sets.server = "scene_server";
            sets.robot_name = "robot";
            sets.robot_id = kFakeRobotId;
            sets.edge_resolution_m = 0.02;
            sets.sets = {{"cans", {1, 2, 3}, "cans-1"}};
            bus->Publish(channel::kProblemSets, sets);
          }) {}

void FakeSceneServer::RefuseProblem(int index, const std::string& reason) {
  const std::scoped_lock lock(mutex_);
  refused_[index] = reason;
}

void FakeSceneServer::BeforeAnswers(std::function<void(const ProblemRequestMessage&)> handler) {
  const std::scoped_lock lock(mutex_);
  before_answers_ = std::move(handler);
}

void FakeSceneServer::AlterProblems(std::function<void(ProblemMessage*)> alter) {
  const std::scoped_lock lock(mutex_);
  alter_ = std::move(alter);
}

void FakeSceneServer::ServeProblem(int index) {
  const std::scoped_lock lock(mutex_);
  refused_.erase(index);
}

void FakeSceneServer::OnPathCheck(
    std::function<PathCheckReplyMessage(const PathCheckRequestMessage&)> handler) {
  const std::scoped_lock lock(mutex_);
  judge_ = std::move(handler);
}

PathCheckReplyMessage FakeSceneServer::Verdict(bool valid, const std::string& reason) {
  PathCheckReplyMessage reply;
  reply.ok = true;
  reply.engine = "fake";
  reply.verdict.emplace();
  reply.verdict->valid = valid;
  reply.verdict->reason = reason;
  return reply;
}

FakeLogger::FakeLogger(Bus* bus, const std::string& name,
                       const std::function<void(NodeStatusMessage*)>& describe)
    : bus_(bus),
      name_(name),
      records_(bus, channel::kRunRecord),
      sessions_(bus, channel::kSession),
      record_subscription_(bus->Subscribe<RunRecordMessage>(channel::kRunRecord,
                                                            [this](const RunRecordMessage& record) {
                                                              Answer(channel::kRunRecordAck,
                                                                     RunRecordAckId(record));
                                                            })),
      session_subscription_(
          bus->Subscribe<SessionMessage>(channel::kSession, [this](const SessionMessage& session) {
            Answer(channel::kSessionAck, SessionAckId(session));
          })) {
  NodeStatusMessage status = MakeNodeStatus(name, NodeKind::kLogger);
  if (describe) describe(&status);
  announcer_ = std::make_unique<NodeAnnouncer>(bus, [this, status] {
    NodeStatusMessage now = status;
    if (troubled) now.trouble = "disk full";
    return now;
  });
}

void FakeLogger::Answer(const std::string& channel, const std::string& id) {
  if (troubled) return;
  if (num_to_ignore > 0) {
    --num_to_ignore;
    return;
  }
  bus_->Publish(channel, AckMessage{id, name_, !refuse, refuse ? "it is odd" : ""});
}

}  // namespace planbench
