#include "tests/faults/misbehaving_planner.h"

#include <stdexcept>
#include <utility>

#include "tests/support/wait_until.h"

namespace planbench {
namespace {

/// Of a run's request: <session>/<set>/<index>/...
int ProblemOf(const std::string& request_id) {
  const std::size_t set = request_id.find('/') + 1;
  const std::size_t index = request_id.find('/', set) + 1;
  return std::stoi(request_id.substr(index));
}

}  // namespace

MisbehavingPlanner::MisbehavingPlanner(const std::string& url,
                                       std::map<int, PlanResultMessage> paths_by_problem)
    : bus_(url), registry_(&bus_), paths_(std::move(paths_by_problem)) {
  bus_.Start();
  if (!registry_.WaitUntil([&] { return registry_.ProblemSets().has_value(); }, kTestPatience)) {
    throw std::runtime_error("no scene server came");
  }
  NodeStatusMessage status = MakeNodeStatus("mine", NodeKind::kPlanner);
  status.robot_id = registry_.ProblemSets()->robot_id;
  status.algorithm = "Mine";
  status.collision_models = {"spheres"};
  requests_ = bus_.Subscribe<PlanRequest>(
      channels_.request, [this](const PlanRequest& request) { OnRequest(request); });
  cancels_ =
      bus_.Subscribe<PlanCancelMessage>(channels_.cancel, [this](const PlanCancelMessage& cancel) {
        if (overdue_ && cancel.request_id == overdue_->request_id) {
          Answer(*overdue_, cancel.request_id);
        }
      });
  announcer_ = std::make_unique<NodeAnnouncer>(&bus_, [status] { return status; });
}

void MisbehavingPlanner::Answer(const PlanRequest& request, const std::string& request_id,
                                double time_s) {
  PlanResultMessage message;
  message.result.status = PlanStatus::kExhausted;
  const auto path = paths_.find(ProblemOf(request.request_id));
  if (path != paths_.end()) {
    message.joint_names = path->second.joint_names;
    message.result.path = path->second.result.path;
    message.result.status = PlanStatus::kSolved;
    // What differs from the true answer is no path from start to goal.
    if (time_s != kTime) message.result.path.pop_back();
  }
  message.planner = "mine";
  message.run_id = request.run_id;
  message.request_id = request_id;
  message.result.planning_time_s = message.result.total_time_s = time_s;
  bus_.Publish(channels_.result, message);
}

void MisbehavingPlanner::OnRequest(const PlanRequest& request) {
  const std::string& id = request.request_id;
  num_asked_ = late_ == id ? num_asked_ + 1 : 1;
  late_ = id;
  const auto acknowledge = [&](PlanAckVerdict verdict) {
    bus_.Publish(channels_.ack, PlanAckMessage{"mine", id, verdict, ""});
  };
  if (id.ends_with("/warm-up")) return Answer(request, id);
  switch (ProblemOf(id)) {
    case 1:
      acknowledge(PlanAckVerdict::kWorking);
      if (num_asked_ == 4) Answer(request, id);  // repeated every 0.25 s
      return;
    case 2:
      Answer(request, id);
      return Answer(request, id, 2 * kTime);
    case 3:
      Answer(request, id + "/another");
      return Answer(request, id);
    case 4:
      if (!paths_.contains(4)) return;
      overdue_ = request;
      return acknowledge(PlanAckVerdict::kWorking);
    case 5:
      if (num_asked_ < 4) return acknowledge(PlanAckVerdict::kBusy);
      return Answer(request, id);
    default:
      PlanRequest of_another = request;
      of_another.run_id = "another";
      return Answer(of_another, id);
  }
}

}  // namespace planbench
