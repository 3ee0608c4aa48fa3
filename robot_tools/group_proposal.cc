#include "robot_tools/group_proposal.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace planbench {
namespace {

constexpr int kLeastJointsOfAnArm = 3;
constexpr double kMostFingerTravel = 0.1;  // m
// Of how long the arm is.
constexpr double kLongestFinger = 0.5;
// An arm that can bring its hand to any pose: what it would lack is no wrist or further arm.
constexpr int kJointsOfAWholeArm = 6;
constexpr int kFingersOfAnyHand = 3;

double Offset(const Joint& joint) { return joint.X_PJ.translation().norm(); }

// Index of a joint that follows this one, so that no group can have it; -1 if there is none.
int FollowerThatForbids(const RobotModel& model, int joint) {
  const bool is_continuous =
      model.joints()[static_cast<std::size_t>(joint)].type == JointType::kContinuous;
  return is_continuous ? model.FollowerThatTurnsMove(joint) : -1;
}

class ArmFinder {
 public:
  explicit ArmFinder(const RobotModel& model)
      : model_(model),
        depth_(static_cast<std::size_t>(model.num_links())),
        length_(static_cast<std::size_t>(model.num_links())) {
    // Links come parents first.
    for (int link = model.num_links() - 1; link > 0; --link) {
      const int joint = At(link).parent_joint;
      const auto parent = static_cast<std::size_t>(JointAt(joint).parent_link);
      depth_[parent] = std::max(depth_[parent], Below(joint));
      length_[parent] = std::max(length_[parent], LengthBelow(joint));
    }
  }

  struct Arm {
    std::vector<int> joints;
    int tip;
  };

  /// Finds the arms from `link` outwards; `own`: the joints of the last arm, or body, that lead
  /// there. Where arms part, those are the body's.
  void Find(int link, std::vector<int> own) {
    std::vector<int> branches = ArmsFrom(link, own);
    while (branches.size() == 1) {
      link = Follow(branches.front(), &own);
      branches = ArmsFrom(link, own);
    }
    if (branches.empty()) {
      const int tip = TipFrom(link, own);
      arms_.push_back({std::move(own), tip});
      TakeOffHand(&arms_.back());
      return;
    }
    body_.insert(body_.end(), own.begin(), own.end());
    if (IsLong(own)) trunks_.push_back({own, link});
    for (const int branch : branches) {
      std::vector<int> joints;
      const int child = Follow(branch, &joints);
      Find(child, std::move(joints));
    }
  }

  const std::vector<int>& body() const { return body_; }
  /// Chains of the body that are long enough for an arm.
  const std::vector<Arm>& trunks() const { return trunks_; }
  const std::vector<Arm>& arms() const { return arms_; }

 private:
  const Link& At(int link) const { return model_.links()[static_cast<std::size_t>(link)]; }
  const Joint& JointAt(int joint) const { return model_.joints()[static_cast<std::size_t>(joint)]; }
  bool CanPlan(int joint) const {
    return NumPositions(JointAt(joint).type) == 1 && JointAt(joint).leader < 0 &&
           FollowerThatForbids(model_, joint) < 0;
  }
  static bool IsLong(const std::vector<int>& joints) {
    return static_cast<int>(joints.size()) >= kLeastJointsOfAnArm;
  }
  // Most joints that can be planned with on a way from this joint outwards, itself included.
  int Below(int joint) const {
    return depth_[static_cast<std::size_t>(JointAt(joint).child_link)] + (CanPlan(joint) ? 1 : 0);
  }

  // From this joint's parent link to the furthest below, joint by joint, m.
  double LengthBelow(int joint) const {
    return Offset(JointAt(joint)) + length_[static_cast<std::size_t>(JointAt(joint).child_link)];
  }

  // The joints below a link that lead on along arms: those with enough joints, else the only one
  // that moves anything, or all at the root of an arm. Fingers are several with few, or short.
  std::vector<int> ArmsFrom(int link, const std::vector<int>& own) const {
    std::vector<int> arms;
    std::vector<int> moving;
    for (const int joint : At(link).child_joints) {
      if (Below(joint) >= kLeastJointsOfAnArm) arms.push_back(joint);
      if (Below(joint) > 0) moving.push_back(joint);
    }
    if (arms.empty() && (moving.size() == 1 || own.empty())) return moving;
    if (moving.size() > 1 && AreFingers(moving, link, own)) return {};
    return arms;
  }

