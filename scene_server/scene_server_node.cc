#include "scene_server/scene_server_node.h"

#include <chrono>
#include <cstdint>
#include <thread>
#include <tuple>

#include "common/error.h"
#include "common/utime.h"
#include "messaging/channels.h"
#include "messaging/codec.h"

namespace planbench {
namespace {

constexpr std::chrono::seconds kProblemSetsPeriod{1};
constexpr std::chrono::milliseconds kStopPeriod{50};
/// A status older than this is no sign of life but part of a recording that is played back.
constexpr std::int64_t kStaleAfterUs = 10'000'000;

NodeStatusMessage StatusOf(const std::string& name, const SceneService& service) {
  NodeStatusMessage status = MakeNodeStatus(name, NodeKind::kSceneServer);
  status.robot_name = service.robot().name;
  status.robot_id = service.robot().content_id;
  for (const CollisionModel model : EnumValues<CollisionModel>()) {
    status.collision_models.emplace_back(EnumName(model));
  }
  status.settings["robot"] = service.robot().folder.string();
  if (service.mesh_robot()) {
    status.settings["referee_robot"] = service.mesh_robot()->folder.string();
  }
  return status;
}

}  // namespace

SceneServerNode::SceneServerNode(Bus* bus, const std::string& name, SceneService* service)
    : bus_(bus),
      status_(StatusOf(name, *service)),
      problem_sets_(service->ProblemSets(name)),
      problems_(bus, channel::kProblemRequest, channel::kProblem,
                [bus, service](const ProblemRequestMessage& request) {
                  const ProblemAnswer answer = service->AnswerProblem(request);
                  if (answer.scene) bus->Publish(channel::kScene, *answer.scene);
                  return answer.problem;
                }),
      scenes_(
          bus, channel::kSceneRequest, channel::kScene,
          [service](const SceneRequestMessage& request) { return service->AnswerScene(request); }),
      collisions_(bus, channel::kCollisionRequest, channel::kCollisionReply,
                  [service](const CollisionRequestMessage& request) {
                    return service->AnswerCollision(request);
                  }),
      path_checks_(bus, channel::kPathCheckRequest, channel::kPathCheckReply,
                   [service](const PathCheckRequestMessage& request) {
                     return service->AnswerPathCheck(request);
                   }),
      statuses_(bus->Subscribe<NodeStatusMessage>(
          channel::kNodeStatus, [this](const NodeStatusMessage& other) { OnStatus(other); })),
      announcer_(
          bus, [status = status_] { return status; }, [this] { PublishProblemSets(); }) {}

void SceneServerNode::Run(const std::function<bool()>& stop) {
  auto next_announcement = std::chrono::steady_clock::now();
  while (!stop()) {
    announcer_.ThrowIfDisplaced();
    ThrowIfNotAlone();
    if (std::chrono::steady_clock::now() >= next_announcement) {
      PublishProblemSets();
      next_announcement += kProblemSetsPeriod;
    }
    std::this_thread::sleep_for(kStopPeriod);
  }
}

void SceneServerNode::PublishProblemSets() { bus_->Publish(channel::kProblemSets, problem_sets_); }

void SceneServerNode::OnStatus(const NodeStatusMessage& other) {
  // Of the same name: the announcer's business.
  if (other.kind != NodeKind::kSceneServer || other.name == status_.name) return;
  const bool replayed = NowUtime() - other.utime > kStaleAfterUs;
  if (replayed ||
      std::tie(other.start_utime, other.name) > std::tie(status_.start_utime, status_.name)) {
    return;
  }
  const std::scoped_lock lock(mutex_);
  older_server_ = other.name;
}

void SceneServerNode::ThrowIfNotAlone() const {
  const std::scoped_lock lock(mutex_);
  if (older_server_.empty()) return;
  throw InputError("another scene server, '" + older_server_ +
                   "', is live on this bus; give it all folders of problems, or choose another "
                   "port with --lcm-url");
}

}  // namespace planbench
