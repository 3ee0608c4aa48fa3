#include "scene/frame_tree.h"

#include <algorithm>
#include <string_view>

#include "common/text.h"

namespace planbench {
namespace {

using Eigen::Isometry3d;

// What two accounts of a pose may differ by: they were measured or written as text (m; of
// directions, rad).
constexpr double kAgreement = 1e-6;

bool Agree(const Isometry3d& a, const Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() <= kAgreement;
}

}  // namespace

std::string WithoutSlash(const std::string& frame) {
  return frame.substr(std::min(frame.find_first_not_of('/'), frame.size()));
}

std::string LinkNamed(const std::string& name, const RobotModel& model) {
  return model.FindLink(name) >= 0 ? name : WithoutSlash(name);
}

FrameTree::FrameTree(const Robot& robot, const Stance& stance, const PlanningFrame& planning_frame,
                     const std::vector<FixedTransform>& transforms)
    : not_of_objects_{planning_frame.name} {
  const std::vector<Isometry3d> X_BL = ComputeLinkPoses(robot.model, stance.positions);
  for (int link = 0; link < robot.model.num_links(); ++link) {
    const auto l = static_cast<std::size_t>(link);
    const std::string frame = WithoutSlash(robot.model.links()[l].name);
    X_BF_[frame] = X_BL[l];
    not_of_objects_.insert(frame);
  }
  std::vector<FixedTransform> named = transforms;  // With the planning frame by its name.
  for (FixedTransform& transform : named) {
    if (transform.header.empty()) transform.header = planning_frame.name;
  }
  std::vector<OutwardFrame> outward;  // From the planning frame, unless it is a guess.
  if (!planning_frame.is_guessed) {
    outward = FollowOutwards(named, {{planning_frame.name, Isometry3d::Identity(), nullptr}});
  }
  // What the file says comes before what the robot's description says, and that before what is
  // taken where neither says anything.
  Follow(named, outward);
  for (const PlacedLink& placed : stance.placed_links) {
    Place(placed, placed.frame.empty() ? planning_frame.name : placed.frame, robot.model);
  }
  Follow(named, outward);
  PlaceSurroundings(robot);
  Follow(named, outward);
  X_BF_.try_emplace(planning_frame.name, Isometry3d::Identity());
  X_BF_[""] = X_BF_.at(planning_frame.name);
  Follow(named, outward);
  CheckAgreement(named);
  if (stance.placed_links.empty()) WarnOfPlacedRobot(outward, robot.model);
}

void FrameTree::Place(const PlacedLink& placed, const std::string& frame, const RobotModel& model) {
  const std::string& link = model.links()[static_cast<std::size_t>(placed.link)].name;
  const Isometry3d X_BF = PoseOf(link) * placed.X_FL.inverse(Eigen::Isometry);
  const auto [known, is_new] = X_BF_.try_emplace(frame, X_BF);
  not_of_objects_.insert(frame);
  if (is_new || Agree(known->second, X_BF)) return;
  placed.node.Fail("places the robot's link '" + link + "' in the frame '" + frame +
                   "', which has another pose already: it is the robot's own, or another virtual "
                   "joint or a fixed transform joins it to the robot");
}

void FrameTree::PlaceSurroundings(const Robot& robot) {
  for (const VirtualJoint& joint : robot.virtual_joints) {
    const std::string frame = WithoutSlash(joint.parent_frame);
    const std::string& link = robot.model.links()[static_cast<std::size_t>(joint.child_link)].name;
    X_BF_.try_emplace(frame, PoseOf(link));
    not_of_objects_.insert(frame);
  }
}

void FrameTree::MoveToBaseOf(const FrameTree& other, const std::string& still,
                             const YamlNode& node) {
  const Isometry3d* X_OF = other.Find(still);
  const Isometry3d* X_BF = Find(still);
  if (X_OF == nullptr || X_BF == nullptr) {
    node.Fail("has the robot stand in the frame '" + still +
              "', which is unknown where it stands in the scene's own state; name one frame for "
              "both, or a transform that joins them");
  }
  // Not to round what has not moved.
  if (X_OF->matrix() == X_BF->matrix()) return;
  const Isometry3d X_OB = *X_OF * X_BF->inverse(Eigen::Isometry);
  for (auto& [name, X] : X_BF_) X = X_OB * X;
}

std::vector<FrameTree::OutwardFrame> FrameTree::FollowOutwards(
    const std::vector<FixedTransform>& transforms, const std::vector<OutwardFrame>& from) {
  std::map<std::string, std::vector<const FixedTransform*>> touching;
  for (const FixedTransform& transform : transforms) {
    touching[transform.header].push_back(&transform);
    touching[transform.child].push_back(&transform);
  }
  std::vector<OutwardFrame> reached;
  std::set<std::string> seen;
  for (const OutwardFrame& first : from) {
    if (seen.insert(first.name).second) reached.push_back(first);
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const OutwardFrame last = reached[i];  // Not a reference: they grow.
    for (const FixedTransform* transform : touching[last.name]) {
      const bool is_from_header = transform->header == last.name;
      const std::string& other = is_from_header ? transform->child : transform->header;
      if (seen.insert(other).second) {
        reached.push_back({other, last.X_AF * transform->X, transform});
      }
    }
  }
  return reached;
}

void FrameTree::Follow(const std::vector<FixedTransform>& transforms,
                       const std::vector<OutwardFrame>& outward) {
  const auto known = std::find_if(outward.begin(), outward.end(), [&](const OutwardFrame& frame) {
    return Find(frame.name) != nullptr;
  });
  if (known != outward.end()) {
    const Isometry3d X_BP = *Find(known->name) * known->X_AF.inverse(Eigen::Isometry);
    for (const OutwardFrame& frame : outward) X_BF_.try_emplace(frame.name, X_BP * frame.X_AF);
  }
  std::vector<OutwardFrame> from;
  for (const FixedTransform& transform : transforms) {
    for (const std::string* name : {&transform.header, &transform.child}) {
      if (const Isometry3d* X_BF = Find(*name)) from.push_back({*name, *X_BF, nullptr});
    }
  }
  for (const OutwardFrame& frame : FollowOutwards(transforms, from)) {
    X_BF_.try_emplace(frame.name, frame.X_AF);
  }
}

// MoveIt goes by the robot's state alone, which has the planning frame at a virtual joint.
void FrameTree::WarnOfPlacedRobot(const std::vector<OutwardFrame>& outward,
                                  const RobotModel& model) const {
  const auto link = std::find_if(outward.begin(), outward.end(), [&](const OutwardFrame& frame) {
    return model.FindLink(frame.name) >= 0;
  });
  if (link == outward.end() || link == outward.begin()) return;
  const std::string& planning_frame = outward.front().name;
  if (Agree(X_BF_.at(planning_frame), Isometry3d::Identity())) return;
  const FixedTransform& last = *link->last;
  const std::string& from = last.header == link->name ? last.child : last.header;
  last.node.Warn("taken as the pose of the robot's link '" + link->name + "' in the frame '" +
                 from + "', which places the robot in the planning frame '" + planning_frame +
                 "'; MoveIt passes it over, and goes by the robot's state");
}

void FrameTree::CheckAgreement(const std::vector<FixedTransform>& transforms) const {
  for (const FixedTransform& transform : transforms) {
    const Isometry3d* header = Find(transform.header);
    const Isometry3d* child = Find(transform.child);
    if (header == nullptr || child == nullptr) continue;  // Frames that nothing can be given in.
    if (transform.header == transform.child) {
      if (Agree(transform.X, Isometry3d::Identity())) continue;
      transform.node.At("transform")
          .Fail("the frame '" + transform.child + "' has a pose other than the identity in itself");
    }
    const Isometry3d X_HC = header->inverse(Eigen::Isometry) * *child;
    if (Agree(transform.X, X_HC) || Agree(transform.X, X_HC.inverse(Eigen::Isometry))) continue;
    transform.node.Fail("the frames '" + transform.header + "' and '" + transform.child +
                        "' stand otherwise to each other by the robot's links or other transforms");
  }
}

void FrameTree::SetObject(const std::string& id, const std::string& link,
                          const std::vector<ObjectFrame>& frames) {
  RemoveObject(id);
  expected_.erase(WithoutSlash(id));
  ObjectFrames& object = objects_[id];
  object.link = link;
  for (const ObjectFrame& frame : frames) {
    if (not_of_objects_.contains(frame.name)) continue;
    const auto [known, is_new] = object_frames_.try_emplace(
        frame.name, PlacedObjectFrame{id, PoseOf(link) * frame.X_LF, frame.disputed_pose});
    if (!is_new) {
      frame.node.Fail("the object '" + known->second.id + "' has a frame '" + frame.name +
                      "' already");
    }
    object.frames.push_back(frame);
  }
}

void FrameTree::AttachObject(const std::string& id, const std::string& link) {
  ObjectFrames& object = objects_[id];
  const Isometry3d X_NO = PoseOf(link).inverse(Eigen::Isometry) * PoseOf(object.link);
  for (ObjectFrame& frame : object.frames) frame.X_LF = X_NO * frame.X_LF;
  object.link = link;
}

void FrameTree::RemoveObject(const std::string& id) {
  const auto object = objects_.find(id);
  if (object == objects_.end()) return;
  for (const ObjectFrame& frame : object->second.frames) object_frames_.erase(frame.name);
  objects_.erase(object);
}

void FrameTree::SetObjectsOf(const FrameTree& other) {
  for (const auto& [id, object] : other.objects_) SetObject(id, object.link, object.frames);
}

Isometry3d FrameTree::PoseOf(const std::string& link) const {
  return link.empty() ? Isometry3d::Identity() : X_BF_.at(WithoutSlash(link));
}

const FrameTree::PlacedObjectFrame* FrameTree::FindOfObject(const std::string& name) const {
  const auto found = object_frames_.find(WithoutSlash(name));
  return found == object_frames_.end() ? nullptr : &found->second;
}

const Isometry3d* FrameTree::Find(const std::string& name) const {
  if (const PlacedObjectFrame* frame = FindOfObject(name)) return &frame->X_BF;
  const auto found = X_BF_.find(WithoutSlash(name));
  return found == X_BF_.end() ? nullptr : &found->second;
}

const FrameTree::PlacedObjectFrame* FrameTree::UseOfObject(const std::string& name) const {
  const PlacedObjectFrame* frame = FindOfObject(name);
  if (frame != nullptr && frame->disputed_pose) {
    frame->disputed_pose->Warn("puts the frame of the object '" + frame->id +
                               "', which others are in; MoveIt takes a pose of nothing but w: 1 "
                               "for none, and the pose of the one shape for it");
    frame->disputed_pose.reset();
  }
  return frame;
}

std::optional<FrameTree::InLink> FrameTree::OfObject(const std::string& name) const {
  const PlacedObjectFrame* frame = UseOfObject(name);
  if (frame == nullptr) return std::nullopt;
  const std::string& link = objects_.at(frame->id).link;
  return InLink{link, PoseOf(link).inverse(Eigen::Isometry) * frame->X_BF};
}

const Isometry3d& FrameTree::At(const std::string& name, const YamlNode& node) const {
  if (const PlacedObjectFrame* frame = UseOfObject(name)) return frame->X_BF;
  if (const Isometry3d* X_BF = Find(name)) return *X_BF;
  for (const std::string& id : expected_) {
    if (!(WithoutSlash(name) + "/").starts_with(id + "/")) continue;
    node.Fail("the frame '" + name + "' is that of an object that comes later, or of this one; " +
              "objects are in frames of those before them");
  }
  std::vector<std::string_view> known;
  for (const auto& [frame, X_BF] : X_BF_) known.push_back(frame);
  for (const auto& [frame, placed] : object_frames_) known.push_back(frame);
  const std::string nearest = NearestName(name, known);
  node.Fail("unknown frame '" + name +
            "': no link of the robot, no object, and no chain of "
            "fixed_frame_transforms leads there" +
            (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

}  // namespace planbench
