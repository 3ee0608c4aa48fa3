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
  std::set<std::pair<int, std::size_t>> open;  // Slivers that may have to go, by rank.
  for (const auto& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    if (AsLine(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]])) {
      open.emplace(0, triangles.size());
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
  // Whatever is closed, no sliver is part of it that has an odd edge for itself. Of several that
  // share one any may be the one too many: rather that with three such edges.
  constexpr int kStays = 3;
  const auto rank_of = [&](std::size_t sliver) {
    if (gone.contains(sliver)) return kStays;
    int num_odd = 0;
    for (const Ends& ends : EdgesOf(triangles[sliver])) {
      const EdgeOfSlivers& edge = edges[ends];
      if (!edge.is_odd) continue;
      if (edge.slivers.size() == 1) return 0;
      ++num_odd;
    }
    return num_odd < 2 ? kStays : 4 - num_odd;
  };
  while (!open.empty()) {
    const auto [rank, sliver] = *open.begin();
    open.erase(open.begin());
    if (const int now = rank_of(sliver); now > rank) {
      if (now < kStays) open.emplace(now, sliver);
      continue;
    }
    gone.insert(sliver);
    for (const Ends& ends : EdgesOf(triangles[sliver])) {
      EdgeOfSlivers& edge = edges[ends];
      edge.is_odd = !edge.is_odd;
      std::erase(edge.slivers, sliver);
      if (!edge.is_odd) continue;
      for (const std::size_t other : edge.slivers) open.emplace(0, other);
    }
  }
  std::vector<std::array<Corner, 3>> kept;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!gone.contains(t)) kept.push_back(triangles[t]);
  }
  return kept;
}

}  // namespace planbench
