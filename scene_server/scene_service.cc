#include "scene_server/scene_service.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "common/content_hash.h"
#include "common/error.h"
#include "robot_model/mesh_robot_id.h"
#include "scene_server/standing_contacts.h"

namespace planbench {
namespace {

SceneMessage MakeSceneMessage(const std::string& request_id, const std::string& scene_id,
                              const Scene& scene) {
  SceneMessage message;
  message.request_id = request_id;
  message.scene_id = scene_id;
  message.ok = true;
  message.scene = scene;
  return message;
}

/// What `answer` returns, or a refusal with what it throws; with the request's id.
template <typename Reply, typename Answer>
Reply AnswerOrRefuse(const std::string& request_id, Answer answer) {
  Reply reply;
  try {
    reply = answer();
  } catch (const InputError& error) {
    reply.ok = false;
    reply.message = error.what();
  }
  reply.request_id = request_id;
  return reply;
}

}  // namespace

SceneService::SceneService(Robot robot, std::optional<Robot> mesh_robot,
                           const std::vector<std::filesystem::path>& problem_folders,
                           bool allow_standing_contacts, std::size_t receive_buffer_bytes)
    : robot_(std::move(robot)),
      mesh_robot_(std::move(mesh_robot)),
      library_(robot_, problem_folders, receive_buffer_bytes,
               mesh_robot_ ? &*mesh_robot_ : nullptr),
      collision_(robot_),
      referee_(robot_, mesh_robot_ ? &*mesh_robot_ : nullptr) {
  if (mesh_robot_) SettleStandingContacts(allow_standing_contacts);
}

void SceneService::SettleStandingContacts(bool allow) {
  for (const auto& [name, set] : library_.sets()) {
    ServedProblem problem;
    try {
      problem = library_.Find(name, set.problems.front().index);
    } catch (const InputError&) {
      continue;  // The library has said it.
    }
    for (const auto& [a, b] : referee_.StandingContacts(
             problem.message.group, problem.message.start, problem.scene->allowed_collisions)) {
      if (!allow) {
        throw InputError(fmt::format(
            "--referee-robot {}: its links '{}' and '{}' touch in each of {} random "
            "configurations, "
            "so that every path of the set '{}' would be in collision; name them in allowed_pairs "
            "of a robot.yaml there, or let them with --allow-standing-contacts",
            mesh_robot_->folder.string(), a, b, kStandingDraws, name));
      }
      mesh_robot_->warnings.push_back(
          fmt::format("--allow-standing-contacts: '{}' and '{}' of the referee's robot", a, b));
      spdlog::warn("{}", mesh_robot_->warnings.back());
      // Checkers look the pairs up when a scene is set.
      mesh_robot_->allowed_pairs.emplace_back(mesh_robot_->model.FindLink(a),
                                              mesh_robot_->model.FindLink(b));
      ContentHash hash;
      hash.Add(mesh_robot_->content_id);
      hash.Add(a);
      hash.Add(b);
      mesh_robot_->content_id = hash.HexDigest();
    }
  }
}

ProblemSetsMessage SceneService::ProblemSets(const std::string& server_name) {
  ProblemSetsMessage message;
  message.server = server_name;
  message.robot_name = robot_.name;
  message.robot_id = robot_.content_id;
  message.edge_resolution_m = robot_.edge_resolution_m;
  message.edge_check = robot_.edge_check;
  message.mesh_robot_id = MeshRobotId(robot_);
  if (mesh_robot_) message.referee_robot_id = MeshRobotId(*mesh_robot_);
  for (const auto& [name, set] : library_.sets()) {
    ProblemSetSummary summary;
    summary.name = name;
    summary.content_id = library_.ContentId(set);
    for (const ProblemFiles& files : set.problems) summary.indices.push_back(files.index);
    message.sets.push_back(std::move(summary));
  }
  return message;
}

ProblemAnswer SceneService::AnswerProblem(const ProblemRequestMessage& request) {
  ProblemAnswer answer;
  answer.problem = AnswerOrRefuse<ProblemMessage>(request.request_id, [&] {
    ServedProblem served = library_.Find(request.problem_set, request.problem_index);
    answer.scene = MakeSceneMessage(request.request_id, served.message.scene_id, *served.scene);
    served.message.ok = true;
    return std::move(served.message);
  });
  answer.problem.problem_set = request.problem_set;
  answer.problem.problem_index = request.problem_index;
  return answer;
}

SceneMessage SceneService::AnswerScene(const SceneRequestMessage& request) {
  SceneMessage reply = AnswerOrRefuse<SceneMessage>(request.request_id, [&] {
    return MakeSceneMessage(request.request_id, request.scene_id, *RequireScene(request.scene_id));
  });
  reply.scene_id = request.scene_id;
  return reply;
}

CollisionReplyMessage SceneService::AnswerCollision(const CollisionRequestMessage& request) {
  return AnswerOrRefuse<CollisionReplyMessage>(request.request_id, [&] {
    return collision_.Answer(request, RequireScene(request.scene_id));
  });
}

PathCheckReplyMessage SceneService::AnswerPathCheck(const PathCheckRequestMessage& request) {
  return AnswerOrRefuse<PathCheckReplyMessage>(
      request.request_id, [&] { return referee_.Judge(request, RequireScene(request.scene_id)); });
}

std::shared_ptr<const Scene> SceneService::RequireScene(const std::string& scene_id) {
  std::shared_ptr<const Scene> scene = library_.FindScene(scene_id);
  if (!scene) {
    throw InputError(fmt::format("scene_id: no problem served here has the scene '{}'", scene_id));
  }
  return scene;
}

}  // namespace planbench
