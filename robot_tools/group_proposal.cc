#include "robot_tools/group_proposal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace planbench {
namespace {

constexpr int kLeastJointsOfAnArm = 3;
constexpr double kMostFingerTravel = 0.1;  // m

class ArmFinder {
 public:
  explicit ArmFinder(const RobotModel& model)
      : model_(model), depth_(static_cast<std::size_t>(model.num_links())) {
    // Links come parents first.
    for (int link = model.num_links() - 1; link > 0; --link) {
      const int joint = At(link).parent_joint;
      int& parent = depth_[static_cast<std::size_t>(JointAt(joint).parent_link)];
      parent = std::max(parent, Below(joint));
    }
  }

  struct Arm {
    std::vector<int> joints;
    int tip;
  };

  /// Finds the arms from `link` outwards; `own`: the joints of the last arm, or body, that lead
  /// there. Where arms part, those are the body's.
  void Find(int link, std::vector<int> own) {
    std::vector<int> branches = ArmsFrom(link, own.empty());
    while (branches.size() == 1) {
      link = Follow(branches.front(), &own);
      branches = ArmsFrom(link, own.empty());
    }
    if (branches.empty()) {
      arms_.push_back({std::move(own), TipFrom(link)});
      TakeOffHand(&arms_.back());
      return;
    }
    body_.insert(body_.end(), own.begin(), own.end());
    for (const int branch : branches) {
      std::vector<int> joints;
      const int child = Follow(branch, &joints);
      Find(child, std::move(joints));
    }
  }

  const std::vector<int>& body() const { return body_; }
  const std::vector<Arm>& arms() const { return arms_; }

 private:
  const Link& At(int link) const { return model_.links()[static_cast<std::size_t>(link)]; }
  const Joint& JointAt(int joint) const { return model_.joints()[static_cast<std::size_t>(joint)]; }
  bool CanPlan(int joint) const {
    return NumPositions(JointAt(joint).type) == 1 && JointAt(joint).leader < 0;
  }
  // Most joints that can be planned with on a way from this joint outwards, itself included.
  int Below(int joint) const {
    return depth_[static_cast<std::size_t>(JointAt(joint).child_link)] + (CanPlan(joint) ? 1 : 0);
  }

  // The joints below a link that lead on along arms: those with enough joints, else the only one
  // that moves anything, or all at the root of an arm. Fingers are several with few.
  std::vector<int> ArmsFrom(int link, bool nothing_yet) const {
    std::vector<int> arms;
    std::vector<int> moving;
    for (const int joint : At(link).child_joints) {
      if (Below(joint) >= kLeastJointsOfAnArm) arms.push_back(joint);
      if (Below(joint) > 0) moving.push_back(joint);
    }
    if (arms.empty() && (moving.size() == 1 || nothing_yet)) return moving;
    return arms;
  }

  int Follow(int joint, std::vector<int>* joints) const {
    if (CanPlan(joint)) joints->push_back(joint);
    return JointAt(joint).child_link;
  }

  // Outwards from the child link of an arm's last joint, while nothing else is there and fixed.
  int TipFrom(int link) const {
    while (At(link).child_joints.size() == 1 &&
           JointAt(At(link).child_joints.front()).type == JointType::kFixed) {
      link = JointAt(At(link).child_joints.front()).child_link;
    }
    return link;
  }

  bool IsFinger(const Joint& joint) const {
    const int index = model_.FindJoint(joint.name);
    return std::any_of(model_.joints().begin(), model_.joints().end(),
                       [&](const Joint& other) {
                         return other.leader == index && other.type != JointType::kFixed;
                       }) ||
           (joint.type == JointType::kPrismatic && joint.upper - joint.lower < kMostFingerTravel);
  }

  void TakeOffHand(Arm* arm) const {
    while (arm->joints.size() > 1 && IsFinger(JointAt(arm->joints.back()))) {
      arm->tip = JointAt(arm->joints.back()).parent_link;
      arm->joints.pop_back();
    }
  }

  const RobotModel& model_;
  std::vector<int> depth_;  // Per link: the largest Below of its child joints.
  std::vector<int> body_;
  std::vector<Arm> arms_;
};

}  // namespace

std::vector<PlanningGroup> ProposeGroups(const RobotModel& model) {
  ArmFinder finder(model);
  finder.Find(0, {});
  const std::vector<ArmFinder::Arm>& arms = finder.arms();
  const auto name_of = [&](int link) { return model.links()[static_cast<std::size_t>(link)].name; };
  const auto make = [&](const std::string& name, const std::vector<int>& joints,
                        const std::vector<std::string>& tips) {
    std::vector<std::string> names;
    for (const int j : joints) names.push_back(model.joints()[static_cast<std::size_t>(j)].name);
    return model.MakeGroup(name, names, tips.front(), {tips.begin() + 1, tips.end()});
  };
  if (arms.front().joints.empty()) {
    throw InputError(fmt::format(
        "robot '{}': no group can be proposed, as no joint can be planned with (revolute, "
        "continuous or prismatic, following none)",
        model.name()));
  }
  if (arms.size() == 1) return {make("arm", arms.front().joints, {name_of(arms.front().tip)})};

  std::vector<PlanningGroup> groups;
  std::vector<int> all = finder.body();
  std::vector<std::string> tips;
  for (const ArmFinder::Arm& arm : arms) {
    tips.push_back(name_of(arm.tip));
    groups.push_back(make("arm_" + tips.back(), arm.joints, {tips.back()}));
    all.insert(all.end(), arm.joints.begin(), arm.joints.end());
  }
  std::sort(all.begin(), all.end());  // The URDF's order.
  groups.push_back(make("all_arms", all, tips));
  return groups;
}

}  // namespace planbench
