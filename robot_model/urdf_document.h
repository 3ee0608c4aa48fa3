#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <map>
#include <set>
#include <string>

namespace planbench {

/// A parsed URDF and where its elements stand in the text, which urdfdom does not tell: it keeps
/// links and joints sorted by name.
struct UrdfDocument {
  urdf::ModelInterfaceSharedPtr model;
  std::map<std::string, int> link_lines;   ///< Line of each <link name="...">, from 1.
  std::map<std::string, int> joint_lines;  ///< Line of each <joint name="..." type="...">, from 1.
  std::map<std::string, int> material_lines;  ///< Where each was defined last.
  std::map<std::string, int> joint_order;     ///< Rank of each joint in the text.
  /// xyz of each joint's <axis>, as written: urdfdom reads none of fixed joints.
  std::map<std::string, std::string> joint_axes;
  /// Joints whose <safety_controller> gives that limit; the model has 0 where it is not given.
  std::set<std::string> with_soft_lower;
  std::set<std::string> with_soft_upper;
  /// Per link which of its collision bodies, from 0, are capsules; the model has cylinders there.
  std::map<std::string, std::set<int>> capsules;
};

/// Parses URDF text, of version 1.0 to 1.2, with urdfdom. Throws InputError with what urdfdom
/// reported (it is not printed), and for what it would not report: text that is no UTF-8, xacro
/// that is not expanded, a second element where one counts, links and joints without a name.
/// `origin` names the text.
UrdfDocument ParseUrdfDocument(const std::string& urdf_text, const std::string& origin);

}  // namespace planbench
