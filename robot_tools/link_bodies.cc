#include "robot_tools/link_bodies.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <variant>

#include "common/error.h"
#include "robot_model/odd_size.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

// `filled`: holes; `solid`: what the mesh is without them.
void RemarkSurface(const std::string& link, const Mesh& mesh, int filled, const SolidMesh& solid,
                   const SayLine& say_line) {
  const auto say = [&](const std::string& what) {
    say_line(fmt::format("link '{}', {}: {}", link, mesh.resource, what));
  };
  const SolidMesh::Survey& survey = solid.survey();
  if (filled > 0) {
    say(fmt::format(
        "small holes are filled ({}), but for spheres inside: the parts that have them hold none",
        filled));
  }
  if (survey.components == survey.open) {
    say("is not closed: its surface is enclosed, and it has no inside");
  } else if (survey.open > 0) {
    say(
        fmt::format("{} of {} parts are not closed: their surface is enclosed, and they have no "
                    "inside",
                    survey.open, survey.components));
  }
  if (survey.not_oriented > 0) {
    say(
        fmt::format("the triangles of {} of {} parts disagree about where the outside is: inside "
                    "is where a ray out crosses them an odd number of times",
                    survey.not_oriented, survey.components));
  }
  if (survey.volume < 0) say("is turned inside out: what it encloses counts as its inside");
  const auto& vertices = mesh.triangles->vertices;
  const auto& triangles = mesh.triangles->triangles;
  const auto flat = std::ranges::count_if(triangles, [&](const auto& triangle) {
    const auto corner = [&](std::size_t i) -> const Vector3d& { return vertices[triangle[i]]; };
    return (corner(1) - corner(0)).cross(corner(2) - corner(0)).isZero(0);
  });
  if (flat > 0) say(fmt::format("{} of {} triangles have no area", flat, triangles.size()));
}

void Load(const Link& link, const ResourceResolver& resources, Mesh* mesh) {
  try {
    mesh->triangles = LoadMesh(resources.Resolve(mesh->resource), mesh->scale);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", link.where, error.what()));
  }
}

void LoadAndRemark(const Link& link, const ResourceResolver& resources, Shape* shape,
                   const SayLine& say) {
  if (auto* mesh = std::get_if<Mesh>(shape)) Load(link, resources, mesh);
  if (const auto odd = OddSize(link.name, *shape)) say(*odd);
}

bool IsMissing(const Shape& shape, const ResourceResolver& resources) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  if (mesh == nullptr) return false;
  try {
    resources.Resolve(mesh->resource);
  } catch (const InputError&) {
    return true;
  }
  return false;
}

LinkBody MakeBody(const Link& link, const std::vector<PlacedShape>& shapes, const SayLine& say) {
  LinkBody body;
  for (const PlacedShape& placed : shapes) {
    const int filled = body.Add(placed);
    if (const auto* mesh = std::get_if<Mesh>(&placed.shape)) {
      RemarkSurface(link.name, *mesh, filled, body.hulls().back()->inside(), say);
    }
  }
  return body;
}

}  // namespace

std::vector<std::vector<PlacedShape>> LoadLinkShapes(const RobotModel& model,
                                                     const ResourceResolver& resources,
                                                     const SayLine& say) {
  std::vector<std::vector<PlacedShape>> shapes;
  for (const Link& link : model.links()) {
    for (PlacedShape& placed : shapes.emplace_back(link.collision)) {
      LoadAndRemark(link, resources, &placed.shape, say);
    }
  }
  return shapes;
}

void RemarkSizes(const RobotModel& model, const ResourceResolver& resources, const SayLine& say) {
  for (const Link& link : model.links()) {
    for (PlacedShape placed : link.collision) {
      if (IsMissing(placed.shape, resources)) continue;
      try {
        LoadAndRemark(link, resources, &placed.shape, say);
      } catch (const InputError& error) {
        say(error.what());
      }
    }
  }
}

LinkBodies ReadLinkBodies(const RobotModel& model, const ResourceResolver& resources,
                          const SayLine& say) {
  const std::vector<std::vector<PlacedShape>> shapes = LoadLinkShapes(model, resources, say);
  LinkBodies read;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    LinkBody body = MakeBody(model.links()[i], shapes[i], say);
    if (body.empty()) continue;
    read.links.push_back(static_cast<int>(i));
    read.bodies.push_back(std::move(body));
  }
  return read;
}

std::vector<std::string> LinksDrawnOnly(const std::string& urdf_text) {
  std::vector<std::string> names;
  tinyxml2::XMLDocument document;
  document.Parse(urdf_text.data(), urdf_text.size());
  const tinyxml2::XMLElement* robot = document.RootElement();
  const auto* link = robot == nullptr ? nullptr : robot->FirstChildElement("link");
  for (; link != nullptr; link = link->NextSiblingElement("link")) {
    const char* name = link->Attribute("name");
    const bool is_drawn = link->FirstChildElement("visual") != nullptr;
    const bool has_body = link->FirstChildElement("collision") != nullptr;
    if (name != nullptr && is_drawn && !has_body) names.emplace_back(name);
  }
  return names;
}

std::vector<LinkSphere> ToLinkSpheres(const LinkBodies& links,
                                      const std::vector<std::vector<Ball>>& sets) {
  std::vector<LinkSphere> spheres;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    for (const Ball& ball : sets[i]) spheres.push_back({links.links[i], ball.center, ball.radius});
  }
  return spheres;
}

}  // namespace planbench
