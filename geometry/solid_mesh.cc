#include "geometry/solid_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "common/disjoint_sets.h"
#include "geometry/degenerate_triangles.h"
#include "geometry/lexicographic_less.h"

namespace planbench {
namespace {

/// Where the plane of a y cuts an edge.
struct Cut {
  double x = 0;
  double z = 0;
};

/// Of an edge that spans the y. The ends are ordered first, so that triangles sharing an edge agree
/// to the last bit and a ray cannot slip between them. x is between theirs, so that the grid has
/// the edge's triangles in the cell of it.
Cut CutAt(double y, Eigen::Vector3d from, Eigen::Vector3d to) {
  if (LexicographicLess(to, from)) std::swap(from, to);
  const double share = (y - from.y()) / (to.y() - from.y());
  return {std::min(from.x() + share * (to.x() - from.x()), to.x()),
          from.z() + share * (to.z() - from.z())};
}

/// 1 if the ray along +z from the point passes the triangle from its back to its front, -1 the
/// other way, 0 if it does not. Where the ray passes an edge or vertex so closely that rounding
/// decides which triangles it meets, these still count for one another, since all have the edge's
/// one cut, and each is met between its own cuts. So they are met within rounding of the surface,
/// however thin or edge-on they are, and no point further from it is told wrongly.
int Crossing(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             const Eigen::Vector3d& c) {
  const Eigen::Vector3d* const corners[] = {&a, &b, &c, &a};
  Cut rising, falling;  // The edges that span y: one of either, or none.
  for (int k = 0; k < 3; ++k) {
    const bool rises = corners[k + 1]->y() > point.y();
    if ((corners[k]->y() > point.y()) == rises) continue;
    (rises ? rising : falling) = CutAt(point.y(), *corners[k], *corners[k + 1]);
  }
  const bool upwards = point.x() < rising.x;
  if (upwards == (point.x() < falling.x)) return 0;
  const double share = (point.x() - falling.x) / (rising.x - falling.x);
  const double height = falling.z + share * (rising.z - falling.z);
  if (height <= point.z()) return 0;
  return upwards ? 1 : -1;
}

}  // namespace

SolidMesh::SolidMesh(const TriangleMesh& mesh) {
  struct Less {
    bool operator()(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
      return LexicographicLess(a, b);
    }
  };
  std::map<Eigen::Vector3d, std::uint32_t, Less> index_of;
  std::vector<std::uint32_t> joined_index;
  TriangleMesh joined;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    const auto next = static_cast<std::uint32_t>(joined.vertices.size());
    const auto [entry, is_new] = index_of.emplace(vertex, next);
    if (is_new) joined.vertices.push_back(vertex);
    joined_index.push_back(entry->second);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    joined.triangles.push_back({joined_index[a], joined_index[b], joined_index[c]});
  }

  struct Edge {
    int triangles = 0;
    int balance = 0;  // triangles that run along it less those that run against it
  };
  struct Edges {
    Edge all;
    Edge once;  // of triangles with the same corners the first alone
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Edges> edges;
  std::set<std::array<std::uint32_t, 3>> corners;
  std::vector<bool> is_copy;
  DisjointSets parts(joined.vertices.size());
  std::vector<Triangle> all;
  std::vector<std::uint32_t> vertex_of;  // one vertex of each triangle
  // Vertices, of what component_points_ tells of.
  std::vector<bool> known(joined.vertices.size(), false);
  for (const auto& v : SurfaceTriangles(joined)) {
    all.push_back({joined.vertices[v[0]], joined.vertices[v[1]], joined.vertices[v[2]], true});
    vertex_of.push_back(v[0]);
    auto sorted = v;
    std::ranges::sort(sorted);
    is_copy.push_back(!corners.insert(sorted).second);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = v[k];
      const std::uint32_t b = v[(k + 1) % 3];
      Edges& of_both = edges[std::minmax(a, b)];
      for (Edge* const edge : {&of_both.all, &of_both.once}) {
        if (is_copy.back() && edge == &of_both.once) continue;
        ++edge->triangles;
        edge->balance += a < b ? 1 : -1;
      }
      parts.Join(a, b);
      known[a] = true;
    }
  }

  struct Form {
    bool closed = true;
    bool oriented = true;

    void Add(const Edge& edge) {
      if (edge.triangles % 2 != 0) closed = false;
      if (edge.balance != 0) oriented = false;
    }
  };
  struct Component {
    bool seen = false;
    Form all;
    Form once;

