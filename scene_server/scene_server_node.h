#pragma once

#include <functional>
#include <string>

#include "messaging/bus.h"
#include "messaging/node_announcer.h"
#include "messaging/rpc.h"
#include "scene_server/scene_service.h"

namespace planbench {

/// The scene server as a process on the bus: announces itself and its problem sets, and answers
/// PROBLEM_REQUEST, SCENE_REQUEST, COLLISION_REQUEST and PATH_CHECK_REQUEST, each on a thread of
/// its own. There is one on a bus: requests name no server, so that two would contradict each
/// other.
class SceneServerNode {
 public:
  /// Goes live. `name` must be free on the bus. `service` must outlive this.
  SceneServerNode(Bus* bus, const std::string& name, SceneService* service);

  /// Announces the problem sets at 1 Hz until `stop` (asked every 50 ms) says so; throws InputError
  /// if an older process has the name, or is a scene server by another name.
  void Run(const std::function<bool()>& stop);

  const ProblemSetsMessage& problem_sets() const { return problem_sets_; }

 private:
  void PublishProblemSets();

  Bus* bus_;
  NodeStatusMessage status_;
  ProblemSetsMessage problem_sets_;
  RpcServer<ProblemRequestMessage, ProblemMessage> problems_;
  RpcServer<SceneRequestMessage, SceneMessage> scenes_;
  RpcServer<CollisionRequestMessage, CollisionReplyMessage> collisions_;
  RpcServer<PathCheckRequestMessage, PathCheckReplyMessage> path_checks_;
  NodeAnnouncer announcer_;  // last: announced once everything answers
};

}  // namespace planbench
