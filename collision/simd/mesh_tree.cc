#include "collision/simd/mesh_tree.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "collision/at.h"
#include "collision/balls.h"

namespace planbench {
namespace {

using Eigen::Vector3d;
using kernels::BoxGroup;
using kernels::kWide;
using kernels::TriangleGroup;

/// Where the boxes and triangles are that there are not, m; its square is a number still.
constexpr float kFarAway = 1e18f;
/// Enlargement of boxes, m: what single precision rounds.
constexpr double kBoxPadding = 5e-6;

class Builder {
 public:
  explicit Builder(kernels::TriangleTree* tree) : tree_(*tree) {}

  void Build(const SharedMesh& mesh) {
    const Vector3d origin = mesh.box().center();
    for (int k = 0; k < 3; ++k) tree_.origin[k] = origin[k];
    for (const auto& triangle : mesh->triangles) {
      Corners& corners = triangles_.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh->vertices[triangle[k]] - origin;
    }
    order_.resize(triangles_.size());
    std::iota(order_.begin(), order_.end(), 0);
    AddBoxes(0, static_cast<int>(order_.size()));
  }

 private:
  const Corners& TriangleAt(int place) const { return At(triangles_, At(order_, place)); }

  /// A node over the triangles at places [first, last); returns its index.
  int AddBoxes(int first, int last) {
    // All children are full but the last.
    int capacity = kWide;
    while (capacity < (last - first + kWide - 1) / kWide) capacity *= kWide;
    const auto index = static_cast<int>(tree_.boxes.size());
    tree_.boxes.push_back(MakeBoxGroup());
    int num_children = 0;
    AddChildren(first, last, capacity, index, &num_children);
    return index;
  }

  void AddChildren(int first, int last, int capacity, int parent, int* num_children) {
    Eigen::AlignedBox3d box;
    Eigen::AlignedBox3d middles;
    for (int place = first; place < last; ++place) {
      for (const Vector3d& corner : TriangleAt(place)) box.extend(corner);
      middles.extend(Middle(At(order_, place)));
    }
    if (last - first > capacity) {
      int axis = 0;
      middles.sizes().maxCoeff(&axis);
      const int parts = (last - first + capacity - 1) / capacity;
      const int middle = first + parts / 2 * capacity;
      std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                       [&](int a, int b) {
                         const double at = Middle(a)[axis];
                         const double bt = Middle(b)[axis];
                         return at < bt || (at == bt && a < b);
                       });
      AddChildren(first, middle, capacity, parent, num_children);
      AddChildren(middle, last, capacity, parent, num_children);
      return;
    }
    const int child = last - first <= kWide ? ~AddTriangles(first, last) : AddBoxes(first, last);
    const int i = (*num_children)++;
    SetBox(box, kBoxPadding, child, static_cast<std::size_t>(i), &At(tree_.boxes, parent));
  }

  int AddTriangles(int first, int last) {
    TriangleGroup& group = tree_.triangles.emplace_back();
    std::fill_n(group.position[2], kWide, kFarAway);
    group.count = last - first;
    for (int place = first; place < last; ++place) {
      SetTriangle(TriangleAt(place), static_cast<std::size_t>(place - first), &group);
    }
    return static_cast<int>(tree_.triangles.size()) - 1;
  }

  /// Of the triangle's bounding box.
  Vector3d Middle(int triangle) const {
    const auto& [a, b, c] = At(triangles_, triangle);
    return (a.cwiseMin(b).cwiseMin(c) + a.cwiseMax(b).cwiseMax(c)) / 2;
  }

