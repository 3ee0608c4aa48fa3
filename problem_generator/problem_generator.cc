#include "problem_generator/problem_generator.h"

#include <algorithm>

#include "collision/edge_checker.h"
#include "problem_generator/query_sampler.h"
#include "problem_generator/random_stream.h"
#include "problem_generator/scene_sampler.h"
#include "robot_model/full_positions.h"

namespace planbench {
namespace {

const QuerySpec& DrawQuery(const ProblemSpec& spec, RandomStream* random) {
  std::vector<double> weights;
  for (const QuerySpec& query : spec.queries) weights.push_back(query.weight);
  return spec.queries[random->Weighted(weights)];
}

// Of one tip of the group. What does not move it stays at rest: drawn at random, other arms would
// have postures that nobody asked for.
InverseKinematics KinematicsOf(int tip_link, const RobotModel& model, const PlanningGroup& group,
                               const std::vector<double>& rest) {
  PlanningGroup of_tip = group;
  of_tip.tip_link = tip_link;
  const std::vector<int> moving = InverseKinematics(model, of_tip, rest).moving_joints();
  std::vector<int> others;
  std::vector<double> q;
  for (int j = 0; j < group.space.size(); ++j) {
    if (std::find(moving.begin(), moving.end(), j) == moving.end()) others.push_back(j);
    const int joint = group.joints[static_cast<std::size_t>(j)];
    const int index = model.joints()[static_cast<std::size_t>(joint)].position_index;
    q.push_back(rest[static_cast<std::size_t>(index)]);
  }
  of_tip.space = group.space.Held(others, q);
  return {model, of_tip, rest};
}

}  // namespace

ProblemGenerator::ProblemGenerator(const ProblemSpec& spec, const Robot& robot, std::uint64_t seed)
    : spec_(&spec),
      robot_(&robot),
      group_(&robot.Group(spec.group)),
      seed_(seed),
      rest_(FullPositions(robot.model, spec.rest.names, spec.rest.positions, spec.name)),
      checker_(MakeReferenceChecker(robot, *group_, CollisionModel::kSpheres)) {
  for (const int tip : group_->tips()) {
    kinematics_.emplace(tip, KinematicsOf(tip, robot.model, *group_, rest_));
  }
}

ProblemGenerator::Result ProblemGenerator::Generate(int k, int attempt) {
  RandomStream random(spec_->name, seed_, k, attempt);
  // The query first: drawn anew with every scene, those that are hard to meet would become rare.
  const QuerySpec& query = DrawQuery(*spec_, &random);
  Result result;
  result.query = query.name;
  const JointSpace& space = group_->space;
  for (int trial = 0; trial < spec_->effort.scenes; ++trial) {
    auto sampled = SampleScene(*spec_, *robot_, &random, &result.rejections);
    if (!sampled) continue;
    checker_->SetScene(sampled->scene, rest_);
    QuerySampler sampler(*spec_, &kinematics_, checker_.get());
    const auto start = sampler.Sample(query.start, *sampled, query.goal.configuration, &random,
                                      &result.rejections);
    if (!start) continue;
    const auto goal = sampler.Sample(query.goal, *sampled, start, &random, &result.rejections);
    if (!goal) continue;
    if (space.Distance(*start, *goal) < spec_->min_joint_distance) {
      result.rejections.Add(query.name + ": goal too near to the start", query.goal.where);
      continue;
    }
    if (EdgeChecker(checker_.get(), robot_->edge_resolution_m, EdgeCheck::kFixed)
            .IsValidEdge(*start, *goal)) {
      result.rejections.Add(query.name + ": straight motion is free", query.goal.where);
      continue;
    }
    Problem problem;
    problem.set = spec_->name;
    problem.index = k;
    problem.scene = std::move(sampled->scene);
    problem.scene.name = spec_->name + "_" + std::to_string(k);
    problem.group = spec_->group;
    problem.start = spec_->rest;
    for (int j = 0; j < space.size(); ++j) {
      const auto i = static_cast<std::size_t>(j);
      const Joint& joint = robot_->model.joints()[static_cast<std::size_t>(group_->joints[i])];
      problem.start.positions[static_cast<std::size_t>(joint.position_index)] = (*start)[i];
      problem.goal.push_back({.joint = joint.name, .position = (*goal)[i]});
    }
    problem.workspace = spec_->workspace;
    problem.time_limit_s = spec_->time_limit_s;
    result.problem = std::move(problem);
    return result;
  }
  return result;
}

}  // namespace planbench
