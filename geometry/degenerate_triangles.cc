#include "geometry/degenerate_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

namespace planbench {
namespace {

using Corner = std::uint32_t;
using Ends = std::pair<Corner, Corner>;

struct EdgeOfSlivers {
  bool is_odd = false;  // So is the number of triangles that have it.
  std::vector<std::size_t> slivers;
};

std::array<Ends, 3> EdgesOf(const std::array<Corner, 3>& t) {
  return {std::minmax(t[0], t[1]), std::minmax(t[1], t[2]), std::minmax(t[2], t[0])};
}

}  // namespace

std::optional<Segment> AsLine(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                              const Eigen::Vector3d& c) {
  const std::array<Segment, 3> edges = {Segment{a, b}, Segment{b, c}, Segment{c, a}};
  const auto length2 = [](const Segment& edge) { return (edge.b - edge.a).squaredNorm(); };
  const Segment& longest = *std::ranges::max_element(edges, {}, length2);
  if ((b - a).cross(c - b).norm() > 1e-6 * length2(longest)) return std::nullopt;
  return longest;
}

std::vector<std::array<Corner, 3>> SurfaceTriangles(const TriangleMesh& mesh) {
  std::vector<std::array<Corner, 3>> triangles;
  std::map<Ends, EdgeOfSlivers> edges;
  std::set<std::size_t> open;  // Slivers that may have to go.
  for (const auto& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    if (AsLine(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]])) {
      open.insert(triangles.size());
      for (const Ends& ends : EdgesOf(t)) edges[ends].slivers.push_back(triangles.size());
    }
    triangles.push_back(t);
  }
  if (open.empty()) return triangles;
  for (const auto& t : triangles) {
    for (const Ends& ends : EdgesOf(t)) {
      const auto edge = edges.find(ends);
      if (edge != edges.end()) edge->second.is_odd = !edge->second.is_odd;
    }
  }
  std::set<std::size_t> gone;
  while (!open.empty()) {
    const std::size_t sliver = *open.begin();
    open.erase(open.begin());
    const std::array<Ends, 3> all_ends = EdgesOf(triangles[sliver]);
    const auto num_odd =
        std::ranges::count_if(all_ends, [&](const Ends& ends) { return edges[ends].is_odd; });
    if (num_odd < 2) continue;
    gone.insert(sliver);
    for (const Ends& ends : all_ends) {
      EdgeOfSlivers& edge = edges[ends];
      edge.is_odd = !edge.is_odd;
      std::erase(edge.slivers, sliver);
      if (edge.is_odd) open.insert(edge.slivers.begin(), edge.slivers.end());
    }
  }
  std::vector<std::array<Corner, 3>> kept;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!gone.contains(t)) kept.push_back(triangles[t]);
  }
  return kept;
}

}  // namespace planbench
