#pragma once

#include <string>
#include <vector>

#include "robot_model/robot_folder.h"
#include "scene/scene.h"

namespace planbench {

/// Which pairs of bodies an engine checks. Excluded are pairs of links that are rigid to each
/// other, that the robot's allowed_pairs name, or that the scene's matrix allows, and those that a
/// joint connects (RobotModel::Joined), unless the robot's checked_pairs name them or an entry of
/// the matrix says that they may not touch; an attached object with its link, its touch links,
/// another object attached to the same link, and whatever the matrix allows by its id. Refers to
/// the robot and the scene, which must outlive it.
class PairRules {
 public:
  /// Throws InputError, naming the object, if an attached object is on an unknown link.
  PairRules(const Robot& robot, const Scene& scene);

  bool ChecksLinks(int link_a, int link_b) const;
  bool ChecksLinkWithObject(int link, const SceneObject& object) const;
  bool ChecksAttachedWithLink(const AttachedObject& attached, int link) const;
  bool ChecksAttachedWithObject(const AttachedObject& attached, const SceneObject& object) const;
  bool ChecksAttached(const AttachedObject& a, const AttachedObject& b) const;
  /// Index of the link an object is attached to.
  int LinkOf(const AttachedObject& attached) const;

 private:
  const std::string& LinkName(int link) const;

  const Robot* robot_;
  const Scene* scene_;
};

}  // namespace planbench
