#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messaging/messages.h"
#include "messaging/multicast_receiver.h"
#include "robot_model/robot_folder.h"
#include "scene_server/collision_service.h"
#include "scene_server/path_referee.h"
#include "scene_server/problem_library.h"

namespace planbench {

/// Answer to PROBLEM_REQUEST.
struct ProblemAnswer {
  ProblemMessage problem;
  std::optional<SceneMessage> scene;  ///< If problem.ok; to be sent before the problem.
};

/// What the scene server knows and answers, without the bus. What cannot be answered comes back as
/// a reply with ok = false and a message in one line; nothing is thrown for a bad request. Every
/// answer carries the request's request_id. Thread-safe.
class SceneService {
 public:
  /// `mesh_robot`: the referee's, whose meshes judge paths too (see LoadRefereeRobot). If links of
  /// it touch in every configuration, as the first problem of a set has it, they are allowed to and
  /// named, or refused. `receive_buffer_bytes`: ProblemLibrary's. Throws InputError as
  /// ProblemLibrary and PathReferee do, and for such links.
  SceneService(Robot robot, std::optional<Robot> mesh_robot,
               const std::vector<std::filesystem::path>& problem_folders,
               bool allow_standing_contacts = false,
               std::size_t receive_buffer_bytes = kReceiveBufferBytes);
  // Its parts refer to each other.
  SceneService(const SceneService&) = delete;
  SceneService& operator=(const SceneService&) = delete;

  const Robot& robot() const { return robot_; }
  const std::optional<Robot>& mesh_robot() const { return mesh_robot_; }

  ProblemSetsMessage ProblemSets(const std::string& server_name);
  ProblemAnswer AnswerProblem(const ProblemRequestMessage& request);
  SceneMessage AnswerScene(const SceneRequestMessage& request);
  CollisionReplyMessage AnswerCollision(const CollisionRequestMessage& request);
  PathCheckReplyMessage AnswerPathCheck(const PathCheckRequestMessage& request);

 private:
  void SettleStandingContacts(bool allow);
  /// Throws InputError if no problem has that scene.
  std::shared_ptr<const Scene> RequireScene(const std::string& scene_id);

  Robot robot_;
  std::optional<Robot> mesh_robot_;
  ProblemLibrary library_;
  CollisionService collision_;
  PathReferee referee_;
};

}  // namespace planbench
