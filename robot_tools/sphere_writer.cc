#include "robot_tools/sphere_writer.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include "common/yaml_text.h"

namespace planbench {
namespace {

using tinyxml2::XMLElement;

const std::string& LinkName(const RobotModel& model, int link) {
  return model.links()[static_cast<std::size_t>(link)].name;
}

std::string Triple(const Eigen::Vector3d& p) {
  return fmt::format("{} {} {}", p.x() + 0.0, p.y() + 0.0, p.z() + 0.0);
}

std::string Printed(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace

std::string SpheresYaml(const RobotModel& model, const std::vector<LinkSphere>& spheres,
                        const std::vector<std::string>& comment) {
  std::string yaml;
  for (const std::string& line : comment) yaml += fmt::format("# {}\n", line);
  yaml += "# Centres and radii in m, in each link's frame.\nlinks:\n";
  int link = -1;
  for (const LinkSphere& sphere : spheres) {
    if (sphere.link != link) yaml += fmt::format("  {}:\n", YamlText(LinkName(model, sphere.link)));
    link = sphere.link;
    const Eigen::Vector3d& p = sphere.p_LS;
    yaml += fmt::format("    - {{center: [{}, {}, {}], radius: {}}}\n", YamlNumber(p.x()),
                        YamlNumber(p.y()), YamlNumber(p.z()), YamlNumber(sphere.radius));
  }
  return yaml;
}

std::string SpheresSrdf(const RobotModel& model, const std::vector<LinkSphere>& spheres) {
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  XMLElement* robot = document.NewElement("robot");
  robot->SetAttribute("name", model.name().c_str());
  document.InsertEndChild(robot);
  XMLElement* approximation = nullptr;
  int link = -1;
  for (const LinkSphere& sphere : spheres) {
    if (sphere.link != link) {
      approximation = robot->InsertNewChildElement("link_sphere_approximation");
      approximation->SetAttribute("link", LinkName(model, sphere.link).c_str());
    }
    link = sphere.link;
    XMLElement* element = approximation->InsertNewChildElement("sphere");
    element->SetAttribute("center", Triple(sphere.p_LS).c_str());
    element->SetAttribute("radius", fmt::format("{}", sphere.radius).c_str());
  }
  return Printed(document);
}

std::string SpheresUrdf(const std::string& urdf_text, const RobotModel& model,
                        const std::vector<LinkSphere>& spheres) {
  tinyxml2::XMLDocument document;
  document.Parse(urdf_text.c_str(), urdf_text.size());
  XMLElement* robot = document.FirstChildElement("robot");
  for (XMLElement* link = robot->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    while (XMLElement* collision = link->FirstChildElement("collision")) {
      link->DeleteChild(collision);
    }
    const int index = model.FindLink(link->Attribute("name"));
    for (const LinkSphere& sphere : spheres) {
      if (sphere.link != index) continue;
      XMLElement* collision = link->InsertNewChildElement("collision");
      collision->InsertNewChildElement("origin")->SetAttribute("xyz", Triple(sphere.p_LS).c_str());
      collision->InsertNewChildElement("geometry")
          ->InsertNewChildElement("sphere")
          ->SetAttribute("radius", fmt::format("{}", sphere.radius).c_str());
    }
  }
  return Printed(document);
}

}  // namespace planbench