  kernels::TriangleTree& tree_;
  std::vector<Corners> triangles_;  ///< In the tree's frame.
  std::vector<int> order_;          ///< Of triangles.
};

/// Points (balls of no radius), in the order of balls around few of them.
void AddPointBalls(std::span<Ball> points, kernels::TriangleTree* tree) {
  if (points.size() > static_cast<std::size_t>(kWide)) {
    const std::size_t half = Halve(points);
    AddPointBalls(points.first(half), tree);
    AddPointBalls(points.subspan(half), tree);
    return;
  }
  const Ball ball = EnclosingBall(points);
  kernels::PointBall& around = tree->point_balls.emplace_back();
  around.radius = static_cast<float>(ball.radius + kBoxPadding);
  around.first = static_cast<std::int32_t>(tree->points.size());
  around.num = static_cast<std::int32_t>(points.size());
  Eigen::Vector3f::Map(around.center) = ball.center.cast<float>();
  for (const Ball& point : points) {
    Eigen::Vector3f::Map(tree->points.emplace_back().data()) = point.center.cast<float>();
  }
}

}  // namespace

BoxGroup MakeBoxGroup() {
  BoxGroup group;
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(group.low[axis], kWide, kFarAway);
    std::fill_n(group.high[axis], kWide, kFarAway);
  }
  std::fill_n(group.child, kWide, 0);
  return group;
}

void SetBox(const Eigen::AlignedBox3d& box, double padding, std::int32_t child, std::size_t i,
            BoxGroup* group) {
  for (int axis = 0; axis < 3; ++axis) {
    group->low[axis][i] = static_cast<float>(box.min()[axis] - padding);
    group->high[axis][i] = static_cast<float>(box.max()[axis] + padding);
  }
  group->child[i] = child;
}

void SetTriangle(const Corners& triangle, std::size_t i, TriangleGroup* group) {
  Corners corners = triangle;
  // The longest edge comes first: the frame is as good as its direction, and a triangle of no area
  // is a line along it.
  std::size_t longest = 0;
  double length = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double edge = (corners[(k + 1) % 3] - corners[k]).norm();
    if (edge > length) {
      length = edge;
      longest = k;
    }
  }
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(longest),
              corners.end());
  const Vector3d x = length > 0 ? Vector3d((corners[1] - corners[0]) / length) : Vector3d::UnitX();
  const Vector3d to_apex = corners[2] - corners[0];
  const Vector3d across = to_apex - to_apex.dot(x) * x;
  const double width = across.norm();
  // Of a triangle of no width any plane through the edge will do.
  const Vector3d y = width > 1e-12 * length && width > 0
                         ? Vector3d((across / width - across.dot(x) / width * x).normalized())
                         : x.unitOrthogonal();
  Eigen::Matrix3d R_TM;
  R_TM << x.transpose(), y.transpose(), x.cross(y).transpose();
  const Vector3d p_TM = -(R_TM * corners[0]);
  const Eigen::Vector2d apex(to_apex.dot(x), std::max(to_apex.dot(y), 0.0));
  const Eigen::Vector2d edges[2] = {apex - Eigen::Vector2d(length, 0), -apex};

  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      group->corner[row][column][i] = static_cast<float>(At(corners, row)[column]);
      group->rotation[3 * row + column][i] = static_cast<float>(R_TM(row, column));
    }
    group->position[row][i] = static_cast<float>(p_TM[row]);
  }
  group->length[0][i] = static_cast<float>(length);
  for (int k = 0; k < 2; ++k) {
    group->apex[k][i] = static_cast<float>(apex[k]);
    const double edge = edges[k].norm();
    const Eigen::Vector2d along =
        edge > 0 ? Eigen::Vector2d(edges[k] / edge) : Eigen::Vector2d(1, 0);
    group->length[k + 1][i] = static_cast<float>(edge);
    group->along[k][0][i] = static_cast<float>(along.x());
    group->along[k][1][i] = static_cast<float>(along.y());
  }
}

MeshTree::MeshTree(const SharedMesh& mesh) : solid_(mesh) {
  Builder(&tree_).Build(mesh);
  tree_.solid = &solid_;
  std::vector<Ball> points;
  for (const Vector3d& point : solid_.component_points()) {
    points.push_back({point - Vector3d::Map(tree_.origin), 0});
  }
  AddPointBalls(points, &tree_);
}

namespace kernels {

bool Encloses(const TriangleTree& tree, const float* p) {
  return tree.solid->Contains(
      {p[0] + tree.origin[0], p[1] + tree.origin[1], p[2] + tree.origin[2]});
}

}  // namespace kernels
}  // namespace planbench
