#include "messaging/planner_node.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "common/error.h"

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kSceneRequestPeriod{250};

}  // namespace

PlannerNode::PlannerNode(Bus* bus, const std::string& name, std::unique_ptr<Planner> planner,
                         const std::vector<CollisionModel>& models, const std::string& program,
                         std::chrono::milliseconds scene_timeout)
    : bus_(bus),
      name_(name),
      scene_timeout_(scene_timeout),
      channels_(name),
      planner_(std::move(planner)),
      description_(planner_->Describe()),
      unusable_models_(planner_->WarmUp(models)),
      status_(MakeNodeStatus(name, NodeKind::kPlanner)) {
  std::erase_if(description_.collision_models,
                [this](CollisionModel model) { return unusable_models_.contains(model); });
  std::vector<std::string> not_offered;  // though asked for
  for (const auto& [model, reason] : unusable_models_) {
    status_.unusable_models.emplace(EnumName(model), reason);
    if (std::find(models.begin(), models.end(), model) != models.end()) {
      not_offered.push_back(fmt::format("'{}': {}", EnumName(model), reason));
    }
  }
  if (description_.collision_models.empty()) {
    spdlog::error("no collision model can be used, and every request will be refused; {}",
                  fmt::join(not_offered, "; "));
  } else if (!not_offered.empty()) {
    spdlog::info("collision models that cannot be used: {}", fmt::join(not_offered, "; "));
  }
  status_.robot_name = planner_->robot().name;
  status_.robot_id = planner_->robot().content_id;
  status_.algorithm = description_.algorithm;
  status_.planner_class = EnumName(description_.planner_class);
  status_.can_backward = description_.backward;
  status_.can_anytime = description_.anytime;
  status_.can_improve = description_.improve;
  status_.bidirectional = description_.bidirectional;
  status_.deterministic = description_.deterministic;
  for (const CollisionModel model : description_.collision_models) {
    status_.collision_models.emplace_back(EnumName(model));
  }
  status_.settings = description_.settings;
  if (!program.empty()) status_.settings[kProgramSetting] = program;

  requests_ = bus->SubscribeFrom<PlanRequest>(
      channels_.request,
      [this](const PlanRequest& request, const Origin& origin) {
        OnRequest(request, origin.sender);
      },
      [this](const MessageError& error, const Origin&) { OnBadRequest(error); });
  scene_messages_ = bus->Subscribe<SceneMessage>(
      channel::kScene, [this](SceneMessage&& message) { OnScene(std::move(message)); },
      [this](const MessageError& error) { OnBadScene(error); });
  statuses_ = bus->SubscribeFrom<NodeStatusMessage>(
      channel::kNodeStatus, [this](const NodeStatusMessage& status, const Origin& origin) {
        OnStatus(status, origin.sender);
      });
  cancels_ = bus->SubscribeFrom<PlanCancelMessage>(
      channels_.cancel, [this](const PlanCancelMessage& message, const Origin& origin) {
        OnCancel(message, origin.sender);
      });
  announcer_ = std::make_unique<NodeAnnouncer>(bus, [this] { return Status(); });
  // Last: it may not be left running if the rest cannot be made.
  solver_ = std::thread([this] { Solve(); });
}

PlannerNode::~PlannerNode() {
  requests_ = Subscription();
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    if (job_) job_->control.cancelled = true;
  }
  changed_.notify_all();
  solver_.join();
}

