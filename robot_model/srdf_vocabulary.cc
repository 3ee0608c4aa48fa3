#include "robot_model/srdf_vocabulary.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <map>
#include <set>

namespace planbench {
namespace {

// Elements by the path to them, and their attributes.
using SrdfVocabulary = std::map<std::string, std::set<std::string>>;

const SrdfVocabulary& KnownSrdf() {
  static const SrdfVocabulary kKnown = {
      {"robot", {"name", "version"}},
      {"robot/group", {"name"}},
      {"robot/group/joint", {"name"}},
      {"robot/group/link", {"name"}},
      {"robot/group/group", {"name"}},
      {"robot/group/chain", {"base_link", "tip_link"}},
      {"robot/group/passive_joint", {"name"}},
      {"robot/group_state", {"name", "group"}},
      {"robot/group_state/joint", {"name", "value"}},
      {"robot/end_effector", {"name", "group", "parent_link", "parent_group"}},
      {"robot/virtual_joint", {"name", "type", "parent_frame", "child_link"}},
      {"robot/passive_joint", {"name"}},
      {"robot/disable_collisions", {"link1", "link2", "reason"}},
      {"robot/enable_collisions", {"link1", "link2", "reason"}},
      {"robot/disable_default_collisions", {"link", "reason"}},
      {"robot/link_sphere_approximation", {"link"}},
      {"robot/link_sphere_approximation/sphere", {"center", "radius"}},
      {"robot/joint_property", {"joint_name", "property_name", "value"}}};
  return kKnown;
}

void FindUnknown(const tinyxml2::XMLElement& element, const std::string& path,
                 const std::string& origin, std::vector<std::string>* unknown) {
  const std::set<std::string>& attributes = KnownSrdf().at(path);
  for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const std::string name = a->Name();
    const bool is_foreign = name == "xmlns" || name.find(':') != name.npos;
    if (is_foreign || attributes.contains(name)) continue;
    unknown->push_back(
        fmt::format("{}:{}: the attribute '{}' of <{}> is not known and does not count", origin,
                    a->GetLineNum(), name, element.Name()));
  }
  for (const tinyxml2::XMLElement* e = element.FirstChildElement(); e != nullptr;
       e = e->NextSiblingElement()) {
    const std::string path_of_child = path + "/" + e->Name();
    if (KnownSrdf().contains(path_of_child)) {
      FindUnknown(*e, path_of_child, origin, unknown);
    } else {
      unknown->push_back(fmt::format("{}:{}: <{}> is not known in <{}> and does not count", origin,
                                     e->GetLineNum(), e->Name(), element.Name()));
    }
  }
}

}  // namespace

std::vector<std::string> UnknownParts(const tinyxml2::XMLElement& robot,
                                      const std::string& origin) {
  std::vector<std::string> unknown;
  FindUnknown(robot, "robot", origin, &unknown);
  return unknown;
}

}  // namespace planbench
