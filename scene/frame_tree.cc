#include "scene/frame_tree.h"

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
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

FrameTree::FrameTree(const Robot& robot, const Stance& stance, const std::string& planning_frame,
                     const std::vector<FixedTransform>& transforms)
    : not_of_objects_{planning_frame} {
  const std::vector<Isometry3d> X_BL = ComputeLinkPoses(robot.model, stance.positions);
  for (int link = 0; link < robot.model.num_links(); ++link) {
    const auto l = static_cast<std::size_t>(link);
    X_BF_[robot.model.links()[l].name] = X_BL[l];
    not_of_objects_.insert(robot.model.links()[l].name);
  }
  std::vector<FixedTransform> named = transforms;  // With the planning frame by its name.
  for (FixedTransform& transform : named) {
    if (transform.header.empty()) transform.header = planning_frame;
  }
  // What the file says comes before what the robot's description says, and that before what is
  // taken where neither says anything.
  Follow(named);
  for (const PlacedLink& placed : stance.placed_links) {
    Place(placed, placed.frame.empty() ? planning_frame : placed.frame, robot.model);
  }
  Follow(named);
  PlaceSurroundings(robot);
  Follow(named);
  X_BF_.try_emplace(planning_frame, Isometry3d::Identity());
  X_BF_[""] = X_BF_.at(planning_frame);
  Follow(named);
  CheckAgreement(named);
}

void FrameTree::Place(const PlacedLink& placed, const std::string& frame, const RobotModel& model) {
  const std::string& link = model.links()[static_cast<std::size_t>(placed.link)].name;
  const Isometry3d X_BF = X_BF_.at(link) * placed.X_FL.inverse(Eigen::Isometry);
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
    X_BF_.try_emplace(frame, X_BF_.at(link));
    not_of_objects_.insert(frame);
  }
}

void FrameTree::MoveToBaseOf(const FrameTree& other, const std::string& still) {
  const Isometry3d& X_OF = *other.Find(still);
  const Isometry3d& X_BF = *Find(still);
  // Not to round what has not moved.
  if (X_OF.matrix() == X_BF.matrix()) return;
  const Isometry3d X_OB = X_OF * X_BF.inverse(Eigen::Isometry);
  for (auto& [name, X] : X_BF_) X = X_OB * X;
}

void FrameTree::Follow(const std::vector<FixedTransform>& transforms) {
  for (bool progress = true; progress;) {
    progress = false;
    for (const FixedTransform& transform : transforms) {
      const Isometry3d* header = Find(transform.header);
      const Isometry3d* child = Find(transform.child);
      if ((header == nullptr) == (child == nullptr)) continue;
      const std::string& unknown = header == nullptr ? transform.header : transform.child;
      const Isometry3d X_BF = (header == nullptr ? *child : *header) * transform.X;
      X_BF_[unknown] = X_BF;
      progress = true;
    }
  }
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
                          const std::map<std::string, Isometry3d>& X_LF) {
  RemoveObject(id);
  ObjectFrames& object = objects_[id];
  object.link = link;
  for (const auto& [name, X] : X_LF) {
    if (not_of_objects_.contains(name)) continue;
    object.X_LF[name] = X;
    X_BF_[name] = PoseOf(link) * X;
  }
}

void FrameTree::AttachObject(const std::string& id, const std::string& link) {
  ObjectFrames& object = objects_[id];
  const Isometry3d X_NO = PoseOf(link).inverse(Eigen::Isometry) * PoseOf(object.link);
  for (auto& [name, X] : object.X_LF) X = X_NO * X;
  object.link = link;
}

void FrameTree::RemoveObject(const std::string& id) {
  const auto object = objects_.find(id);
  if (object == objects_.end()) return;
  for (const auto& [name, X] : object->second.X_LF) X_BF_.erase(name);
  objects_.erase(object);
}

void FrameTree::SetObjectsOf(const FrameTree& other) {
  for (const auto& [id, object] : other.objects_) SetObject(id, object.link, object.X_LF);
}

Isometry3d FrameTree::PoseOf(const std::string& link) const {
  return link.empty() ? Isometry3d::Identity() : X_BF_.at(link);
}

const Isometry3d* FrameTree::Find(const std::string& name) const {
  const auto found = X_BF_.find(WithoutSlash(name));
  return found == X_BF_.end() ? nullptr : &found->second;
}

const Isometry3d& FrameTree::At(const std::string& name, const YamlNode& node) const {
  if (const Isometry3d* X_BF = Find(name)) return *X_BF;
  std::vector<std::string_view> known;
  for (const auto& [frame, X_BF] : X_BF_) known.push_back(frame);
  const std::string nearest = NearestName(name, known);
  node.Fail("unknown frame '" + name +
            "': no link of the robot, no object, and no chain of "
            "fixed_frame_transforms leads there" +
            (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

}  // namespace planbench