    // Faces that are there twice, often one for either side, neither open nor undo what they are
    // faces of; but of two solids that share one each needs its own.
    const Form& form() const { return once.closed ? once : all; }
  };
  std::vector<Component> components(joined.vertices.size());  // by root vertex
  for (const auto& [ends, of_both] : edges) {
    Component& component = components[parts.Root(ends.first)];
    component.all.Add(of_both.all);
    component.once.Add(of_both.once);
  }
  for (std::size_t t = 0; t < all.size(); ++t) {
    Component& component = components[parts.Root(vertex_of[t])];
    const Form& form = component.form();
    if (!component.seen) {
      component_points_.push_back(all[t].a);
      ++survey_.components;
      if (!form.closed) ++survey_.open;
      if (form.closed && !form.oriented) ++survey_.not_oriented;
    }
    component.seen = true;
    all[t].oriented = form.oriented;
    if (!form.closed || (is_copy[t] && component.once.closed)) continue;
    triangles_.push_back(all[t]);
    if (!form.oriented) continue;
    // Of the pyramid over the triangle, seen from a vertex of the mesh.
    const Eigen::Vector3d& apex = mesh.vertices.front();
    survey_.volume += (all[t].a - apex).dot((all[t].b - apex).cross(all[t].c - apex)) / 6;
  }
  // Lines and points without a component.
  for (const auto& triangle : joined.triangles) {
    const auto is_known = [&](std::uint32_t v) { return known[v]; };
    if (std::ranges::none_of(triangle, is_known)) {
      component_points_.push_back(joined.vertices[triangle[0]]);
    }
    for (const std::uint32_t v : triangle) known[v] = true;
  }
  if (has_inside()) BuildGrid();
}

void SolidMesh::BuildGrid() {
  grid_low_ = grid_high_ = triangles_.front().a.head<2>();
  for (const Triangle& t : triangles_) {
    for (const Eigen::Vector3d* p : {&t.a, &t.b, &t.c}) {
      grid_low_ = grid_low_.cwiseMin(p->head<2>());
      grid_high_ = grid_high_.cwiseMax(p->head<2>());
    }
  }
  grid_size_ =
      std::clamp(static_cast<int>(std::sqrt(static_cast<double>(triangles_.size()))), 1, 256);
  const Eigen::Vector2d cell_size =
      ((grid_high_ - grid_low_) / grid_size_).cwiseMax(Eigen::Vector2d::Constant(1e-12));
  const auto cell_of = [&](double value, int axis) {
    return std::clamp(static_cast<int>((value - grid_low_[axis]) / cell_size[axis]), 0,
                      grid_size_ - 1);
  };
  std::vector<std::vector<std::uint32_t>> cells(static_cast<std::size_t>(grid_size_ * grid_size_));
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Triangle& t = triangles_[i];
    const auto [x_low, x_high] = std::minmax({t.a.x(), t.b.x(), t.c.x()});
    const auto [y_low, y_high] = std::minmax({t.a.y(), t.b.y(), t.c.y()});
    for (int y = cell_of(y_low, 1); y <= cell_of(y_high, 1); ++y) {
      for (int x = cell_of(x_low, 0); x <= cell_of(x_high, 0); ++x) {
        cells[static_cast<std::size_t>(y * grid_size_ + x)].push_back(
            static_cast<std::uint32_t>(i));
      }
    }
  }
  cell_begin_.push_back(0);
  for (const auto& cell : cells) {
    cell_triangles_.insert(cell_triangles_.end(), cell.begin(), cell.end());
    cell_begin_.push_back(static_cast<std::uint32_t>(cell_triangles_.size()));
  }
}

bool SolidMesh::InGrid(const Eigen::Vector3d& point, std::size_t* cell) const {
  int index[2];
  for (int axis = 0; axis < 2; ++axis) {
    if (point[axis] < grid_low_[axis] || point[axis] > grid_high_[axis]) return false;
    const double cell_size = std::max((grid_high_[axis] - grid_low_[axis]) / grid_size_, 1e-12);
    index[axis] = std::clamp(static_cast<int>((point[axis] - grid_low_[axis]) / cell_size), 0,
                             grid_size_ - 1);
  }
  *cell = static_cast<std::size_t>(index[1] * grid_size_ + index[0]);
  return true;
}

bool SolidMesh::Contains(const Eigen::Vector3d& point) const {
  std::size_t cell = 0;
  if (!has_inside() || !InGrid(point, &cell)) return false;
  // Crossings of the ray along +z.
  int winding = 0;
  bool odd = false;
  for (std::uint32_t i = cell_begin_[cell]; i < cell_begin_[cell + 1]; ++i) {
    const Triangle& t = triangles_[cell_triangles_[i]];
    const int crossing = Crossing(point, t.a, t.b, t.c);
    if (t.oriented) {
      winding += crossing;
    } else if (crossing != 0) {
      odd = !odd;
    }
  }
  return winding != 0 || odd;
}

}  // namespace planbench