  // Whether what parts at a link is a hand's: no branch has more joints than the arm that leads
  // there, nor is any as long as half of it. Arms of a torso are neither. Two branches at the end
  // of less than a whole arm may as well be its wrist beside a camera's joint, or the arms of a
  // gantry.
  bool AreFingers(const std::vector<int>& branches, int link, const std::vector<int>& own) const {
    if (!IsLong(own)) return false;
    if (static_cast<int>(own.size()) < kJointsOfAWholeArm &&
        static_cast<int>(branches.size()) < kFingersOfAnyHand) {
      return false;
    }
    double arm = 0;
    for (int at = link; At(at).parent_joint != own.front(); at = ParentOf(at)) {
      arm += Offset(JointAt(At(at).parent_joint));
    }
    return std::ranges::all_of(branches, [&](int branch) {
      return Below(branch) <= static_cast<int>(own.size()) &&
             LengthBelow(branch) < kLongestFinger * arm;
    });
  }

  int ParentOf(int link) const { return JointAt(At(link).parent_joint).parent_link; }

  int Follow(int joint, std::vector<int>* joints) const {
    if (CanPlan(joint)) joints->push_back(joint);
    return JointAt(joint).child_link;
  }

  // Outwards from the child link of an arm's last joint, while nothing else is there and it is
  // fixed or follows a joint of the arm.
  int TipFrom(int link, const std::vector<int>& arm) const {
    while (At(link).child_joints.size() == 1) {
      const Joint& next = JointAt(At(link).child_joints.front());
      const bool follows = std::ranges::find(arm, next.leader) != arm.end();
      if (next.type != JointType::kFixed && !follows) break;
      link = next.child_link;
    }
    return link;
  }

  bool IsBelow(int link, int other) const {
    while (link > other) link = ParentOf(link);  // Links come parents first.
    return link == other;
  }

  // The last joint of an arm is a finger's if something stands beside it: a joint that follows it
  // from another branch (one in the same chain is linkage), or whatever is at the palm of a short
  // slide.
  bool IsFinger(int index) const {
    const Joint& joint = JointAt(index);
    const auto leads_beside = [&](const Joint& other) {
      return other.leader == index && other.type != JointType::kFixed &&
             !IsBelow(other.child_link, joint.child_link) &&
             !IsBelow(joint.child_link, other.child_link);
    };
    return std::ranges::any_of(model_.joints(), leads_beside) ||
           (joint.type == JointType::kPrismatic && joint.upper - joint.lower < kMostFingerTravel &&
            At(joint.parent_link).child_joints.size() > 1);
  }

  void TakeOffHand(Arm* arm) const {
    while (static_cast<int>(arm->joints.size()) > kLeastJointsOfAnArm &&
           IsFinger(arm->joints.back())) {
      arm->tip = JointAt(arm->joints.back()).parent_link;
      arm->joints.pop_back();
    }
  }

  const RobotModel& model_;
  std::vector<int> depth_;      // Per link: the largest Below of its child joints.
  std::vector<double> length_;  // Per link: the largest LengthBelow of its child joints.
  std::vector<int> body_;
  std::vector<Arm> trunks_;
  std::vector<Arm> arms_;
};

// Joints that no group can have for the sake of one that follows them.
std::vector<std::string> RemarkLeftOut(const RobotModel& model) {
  std::vector<std::string> notes;
  for (std::size_t j = 0; j < model.joints().size(); ++j) {
    const int follower = FollowerThatForbids(model, static_cast<int>(j));
    if (follower < 0) continue;
    notes.push_back(fmt::format(
        "{}: is left out: it is continuous, but joint '{}', which follows it, is "
        "elsewhere a turn later; it could be planned with if it were revolute, with "
        "limits",
        model.joints()[j].where, model.joints()[static_cast<std::size_t>(follower)].name));
  }
  return notes;
}

}  // namespace

std::vector<PlanningGroup> ProposeGroups(const RobotModel& model, std::vector<std::string>* notes) {
  const std::vector<std::string> left_out = RemarkLeftOut(model);
  if (notes != nullptr) notes->insert(notes->end(), left_out.begin(), left_out.end());
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
        "continuous or prismatic, following none){}{}",
        model.name(), left_out.empty() ? "" : "; ", fmt::join(left_out, "; ")));
  }
  if (arms.size() == 1) return {make("arm", arms.front().joints, {name_of(arms.front().tip)})};

  std::vector<PlanningGroup> groups;
  std::vector<int> all = finder.body();
  std::vector<std::string> tips;
  for (const ArmFinder::Arm& trunk : finder.trunks()) {
    groups.push_back(make("arm_" + name_of(trunk.tip), trunk.joints, {name_of(trunk.tip)}));
  }
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
