#include "robot_tools/link_bodies.h"

#include <fmt/format.h>

#include <limits>
#include <utility>
#include <variant>

#include "common/error.h"

namespace planbench {
namespace {

using Eigen::Vector3d;

// Links are larger than a millimetre and smaller than this, m.
constexpr double kLeastExtent = 1e-3;
constexpr double kGreatestExtent = 20;

// `filled`: holes; `solid`: what the mesh is without them.
void Remark(const std::string& link, const Mesh& mesh, int filled, const SolidMesh& solid,
            std::vector<std::string>* remarks) {
  const auto say = [&](const std::string& what) {
    remarks->push_back(fmt::format("link '{}', {}: {}", link, mesh.resource, what));
  };
  const SolidMesh::Survey& survey = solid.survey();
  if (filled > 0) {
    say(
        fmt::format("{} small holes are filled, but for spheres inside: the parts that have them "
                    "hold none",
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
    say(fmt::format(
        "the triangles of {} of {} parts disagree about where the outside is: inside is "
        "where a ray out crosses them an odd number of times",
        survey.not_oriented, survey.components));
  }
  if (survey.volume < 0) say("is turned inside out: what it encloses counts as its inside");
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  std::size_t flat = 0;
  const TriangleMesh& triangles = mesh.triangles;
  for (const auto& [a, b, c] : triangles.triangles) {
    const Vector3d& corner = triangles.vertices[a];
    for (const std::uint32_t v : {a, b, c}) {
      low = low.cwiseMin(triangles.vertices[v]);
      high = high.cwiseMax(triangles.vertices[v]);
    }
    const Vector3d normal = (triangles.vertices[b] - corner).cross(triangles.vertices[c] - corner);
    if (normal.isZero(0)) ++flat;
  }
  if (flat > 0) {
    say(fmt::format("{} of {} triangles have no area", flat, triangles.triangles.size()));
  }
  const double extent = (high - low).maxCoeff();
  if (extent < kLeastExtent || extent > kGreatestExtent) {
    say(fmt::format("is {:.3g} m large: check its unit, and scale= in the URDF", extent));
  }
}

}  // namespace

LinkBodies ReadLinkBodies(const RobotModel& model, const ResourceResolver& resources) {
  LinkBodies read;
  for (int index = 0; index < model.num_links(); ++index) {
    const Link& link = model.links()[static_cast<std::size_t>(index)];
    LinkBody body;
    for (PlacedShape placed : link.collision) {
      auto* mesh = std::get_if<Mesh>(&placed.shape);
      int filled = 0;
      try {
        if (mesh != nullptr) {
          mesh->triangles = LoadMesh(resources.Resolve(mesh->resource), mesh->scale);
        }
        filled = body.Add(placed);
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", link.where, error.what()));
      }
      if (mesh != nullptr) {
        Remark(link.name, *mesh, filled, body.hulls().back()->inside(), &read.remarks);
      } else if (const double extent = 2 * ComputeBoundingSphere(placed.shape).radius;
                 extent > kGreatestExtent) {
        read.remarks.push_back(fmt::format(
            "link '{}': a shape is {:.3g} m large: URDFs are in metres", link.name, extent));
      }
    }
    if (body.empty()) continue;
    read.links.push_back(index);
    read.bodies.push_back(std::move(body));
  }
  return read;
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
