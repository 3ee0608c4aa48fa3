#pragma once

#include <utility>
#include <vector>

#include "planning/path_library.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// Of the robot's first group, learned from the sets "posts" and "walls".
inline PathLibrary LibraryOf(const Robot& robot, std::vector<Path> paths) {
  PathLibrary library{{}, {"posts", "walls"}, std::move(paths)};
  for (const JointSpace::Joint& joint : robot.groups.front().space.joints()) {
    library.joints.push_back(joint.name);
  }
  return library;
}

}  // namespace planbench