void PlannerNode::Run(const std::function<bool()>& stop) {
  while (!stop()) {
    {
      const std::scoped_lock lock(mutex_);
      AskForScene();
    }
    announcer_->ThrowIfDisplaced();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

NodeStatusMessage PlannerNode::Status() const {
  NodeStatusMessage status = status_;
  const std::scoped_lock lock(mutex_);
  status.busy = job_ != nullptr;
  if (job_) status.request_id = job_->request.request_id;
  return status;
}

std::string PlannerNode::ReasonToRefuse(const PlanRequest& request) const {
  const Robot& robot = planner_->robot();
  if (!request.robot_id.empty() && request.robot_id != robot.content_id) {
    return "the request is for another robot description (" + request.robot_id + ") than '" +
           robot.name + "' here (" + robot.content_id + ")";
  }
  if (std::find(description_.collision_models.begin(), description_.collision_models.end(),
                request.collision_model) == description_.collision_models.end()) {
    const auto unusable = unusable_models_.find(request.collision_model);
    return fmt::format("the collision model '{}' is not offered here{}",
                       EnumName(request.collision_model),
                       unusable == unusable_models_.end() ? "" : ": " + unusable->second);
  }
  if (request.direction == Direction::kBackward && !description_.backward) {
    return description_.algorithm + " cannot search backward";
  }
  if (request.anytime && !description_.anytime) {
    return description_.algorithm + " is no anytime planner";
  }
  if (!request.initial_path.empty() && !description_.improve) {
    return description_.algorithm + " does not improve paths";
  }
  return "";
}

void PlannerNode::Acknowledge(const std::string& request_id, PlanAckVerdict verdict,
                              const std::string& message) {
  bus_->Publish(channels_.ack, PlanAckMessage{name_, request_id, verdict, message});
}

bool PlannerNode::SendResultOf(const std::string& request_id) {
  const std::vector<std::uint8_t>* result = results_.Find(request_id);
  if (result != nullptr) bus_->PublishBytes(channels_.result, *result);
  return result != nullptr;
}

void PlannerNode::OnRequest(const PlanRequest& request, const PacketSender& sender) {
  std::unique_lock lock(mutex_);
  if (SendResultOf(request.request_id)) return;
  if (job_ && job_->request.request_id == request.request_id) {
    Acknowledge(request.request_id, PlanAckVerdict::kWorking, "");
    return;
  }
  if (job_) {
    Acknowledge(request.request_id, PlanAckVerdict::kBusy,
                "working on " + job_->request.request_id);
    return;
  }
  if (const std::string reason = ReasonToRefuse(request); !reason.empty()) {
    Acknowledge(request.request_id, PlanAckVerdict::kRefused, reason);
    return;
  }
  auto job = std::make_unique<Job>();
  job->request = request;
  job->sender = sender;
  job->num_incomplete = bus_->counters().incomplete;
  job->accepted = Clock::now();
  job->next_scene_request = job->accepted;
  for (const auto& [id, scene] : scenes_) {
    if (id == request.scene_id) job->scene = scene;
  }
  job_ = std::move(job);
  AskForScene();
  lock.unlock();
  changed_.notify_all();
  // Last: the driver waits for the result, not for this.
  Acknowledge(request.request_id, PlanAckVerdict::kWorking, "");
}

void PlannerNode::OnBadRequest(const MessageError& error) {
  const std::string& id = error.request_id();
  const std::scoped_lock lock(mutex_);
  // Of a request that was taken a spoiled copy, which anybody can send who hears it, changes
  // nothing.
  const bool is_taken = (job_ && job_->request.request_id == id) || results_.Find(id) != nullptr;
  if (id.empty() || is_taken) throw error;
  Acknowledge(id, PlanAckVerdict::kRefused, error.what());
}

void PlannerNode::OnScene(SceneMessage message) {
  const std::scoped_lock lock(mutex_);
  if (!message.ok) {
    if (job_ && !job_->scene && job_->request.scene_id == message.scene_id) {
      spdlog::warn("scene {}: {}", message.scene_id, message.message);
      job_->scene_fault = message.message;
    }
    return;
  }
  const bool known = std::any_of(scenes_.begin(), scenes_.end(), [&](const auto& entry) {
    return entry.first == message.scene_id;
  });
  if (known) return;
  const auto scene = std::make_shared<const Scene>(std::move(message.scene));
  scenes_.emplace_back(message.scene_id, scene);
  if (scenes_.size() > kSceneCacheSize) scenes_.pop_front();
  if (job_ && !job_->scene && job_->request.scene_id == message.scene_id) {
    job_->scene = scene;
    changed_.notify_all();
  }
}

void PlannerNode::OnBadScene(const MessageError& error) {
  {
    const std::scoped_lock lock(mutex_);
    if (job_ && error.request_id() == SceneRequestId()) job_->scene_fault = error.what();
  }
  throw error;
}

void PlannerNode::OnStatus(const NodeStatusMessage& status, const PacketSender& sender) {
  if (status.kind != NodeKind::kSceneServer) return;
  const std::scoped_lock lock(mutex_);
  scene_server_ = fmt::format("{} ({})", status.host, sender.Text());
  scene_server_heard_ = Clock::now();
}

void PlannerNode::OnCancel(const PlanCancelMessage& message, const PacketSender& sender) {
  const std::scoped_lock lock(mutex_);
  if (job_ && job_->request.request_id == message.request_id) {
    if (!(job_->sender == sender)) {
      bus_->contradictions().Note(sender, channels_.cancel,
                                  "cancels a request that is " + job_->sender.Text() + "'s");
      return;
    }
    job_->control.cancelled = true;
    changed_.notify_all();
  } else {
    SendResultOf(message.request_id);  // lost, or on its way
  }
}

void PlannerNode::Solve() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(
        lock, [this] { return stopping_ || (job_ && (job_->scene || job_->control.cancelled)); });
    if (stopping_) return;
    if (!job_->scene) {
      FinishWithoutScene(PlanStatus::kCancelled, "cancelled while waiting for the scene");
      continue;
    }
    // Only this thread takes the job away, so it may be used without the lock.
    Job& job = *job_;
    job.control.on_progress = [&](const PlanProgress& progress) {
      bus_->Publish(channels_.progress,
                    PlanProgressMessage{name_, job.request.request_id, progress});
    };
    lock.unlock();
    PlanResult result = planner_->Plan(job.request, *job.scene, &job.control);
    const bool is_whole = !job.control.cancelled;
    const std::string request_id = job.request.request_id;
    lock.lock();
    // What this process cut short because it ends is no answer, though there may be a path in hand.
    if (stopping_ && !is_whole) return;
    Finish(result);
    lock.unlock();
    // After the result is out: writing takes time.
    spdlog::info("{}: {} in {:.3f} ms{}{}", request_id, EnumName(result.status),
                 result.planning_time_s * 1e3, result.message.empty() ? "" : ": ", result.message);
    lock.lock();
  }
}

