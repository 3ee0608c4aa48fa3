#include "geometry/degenerate_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "common/disjoint_sets.h"

namespace planbench {
namespace {

using Corner = std::uint32_t;
using Ends = std::pair<Corner, Corner>;
using Corners = std::array<Corner, 3>;

std::array<Ends, 3> EdgesOf(const Corners& t) {
  return {std::minmax(t[0], t[1]), std::minmax(t[1], t[2]), std::minmax(t[2], t[0])};
}

/// The longest of all segments between ends of two that are on one line; nothing of others.
std::optional<Segment> OnOneLine(const Segment& a, const Segment& b) {
  const std::optional<Segment> longest = AsLine(a.a, a.b, b.a);
  return longest ? AsLine(longest->a, longest->b, b.b) : std::nullopt;
}

/// Leaves out those of some triangles, by place in the surface, that have an edge on no line to
/// themselves, and those that have one then.
void LeaveOutLoose(const std::set<std::size_t>& places, const std::map<Ends, std::size_t>& line_of,
                   std::vector<Corners>* surface) {
  struct Sharers {
    std::size_t count = 0;
    std::size_t sum = 0;  // of their places: of one alone, which it is
  };
  std::map<Ends, Sharers> sharers;
  for (std::size_t i = 0; i < surface->size(); ++i) {
    for (const Ends& ends : EdgesOf((*surface)[i])) {
      ++sharers[ends].count;
      sharers[ends].sum += i;
    }
  }
  std::vector<Ends> unshared;
  const auto note = [&](const Ends& ends, const Sharers& of_it) {
    if (of_it.count == 1 && !line_of.contains(ends)) unshared.push_back(ends);
  };
  for (const auto& [ends, of_it] : sharers) note(ends, of_it);
  while (!unshared.empty()) {
    const Sharers last = sharers.at(unshared.back());
    unshared.pop_back();
    if (last.count == 0 || !places.contains(last.sum)) continue;
    for (const Ends& ends : EdgesOf((*surface)[last.sum])) {
      Sharers& of_it = sharers.at(ends);
      --of_it.count;
      of_it.sum -= last.sum;
      note(ends, of_it);
    }
    (*surface)[last.sum] = {};
  }
  std::erase(*surface, Corners{});
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

std::vector<Corners> SurfaceTriangles(const TriangleMesh& mesh) {
  std::vector<Corners> surface;
  std::set<std::size_t> apart;                // Slivers in no row, by place in the surface.
  DisjointSets lines(mesh.triangles.size());  // Slivers that share edges, by place in the mesh.
  std::map<std::size_t, Segment> extents;     // Of a line, by its root.
  std::map<Ends, std::size_t> line_of;        // Of each edge of slivers, any of the line.
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    const std::array<Ends, 3> edges = EdgesOf(t);
    std::optional<Segment> extent =
        AsLine(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    const bool is_sliver = extent.has_value();
    for (const Ends& ends : edges) {
      if (!extent) break;
      const auto line = line_of.find(ends);
      if (line == line_of.end()) continue;
      extent = OnOneLine(*extent, extents.at(lines.Root(line->second)));
    }
    if (!extent) {
      if (is_sliver) apart.insert(surface.size());
      surface.push_back(t);
      continue;
    }
    for (const Ends& ends : edges) lines.Join(line_of.try_emplace(ends, i).first->second, i);
    extents.emplace(i, *extent);
  }
  if (extents.empty()) return surface;
  if (!apart.empty()) LeaveOutLoose(apart, line_of, &surface);
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
