#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include "common/random.h"
#include "geometry/shapes.h"

namespace planbench {

/// A grid of nu by nv points of a surface in two parameters from 0 to 1, as triangles. `close_u`
/// and `close_v` join the last row and column to the first.
inline TriangleMesh GridMesh(int nu, int nv, bool close_u, bool close_v,
                             const std::function<Eigen::Vector3d(double u, double v)>& point) {
  TriangleMesh mesh;
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      mesh.vertices.push_back(point(static_cast<double>(i) / (close_u ? nu : nu - 1),
                                    static_cast<double>(j) / (close_v ? nv : nv - 1)));
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i % nu * nv + j % nv); };
  for (int i = 0; i < (close_u ? nu : nu - 1); ++i) {
    for (int j = 0; j < (close_v ? nv : nv - 1); ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// A ring about the z axis: closed, not convex. 2 nu nv triangles.
inline TriangleMesh TorusMesh(double ring_radius, double tube_radius, int nu, int nv) {
  return GridMesh(nu, nv, true, true, [=](double u, double v) {
    const double a = 2 * std::numbers::pi * u;
    const double b = 2 * std::numbers::pi * v;
    const double rho = ring_radius + tube_radius * std::cos(b);
    return Eigen::Vector3d(rho * std::cos(a), rho * std::sin(a), tube_radius * std::sin(b));
  });
}

/// A sphere, whose triangles shrink to lines at the poles: those are left out. Closed, convex.
inline TriangleMesh SphereMesh(double radius, int nu, int nv) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, -radius}, {0, 0, radius}};
  for (int j = 1; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      const double a = 2 * std::numbers::pi * i / nu;
      const double b = std::numbers::pi * (static_cast<double>(j) / nv - 0.5);
      mesh.vertices.emplace_back(radius * std::cos(b) * std::cos(a),
                                 radius * std::cos(b) * std::sin(a), radius * std::sin(b));
    }
  }
  const auto at = [&](int j, int i) {
    return static_cast<std::uint32_t>(2 + (j - 1) * nu + i % nu);
  };
  for (int i = 0; i < nu; ++i) {
    mesh.triangles.push_back({0, at(1, i + 1), at(1, i)});
    mesh.triangles.push_back({1, at(nv - 1, i), at(nv - 1, i + 1)});
    for (int j = 1; j + 1 < nv; ++j) {
      mesh.triangles.push_back({at(j, i), at(j, i + 1), at(j + 1, i + 1)});
      mesh.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j + 1, i)});
    }
  }
  return mesh;
}

/// Half a cylinder's mantle about the z axis: a sheet, open on all sides.
inline TriangleMesh SheetMesh(double radius, double length, int nu, int nv) {
  return GridMesh(nu, nv, false, false, [=](double u, double v) {
    const double a = std::numbers::pi * u;
    return Eigen::Vector3d(radius * std::cos(a), radius * std::sin(a), length * (v - 0.5));
  });
}

/// A mesh moved, as one more part of another.
inline TriangleMesh Joined(TriangleMesh mesh, const TriangleMesh& other,
                           const Eigen::Vector3d& offset) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : other.vertices) mesh.vertices.push_back(vertex + offset);
  for (const auto& [a, b, c] : other.triangles) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
  return mesh;
}

inline TriangleMesh TurnedInsideOut(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  return mesh;
}

/// A point of a triangle of the mesh.
inline Eigen::Vector3d RandomSurfacePoint(const TriangleMesh& mesh, std::mt19937_64* random) {
  const auto& [a, b, c] = mesh.triangles[(*random)() % mesh.triangles.size()];
  double u = UniformFraction(random);
  double v = UniformFraction(random);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const Eigen::Vector3d& corner = mesh.vertices[a];
  return corner + u * (mesh.vertices[b] - corner) + v * (mesh.vertices[c] - corner);
}

/// Whether the mesh winds round a point: the sum of the solid angles of its triangles, by Van
/// Oosterom and Strackee's formula.
inline bool WindsRound(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double angle = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[i] - p;
    const Eigen::Vector3d b = mesh.vertices[j] - p;
    const Eigen::Vector3d c = mesh.vertices[k] - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(angle) > 2 * std::numbers::pi;
}

/// Wavefront OBJ text.
inline std::string MeshAsObj(const TriangleMesh& mesh) {
  std::string text;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    text += "v " + std::to_string(v.x()) + ' ' + std::to_string(v.y()) + ' ' +
            std::to_string(v.z()) + '\n';
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    text += "f " + std::to_string(a + 1) + ' ' + std::to_string(b + 1) + ' ' +
            std::to_string(c + 1) + '\n';
  }
  return text;
}

}  // namespace planbench
