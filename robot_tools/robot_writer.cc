#include "robot_tools/robot_writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/enum_names.h"
#include "common/error.h"
#include "common/write_file.h"
#include "common/yaml_text.h"
#include "robot_tools/sphere_writer.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLineWidth = 100;

// "[a, b, c]", broken into lines that are indented by `indent`.
std::string List(const std::vector<std::string>& elements, std::size_t indent) {
  std::string text = "[";
  std::size_t column = indent;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string element = elements[i] + (i + 1 < elements.size() ? "," : "]");
    if (i > 0 && column + element.size() + 1 > kLineWidth) {
      text += '\n';
      text.append(indent, ' ');
      column = indent;
    } else if (i > 0) {
      text += ' ';
      ++column;
    }
    text += element;
    column += element.size();
  }
  return elements.empty() ? "[]" : text;
}

std::vector<std::string> Numbers(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(YamlNumber(value));
  return texts;
}

std::string LinkYaml(const RobotModel& model, int link) {
  return YamlText(model.links()[static_cast<std::size_t>(link)].name);
}

std::string GroupYaml(const PlanningGroup& group, const RobotModel& model) {
  std::vector<std::string> joints;
  for (const JointSpace::Joint& joint : group.space.joints())
    joints.push_back(YamlText(joint.name));
  std::vector<std::string> tips;
  for (const int tip : group.tips()) tips.push_back(LinkYaml(model, tip));
  std::string yaml =
      fmt::format("  - name: {}\n    joints: {}\n    tip_link: {}\n", YamlText(group.name),
                  List(joints, 13), tips.size() == 1 ? tips.front() : List(tips, 15));
  if (!group.states.empty()) yaml += "    states:  # rad or m, in the order of the joints\n";
  for (const auto& [name, q] : group.states) {
    yaml += fmt::format("      {}: {}\n", YamlText(name), List(Numbers(q), 8));
  }
  return yaml;
}

std::string VirtualJointsYaml(const Robot& robot) {
  if (robot.virtual_joints.empty()) return "";
  std::string yaml = "\n# How the robot stands in its surroundings.\nvirtual_joints:\n";
  for (const VirtualJoint& joint : robot.virtual_joints) {
    yaml += fmt::format("  - {{name: {}, type: {}, parent_frame: {}, child_link: {}}}\n",
                        YamlText(joint.name), EnumName(joint.type), YamlText(joint.parent_frame),
                        LinkYaml(robot.model, joint.child_link));
  }
  return yaml;
}

std::string PairList(const std::vector<std::pair<int, int>>& pairs, const RobotModel& model) {
  std::string yaml;
  for (const auto& [a, b] : pairs) {
    yaml += fmt::format("  - [{}, {}]\n", LinkYaml(model, a), LinkYaml(model, b));
  }
  return yaml;
}

std::string ExemptPairsYaml(const RobotDraft& draft) {
  std::string yaml;
  for (const RobotDraft::ExemptPairs& exempt : draft.exempt) {
    if (!exempt.pairs.empty()) yaml += fmt::format("  # {}\n", exempt.reason);
    yaml += PairList(exempt.pairs, draft.robot.model);
  }
  return yaml;
}

}  // namespace

std::string RobotYaml(const RobotDraft& draft) {
  const Robot& robot = draft.robot;
  std::string yaml = fmt::format(
      "# Made by make_robot from {}. Paths are relative to this folder.\n", draft.origin);
  yaml += fmt::format("name: {}\nurdf: {}\n", YamlText(robot.name), YamlText(robot.name + ".urdf"));
  if (!robot.spheres.empty()) yaml += "spheres: spheres.yaml\n";
  yaml += fmt::format(
      "\n# No point of the robot moves further than this, m, between two configurations that an "
      "edge "
      "is\n# checked at, where edges are sampled (fixed) and not proven (certified).\n"
      "edge_resolution_m: {}\nedge_check: {}\n\ngroups:\n",
      YamlNumber(robot.edge_resolution_m), EnumName(robot.edge_check));
  for (const PlanningGroup& group : robot.groups) yaml += GroupYaml(group, robot.model);
  yaml += VirtualJointsYaml(robot);
  const std::string pairs = ExemptPairsYaml(draft);
  if (!pairs.empty()) yaml += "\n# Never checked against each other.\nallowed_pairs:\n" + pairs;
  if (!robot.checked_pairs.empty()) {
    yaml +=
        "\n# Checked though a joint connects them: the SRDF does not disable them.\n"
        "checked_pairs:\n" +
        PairList(robot.checked_pairs, robot.model);
  }
  if (!draft.links_without_spheres.empty()) {
    std::vector<std::string> links;
    for (const std::string& link : draft.links_without_spheres) links.push_back(YamlText(link));
    yaml += fmt::format(
        "\n# Have a body in the URDF that is not checked.\nlinks_without_spheres:\n  {}\n",
        List(links, 3));
  }
  return yaml;
}

fs::path UrdfPath(const RobotDraft& draft, const fs::path& folder) {
  return folder / (draft.robot.name + ".urdf");
}

void WriteRobotFolder(const RobotDraft& draft, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError("cannot make the folder " + folder.string());
  WriteFile(UrdfPath(draft, folder), draft.urdf_text);
  if (!draft.robot.spheres.empty())
    WriteFile(folder / "spheres.yaml", SpheresYaml(draft.robot.model, draft.robot.spheres, {}));
  WriteFile(folder / "robot.yaml", RobotYaml(draft));
}

}  // namespace planbench
