#include "geometry/degenerate_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "common/disjoint_sets.h"

namespace planbench {
namespace {

using Corner = std::uint32_t;
using Ends = std::pair<Corner, Corner>;

/// The longest of all segments between ends of two that are on one line; nothing of others.
std::optional<Segment> OnOneLine(const Segment& a, const Segment& b) {
  const std::optional<Segment> longest = AsLine(a.a, a.b, b.a);
  return longest ? AsLine(longest->a, longest->b, b.b) : std::nullopt;
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
  std::vector<std::array<Corner, 3>> surface;
  DisjointSets lines(mesh.triangles.size());  // Slivers that share edges, by place in the mesh.
  std::map<std::size_t, Segment> extents;     // Of a line, by its root.
  std::map<Ends, std::size_t> line_of;        // Of each edge of slivers, any of the line.
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    const std::array<Ends, 3> edges = {std::minmax(t[0], t[1]), std::minmax(t[1], t[2]),
                                       std::minmax(t[2], t[0])};
    std::optional<Segment> extent =
        AsLine(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    for (const Ends& ends : edges) {
      if (!extent) break;
      const auto line = line_of.find(ends);
      if (line == line_of.end()) continue;
      extent = OnOneLine(*extent, extents.at(lines.Root(line->second)));
    }
    if (!extent) {
      surface.push_back(t);
      continue;
    }
    for (const Ends& ends : edges) lines.Join(line_of.try_emplace(ends, i).first->second, i);
    extents.emplace(i, *extent);
  }
  if (extents.empty()) return surface;
  DisjointSets parts(mesh.vertices.size());
  for (const auto& [a, b, c] : surface) {
    parts.Join(a, b);
    parts.Join(b, c);
  }
  // On a line, edges cover every place of it an even number of times if an even number of them ends
  // in every corner: so it is once each goes by way of one and the same corner.
  std::map<std::pair<std::size_t, std::size_t>, Corner> hubs;  // By line and part.
  for (std::size_t i = 0, end = surface.size(); i < end; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner a = surface[i][k];
      const Corner b = surface[i][(k + 1) % 3];
      const auto line = line_of.find(std::minmax(a, b));
      if (line == line_of.end()) continue;
      const Corner hub =
          hubs.try_emplace({lines.Root(line->second), parts.Root(a)}, a).first->second;
      if (hub != a && hub != b) surface.push_back({b, a, hub});
    }
  }
  return surface;
}

}  // namespace planbench
