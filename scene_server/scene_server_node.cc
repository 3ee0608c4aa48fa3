#include "scene_server/scene_server_node.h"

#include <chrono>
#include <thread>

#include "messaging/channels.h"
#include "planning/told_warnings.h"
#include "robot_model/referee_misfits.h"

namespace planbench {
namespace {

constexpr std::chrono::seconds kProblemSetsPeriod{1};
constexpr std::chrono::milliseconds kStopPeriod{50};

NodeStatusMessage StatusOf(const std::string& name, const SceneService& service) {
  NodeStatusMessage status = MakeNodeStatus(name, NodeKind::kSceneServer);
  status.robot_name = service.robot().name;
  status.robot_id = service.robot().content_id;
  for (const CollisionModel model : EnumValues<CollisionModel>()) {
    status.collision_models.emplace_back(EnumName(model));
  }
  status.settings["robot"] = service.robot().folder.string();
  if (!service.robot().spheres_file.empty()) {
    status.settings["spheres"] = service.robot().spheres_file.string();
  }
  if (service.mesh_robot()) {
    status.settings["referee_robot"] = service.mesh_robot()->folder.string();
    const std::string& misfits = service.mesh_robot()->referee_misfits;
    if (!misfits.empty()) status.settings[kRefereeMisfits] = misfits;
  }
  TellWarnings(kRobotWarning, service.robot().warnings, &status.settings);
  if (service.mesh_robot()) {
    TellWarnings(kRobotWarning, service.mesh_robot()->warnings, &status.settings);
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
      announcer_(
          bus, [status = status_] { return status; }, [this] { PublishProblemSets(); }) {}

void SceneServerNode::Run(const std::function<bool()>& stop) {
  auto next_announcement = std::chrono::steady_clock::now();
  while (!stop()) {
    announcer_.ThrowIfDisplaced();
    if (std::chrono::steady_clock::now() >= next_announcement) {
      PublishProblemSets();
      next_announcement += kProblemSetsPeriod;
    }
    std::this_thread::sleep_for(kStopPeriod);
  }
}

void SceneServerNode::PublishProblemSets() { bus_->Publish(channel::kProblemSets, problem_sets_); }

}  // namespace planbench
