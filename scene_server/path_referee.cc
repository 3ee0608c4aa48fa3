#include "scene_server/path_referee.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/error.h"
#include "planning/path_judge.h"
#include "planning/resolve.h"
#include "robot_model/full_positions.h"
#include "robot_model/referee_misfits.h"
#include "scene_server/standing_contacts.h"

namespace planbench {
namespace {

CollisionModel ModelToJudgeWith(CollisionModel asked) {
  return asked == CollisionModel::kVoxels ? CollisionModel::kSpheres : asked;
}

/// Why the names cannot be those of the group's joints in some order; empty if they can.
std::string FindFault(const std::vector<std::string>& joint_names, const PlanningGroup& group) {
  for (const std::string& name : joint_names) {
    if (group.space.Find(name) < 0) {
      return fmt::format("the path names joint '{}', which is not in group '{}'", name, group.name);
    }
    if (std::count(joint_names.begin(), joint_names.end(), name) > 1) {
      return fmt::format("the path names joint '{}' twice", name);
    }
  }
  for (const JointSpace::Joint& joint : group.space.joints()) {
    if (std::find(joint_names.begin(), joint_names.end(), joint.name) == joint_names.end()) {
      return fmt::format("the path does not name joint '{}' of group '{}'", joint.name, group.name);
    }
  }
  return "";
}

/// The waypoints in group order. Those of a wrong size are left as they are, for the judge to
/// reject.
Path InGroupOrder(const Path& path, const std::vector<std::string>& joint_names,
                  const JointSpace& space) {
  Path ordered = path;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i].size() != joint_names.size()) continue;
    for (std::size_t k = 0; k < joint_names.size(); ++k) {
      ordered[i][static_cast<std::size_t>(space.Find(joint_names[k]))] = path[i][k];
    }
  }
  return ordered;
}

}  // namespace

PathReferee::PathReferee(const Robot& robot, const Robot* mesh_robot)
    : robot_(&robot), mesh_robot_(mesh_robot), checkers_(robot) {
  if (mesh_robot_ == nullptr) return;
  mesh_checkers_.emplace(*mesh_robot_);
  const auto empty_scene = std::make_shared<const Scene>();
  for (const PlanningGroup& group : robot_->groups) {
    mesh_checkers_->Get(mesh_robot_->Group(group.name), CollisionModel::kMeshes, "no scene",
                        empty_scene, mesh_robot_->model.DefaultPositions());
  }
}

std::shared_ptr<const Scene> PathReferee::InMeshRobotsFrame(
    const std::string& scene_id, const std::shared_ptr<const Scene>& scene,
    const std::vector<double>& positions, const std::vector<double>& mesh_positions) {
  const RobotModel& model = robot_->model;
  const RobotModel& mesh_model = mesh_robot_->model;
  const std::string& root = model.links().front().name;
  const std::string& mesh_root = mesh_model.links().front().name;
  if (root == mesh_root) return scene;
  Eigen::Isometry3d X_NW;
  if (const int link = mesh_model.FindLink(root); link >= 0) {
    X_NW = ComputeLinkPoses(mesh_model, mesh_positions)[static_cast<std::size_t>(link)];
  } else {
    X_NW = ComputeLinkPoses(model, positions)[static_cast<std::size_t>(model.FindLink(mesh_root))]
               .inverse(Eigen::Isometry);
  }
  if (moved_id_ != scene_id || moved_by_.matrix() != X_NW.matrix()) {
    moved_ = std::make_shared<const Scene>(InFrame(*scene, mesh_root, X_NW));
    moved_id_ = scene_id;
    moved_by_ = X_NW;
  }
  return moved_;
}

std::vector<std::pair<std::string, std::string>> PathReferee::StandingContacts(
    const std::string& group, const JointState& start, const AllowedCollisionMatrix& allowed) {
  const std::scoped_lock lock(mutex_);
  const std::vector<double> positions = RefereePositions(
      robot_->model, FullPositionsWherePossible(robot_->model, start.names, start.positions),
      mesh_robot_->model);
  CollisionChecker& checker =
      mesh_checkers_->Get(mesh_robot_->Group(group), CollisionModel::kMeshes, "standing contacts",
                          std::make_shared<const Scene>(), positions);
  return FindStandingContacts(&checker, allowed, positions);
}

PathCheckReplyMessage PathReferee::Judge(const PathCheckRequestMessage& request,
                                         const std::shared_ptr<const Scene>& scene) {
  if (!(request.step_m > 0) || !std::isfinite(request.step_m)) {
    throw InputError(fmt::format("step_m is {}, must be greater than zero", request.step_m));
  }
  const PlanningGroup& group = robot_->Group(request.group);
  const ResolvedQuery query =
      ResolveQuery(*robot_, group, request.start, request.goal, "start and goal");

  const std::scoped_lock lock(mutex_);
  CollisionChecker& checker = checkers_.Get(group, ModelToJudgeWith(request.collision_model),
                                            request.scene_id, scene, query.base_positions);
  PathCheckReplyMessage reply;
  reply.ok = true;
  reply.engine = std::string(checker.EngineName());
  reply.step_m = request.step_m;

  const std::string fault = request.path.empty() ? "" : FindFault(request.joint_names, group);
  if (!fault.empty()) {
    reply.verdict.emplace();
    reply.verdict->reason = fault;
    if (mesh_robot_ != nullptr) reply.mesh_verdict = reply.verdict;
    return reply;
  }
  const Path path = InGroupOrder(request.path, request.joint_names, group.space);
  reply.verdict = JudgePath(&checker, path, query.start, query.goals, request.step_m,
                            request.with_clearance, query.base_positions);
  if (mesh_robot_ != nullptr) {
    const std::vector<double> positions =
        RefereePositions(robot_->model, query.base_positions, mesh_robot_->model);
    CollisionChecker& meshes = mesh_checkers_->Get(
        mesh_robot_->Group(group.name), CollisionModel::kMeshes, request.scene_id,
        InMeshRobotsFrame(request.scene_id, scene, query.base_positions, positions), positions);
    reply.mesh_verdict = JudgePath(&meshes, path, query.start, query.goals, request.step_m,
                                   /*with_clearance=*/false, positions);
  }
  return reply;
}

}  // namespace planbench
