#include "report/shape_json.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "common/base64.h"

namespace planbench {
namespace {

constexpr double kMostSteps = 65535;  // that 16 bits hold

void AppendNumber(std::uint32_t number, int num_bytes, std::vector<std::uint8_t>* bytes) {
  for (int i = 0; i < num_bytes; ++i) {
    bytes->push_back(static_cast<std::uint8_t>(number >> (8 * i)));
  }
}

Json MeshJson(const SharedMesh& mesh) {
  std::vector<std::uint8_t> vertices;
  std::vector<std::uint8_t> triangles;
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  if (mesh.fault().empty()) {
    low = mesh.box().min();
    size = mesh.box().sizes();
    for (const Eigen::Vector3d& vertex : mesh->vertices) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double share = size[axis] > 0 ? (vertex[axis] - low[axis]) / size[axis] : 0;
        // Vertices of no triangle may be outside of the box.
        const double steps = std::round(kMostSteps * std::clamp(share, 0.0, 1.0));
        AppendNumber(static_cast<std::uint32_t>(steps), 2, &vertices);
      }
    }
    const int num_bytes = static_cast<double>(mesh->vertices.size()) - 1 > kMostSteps ? 4 : 2;
    for (const auto& triangle : mesh->triangles) {
      for (const std::uint32_t vertex : triangle) AppendNumber(vertex, num_bytes, &triangles);
    }
  }
  Json json;
  json["low"] = {low.x(), low.y(), low.z()};
  json["size"] = {size.x(), size.y(), size.z()};
  json["vertices"] = EncodeBase64(vertices);
  json["triangles"] = EncodeBase64(triangles);
  return json;
}

}  // namespace

double RoundedPosition(double value) { return std::round(1e5 * value) / 1e5; }

Json PointJson(const Eigen::Vector3d& p) {
  return {RoundedPosition(p.x()), RoundedPosition(p.y()), RoundedPosition(p.z())};
}

Json PoseJson(const Eigen::Isometry3d& X) {
  Json pose = Json::array();
  AppendPose(X, &pose);
  return pose;
}

void AppendPose(const Eigen::Isometry3d& X, Json* list) {
  const Eigen::Quaterniond q(X.linear());
  for (const double value : {X.translation().x(), X.translation().y(), X.translation().z(), q.x(),
                             q.y(), q.z(), q.w()}) {
    list->push_back(RoundedPosition(value));
  }
}

Json ShapeJson(const Shape& shape, Json* meshes) {
  Json json = {{"type", ShapeTypeName(shape)}};
  if (const auto* box = std::get_if<Box>(&shape)) json["size"] = PointJson(box->size);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) json["radius"] = sphere->radius;
  const auto round = [&](const auto* solid) {
    if (solid == nullptr) return;
    json["radius"] = solid->radius;
    json["length"] = solid->length;
  };
  round(std::get_if<Cylinder>(&shape));
  round(std::get_if<Cone>(&shape));
  round(std::get_if<Capsule>(&shape));
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const std::string& id = mesh->triangles.id();
    json["mesh"] = id;
    if (!meshes->contains(id)) (*meshes)[id] = MeshJson(mesh->triangles);
  }
  return json;
}

}  // namespace planbench
