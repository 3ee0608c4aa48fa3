#include "collision/follower_checker.h"

#include <cmath>
#include <utility>

namespace planbench {
namespace {

const Joint& JointOf(const Robot& robot, const PlanningGroup::Follower& follower) {
  return robot.model.joints()[static_cast<std::size_t>(follower.joint)];
}

PlanningGroup GroupWithFollowers(const Robot& robot, const PlanningGroup& group) {
  PlanningGroup moved = group;
  moved.followers.clear();
  std::vector<JointSpace::Joint> space = group.space.joints();
  for (const PlanningGroup::Follower& follower : group.followers) {
    moved.joints.push_back(follower.joint);
    space.push_back(SpaceJoint(JointOf(robot, follower)));
  }
  moved.space = JointSpace(std::move(space));
  return moved;
}

}  // namespace

FollowerChecker::FollowerChecker(const Robot& robot, const PlanningGroup& group,
                                 CollisionModel model, MakeEngine make_engine)
    : CollisionChecker(robot, group, model),
      moved_(GroupWithFollowers(robot, group)),
      engine_(make_engine(robot, moved_, model)) {}

std::span<const double> FollowerChecker::WithFollowers(std::span<const double> qs, int num) {
  const std::size_t n = group().joints.size();
  rows_.clear();
  for (std::size_t i = 0; i < static_cast<std::size_t>(num); ++i) {
    const std::span<const double> q = qs.subspan(i * n, n);
    rows_.insert(rows_.end(), q.begin(), q.end());
    for (const PlanningGroup::Follower& follower : group().followers) {
      const Joint& joint = JointOf(robot(), follower);
      rows_.push_back(joint.multiplier * q[static_cast<std::size_t>(follower.group_index)] +
                      joint.offset);
    }
  }
  return rows_;
}

MotionBound FollowerChecker::DoSetScene(const Scene& scene,
                                        std::span<const double> base_positions) {
  engine_->SetScene(scene, base_positions);
  const std::vector<double>& moved = engine_->motion_bound().reach();
  const std::size_t n = group().joints.size();
  std::vector<double> reach(moved.begin(), moved.begin() + static_cast<std::ptrdiff_t>(n));
  for (std::size_t k = 0; k < group().followers.size(); ++k) {
    const PlanningGroup::Follower& follower = group().followers[k];
    reach[static_cast<std::size_t>(follower.group_index)] +=
        std::abs(JointOf(robot(), follower).multiplier) * moved[n + k];
  }
  return MotionBound(std::move(reach));
}

bool FollowerChecker::DoIsFree(std::span<const double> q) {
  return engine_->IsFree(WithFollowers(q, 1));
}

void FollowerChecker::DoCheckAll(std::span<const double> qs, int num,
                                 std::span<unsigned char> free) {
  engine_->CheckAll(WithFollowers(qs, num), num, free);
}

void FollowerChecker::DoScreen(std::span<const double> qs, int num, std::span<unsigned char> free) {
  engine_->Screen(WithFollowers(qs, num), num, free);
}

SampleVerdicts FollowerChecker::DoCheckSamples(std::span<const double> start,
                                               std::span<const double> motion,
                                               std::span<const MotionSample> samples,
                                               SampleRole role) {
  motion_.assign(motion.begin(), motion.end());
  for (const PlanningGroup::Follower& follower : group().followers) {
    motion_.push_back(JointOf(robot(), follower).multiplier *
                      motion[static_cast<std::size_t>(follower.group_index)]);
  }
  return engine_->CheckSamples(WithFollowers(start, 1), motion_, samples, role);
}

void FollowerChecker::DoFindDistances(std::span<const double> qs, int num, double at_most,
                                      std::span<double> distances) {
  engine_->FindDistances(WithFollowers(qs, num), num, at_most, distances);
}

void FollowerChecker::DoFindClearances(std::span<const double> qs, int num, double at_most,
                                       std::span<double> clearances) {
  engine_->FindClearances(WithFollowers(qs, num), num, at_most, clearances);
}

std::optional<Contact> FollowerChecker::DoFindContact(std::span<const double> q) {
  return engine_->FindContact(WithFollowers(q, 1));
}

ClosestPair FollowerChecker::DoFindClosest(std::span<const double> q) {
  return engine_->FindClosest(WithFollowers(q, 1));
}

}  // namespace planbench
