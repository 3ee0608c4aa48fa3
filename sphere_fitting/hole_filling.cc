#include "sphere_fitting/hole_filling.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "common/disjoint_sets.h"
#include "geometry/degenerate_triangles.h"

namespace planbench {
namespace {

constexpr double kMostArea = 0.02;  // of the part's

using Index = std::uint32_t;
using Triangle = std::array<Index, 3>;

double Area(const TriangleMesh& mesh, const Triangle& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
  return (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).norm() / 2;
}

// The loops of edges that an odd number of triangles have, each as its vertices, run through
// against the triangles that are there.
std::vector<std::vector<Index>> Loops(const std::vector<Triangle>& triangles) {
  struct Edge {
    int triangles = 0;
    int balance = 0;  // Those that run from the lower vertex to the higher, less the others.
  };
  std::map<std::pair<Index, Index>, Edge> edges;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k];
      const Index b = t[(k + 1) % 3];
      Edge& edge = edges[std::minmax(a, b)];
      ++edge.triangles;
      edge.balance += a < b ? 1 : -1;
    }
  }
  // Every vertex is at an even number of odd edges, so that a walk ends where it began.
  std::map<Index, std::vector<Index>> next;
  for (const auto& [ends, edge] : edges) {
    if (edge.triangles % 2 == 0) continue;
    next[ends.first].push_back(ends.second);
    next[ends.second].push_back(ends.first);
  }
  std::vector<std::vector<Index>> loops;
  for (auto& [begin, unused] : next) {
    while (!unused.empty()) {
      std::vector<Index> loop = {begin};
      while (loop.size() == 1 || loop.back() != begin) {
        const Index from = loop.back();
        const Index to = next[from].back();
        next[from].pop_back();
        std::vector<Index>& back = next[to];
        back.erase(std::find(back.begin(), back.end(), from));
        loop.push_back(to);
      }
      loop.pop_back();
      const bool ascending = loop[0] < loop[1];
      if ((edges[std::minmax(loop[0], loop[1])].balance > 0) == ascending) {
        std::reverse(loop.begin(), loop.end());
      }
      loops.push_back(std::move(loop));
    }
  }
  return loops;
}

}  // namespace

int FillSmallHoles(TriangleMesh* mesh) {
  const std::vector<Triangle> surface = SurfaceTriangles(*mesh);
  const std::vector<std::vector<Index>> loops = Loops(surface);
  if (loops.empty()) return 0;
  DisjointSets parts(mesh->vertices.size());
  for (const auto& [a, b, c] : surface) {
    parts.Join(a, b);
    parts.Join(b, c);
  }
  std::map<std::size_t, double> area;
  for (const Triangle& t : surface) area[parts.Root(t[0])] += Area(*mesh, t);
  std::map<std::size_t, double> missing;
  std::map<std::size_t, std::vector<Triangle>> patches;
  std::map<std::size_t, int> holes;
  for (const std::vector<Index>& loop : loops) {
    const std::size_t part = parts.Root(loop.front());
    ++holes[part];
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      const Triangle t = {loop[0], loop[k], loop[k + 1]};
      missing[part] += Area(*mesh, t);
      patches[part].push_back(t);
    }
  }
  int filled = 0;
  for (const auto& [part, patch] : patches) {
    if (missing[part] > kMostArea * area[part]) continue;
    mesh->triangles.insert(mesh->triangles.end(), patch.begin(), patch.end());
    filled += holes[part];
  }
  return filled;
}

}  // namespace planbench