void PlannerNode::Finish(PlanResult result) {
  PlanResultMessage message;
  message.planner = name_;
  message.run_id = job_->request.run_id;
  message.request_id = job_->request.request_id;
  if (!result.path.empty()) {
    for (const JointSpace::Joint& joint :
         planner_->robot().Group(job_->request.group).space.joints()) {
      message.joint_names.push_back(joint.name);
    }
  }
  message.result = std::move(result);
  job_.reset();
  bus_->PublishBytes(channels_.result, results_.Add(message.request_id, Encode(message)));
}

std::string PlannerNode::SceneRequestId() const { return name_ + "/" + job_->request.request_id; }

std::string PlannerNode::WhoWasHeard() const {
  if (scene_server_heard_ < job_->accepted) return ", nor was a scene server heard";
  return fmt::format(
      ", though the scene server on {} was heard: either it does not hear this process (ttl=0 in "
      "this one's --lcm-url, a firewall), or large messages are lost on the way, as where MTUs "
      "differ; bus_doctor on both machines tells their MTUs, and what else is wrong",
      scene_server_);
}

void PlannerNode::FinishWithoutScene(PlanStatus status, std::string message) {
  const std::int64_t num_incomplete = bus_->counters().incomplete - job_->num_incomplete;
  if (!job_->scene_fault.empty()) message += ": " + job_->scene_fault;
  if (num_incomplete > 0) {
    message += fmt::format(
        "; meanwhile {} large messages came in part only: receive buffers are too small "
        "(recv_buf_size of --lcm-url, net.core.rmem_max)",
        num_incomplete);
  } else if (status != PlanStatus::kCancelled && job_->scene_fault.empty()) {
    message += WhoWasHeard();
  }
  PlanResult result;
  result.status = status;
  result.message = std::move(message);
  Finish(std::move(result));
}

void PlannerNode::AskForScene() {
  const Clock::time_point now = Clock::now();
  if (!job_ || job_->scene || job_->control.cancelled) return;
  if (now - job_->accepted > scene_timeout_) {
    FinishWithoutScene(PlanStatus::kInvalidRequest,
                       fmt::format("no scene within {:g} s",
                                   std::chrono::duration<double>(scene_timeout_).count()));
  } else if (now >= job_->next_scene_request) {
    bus_->Publish(channel::kSceneRequest,
                  SceneRequestMessage{SceneRequestId(), job_->request.scene_id});
    job_->next_scene_request = now + kSceneRequestPeriod;
  }
}

}  // namespace planbench
