#pragma once

#include <fmt/format.h>

#include <string>

#include "geometry/shapes.h"

namespace planbench {

/// A mesh as an OBJ file has it.
inline std::string ObjText(const TriangleMesh& mesh) {
  std::string text;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
  }
  for (const auto& t : mesh.triangles) {
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

}  // namespace planbench
