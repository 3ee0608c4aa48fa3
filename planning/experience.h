#pragma once

#include <map>
#include <string>

#include "common/yaml.h"
#include "planning/path_library.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// The paths that a planner's setting `experience` names.
class Experience {
 public:
  /// `setting`: the file, from the robot folder (ReadNamedFile). Throws InputError as
  /// ReadPathLibrary does.
  Experience(const Robot& robot, const YamlNode& setting);

  /// The paths, null if they are of other joints.
  const PathLibrary* For(const JointSpace& space) const {
    return library_.Fits(space) ? &library_ : nullptr;
  }
  /// Adds what is known beyond the file's name: its content and what it was learned from.
  void Describe(std::map<std::string, std::string>* settings) const;

 private:
  PathLibrary library_;
  std::string id_;  // The file may change while its name stays.
};

/// Reads the setting `recall`: how many known paths a request uses at most. Throws InputError if it
/// is out of range, and where the setting `experience` names no file, so that it would do nothing.
int ReadRecall(const YamlNode& node, const std::string& experience);

}  // namespace planbench
