#include "scene_server/collision_service.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "collision/edge_checker.h"
#include "common/error.h"
#include "robot_model/full_positions.h"

namespace planbench {
namespace {

void RequireSize(const Configuration& q, const PlanningGroup& group, const std::string& field) {
  if (q.size() != group.joints.size()) {
    throw InputError(fmt::format("{} has {} positions, group '{}' has {} joints", field, q.size(),
                                 group.name, group.joints.size()));
  }
}

void RequireSizes(const CollisionRequestMessage& request, const PlanningGroup& group) {
  for (std::size_t i = 0; i < request.states.size(); ++i) {
    RequireSize(request.states[i], group, fmt::format("position[{}]", i));
  }
  for (std::size_t i = 0; i < request.edges.size(); ++i) {
    RequireSize(request.edges[i].from, group, fmt::format("edge_from[{}]", i));
    RequireSize(request.edges[i].to, group, fmt::format("edge_to[{}]", i));
  }
}

/// Records the collision at q if there is one.
void CheckCollision(CollisionChecker* checker, const Configuration& q, double fraction,
                    CollisionVerdict* verdict) {
  if (checker->IsFree(q)) return;
  verdict->free = false;
  verdict->fraction = fraction;
  if (const std::optional<Contact> contact = checker->FindContact(q)) {
    verdict->body_a = contact->body_a;
    verdict->body_b = contact->body_b;
    verdict->depth_m = contact->depth_m;
  }
}

CollisionVerdict JudgeState(CollisionChecker* checker, const Configuration& q, bool with_distance) {
  CollisionVerdict verdict;
  verdict.within_limits = checker->space().WithinLimits(q);
  CheckCollision(checker, q, 0, &verdict);
  if (with_distance) {
    const ClosestPair closest = checker->FindClosest(q);
    verdict.distance_m = closest.distance_m;
    verdict.nearest_a = closest.body_a;
    verdict.nearest_b = closest.body_b;
  }
  return verdict;
}

CollisionVerdict JudgeEdge(EdgeChecker* edges, const EdgeQuery& edge) {
  const JointSpace& space = edges->space();
  CollisionVerdict verdict;
  verdict.within_limits = space.WithinLimits(edge.from) && space.WithinLimits(edge.to);
  // Whatever the method, a first sample in collision tells most.
  edges->VisitSamples(edge.from, edge.to, [&](double fraction, const Configuration& q) {
    CheckCollision(&edges->checker(), q, fraction, &verdict);
    return verdict.free;
  });
  if (!verdict.free || edges->method() == EdgeCheck::kFixed) return verdict;
  if (const std::optional<double> blocked = edges->FindBlocked(edge.from, edge.to)) {
    Configuration q(edge.from.size());
    space.Interpolate(edge.from, edge.to, *blocked, q);
    CheckCollision(&edges->checker(), q, *blocked, &verdict);
    verdict.free = false;
    verdict.fraction = *blocked;
  }
  return verdict;
}

double CountSamples(const EdgeChecker& edges, const std::vector<EdgeQuery>& queries) {
  double samples = 0;
  for (const EdgeQuery& edge : queries) samples += edges.NumIntervals(edge.from, edge.to) + 1;
  return samples;
}

}  // namespace

CollisionReplyMessage CollisionService::Answer(const CollisionRequestMessage& request,
                                               const std::shared_ptr<const Scene>& scene) {
  const PlanningGroup& group = robot_->Group(request.group);
  RequireSizes(request, group);
  const double resolution_m = request.edge_resolution_m.value_or(robot_->edge_resolution_m);

  const std::scoped_lock lock(mutex_);
  CollisionChecker& checker = checkers_.Get(
      group, request.collision_model, request.scene_id, scene,
      FullPositions(robot_->model, request.state.names, request.state.positions, "state"));
  EdgeChecker edges(&checker, resolution_m, request.edge_check.value_or(robot_->edge_check));
  if (CountSamples(edges, request.edges) > kMaxSamples) {
    throw InputError(
        fmt::format("edge_resolution_m: at {} m these edges have more than {:.0f} samples",
                    resolution_m, kMaxSamples));
  }

  CollisionReplyMessage reply;
  reply.ok = true;
  reply.engine = std::string(checker.EngineName());
  for (const Configuration& q : request.states) {
    reply.states.push_back(JudgeState(&checker, q, request.with_distance));
  }
  for (const EdgeQuery& edge : request.edges) reply.edges.push_back(JudgeEdge(&edges, edge));
  return reply;
}

}  // namespace planbench
