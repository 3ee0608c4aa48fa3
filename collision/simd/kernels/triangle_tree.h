#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace planbench {
class SolidMesh;
}

// Triangles of a mesh as the kernels take them: one point is tested against kWide boxes or
// triangles at once. MeshTree builds them.

namespace planbench::kernels {

/// Children of a node, triangles of a leaf.
inline constexpr int kWide = 16;

/// Boxes around the children of a node, m. Those there are not are far away.
struct alignas(64) BoxGroup {
  float low[3][kWide], high[3][kWide];
  /// Index of a box group, or ~index of a triangle group.
  std::int32_t child[kWide];
};

/// Triangles, each in a frame T of its own: corners at (0, 0), (length[0], 0) and `apex`, the first
/// edge being the longest. Those there are not are far away.
struct alignas(64) TriangleGroup {
  float rotation[9][kWide];  ///< R_TM, row-major.
  float position[3][kWide];  ///< p_TM, m.
  float apex[2][kWide];      ///< m; its second number is not negative.
  float length[3][kWide];    ///< Of the edges, m.
  /// Unit vectors along the second edge, from (length[0], 0) to the apex, and the third, from the
  /// apex to (0, 0).
  float along[2][2][kWide];
  float corner[3][3][kWide];  ///< In M, by corner and axis, m.
  std::int32_t count;         ///< Of those there are.
};

/// A ball around points that stand next to each other, up to kWide of them.
struct PointBall {
  float center[3];  ///< In M, m.
  float radius;     ///< m
  std::int32_t first, num;
};

/// A bounding-volume hierarchy over the triangles of a mesh, in its frame M: parallel to the mesh's
/// own, in the middle of its bounding box.
struct TriangleTree {
  std::vector<BoxGroup> boxes;  ///< [0] is the root.
  std::vector<TriangleGroup> triangles;
  std::vector<std::array<float, 3>> points;  ///< One of every connected part.
  std::vector<PointBall> point_balls;        ///< Around all of them.
  double origin[3] = {0, 0, 0};              ///< Of M in the mesh's frame, m.
  const SolidMesh* solid = nullptr;          ///< What is inside, in the mesh's frame.
};

/// A mesh that stands in W.
struct WorldMesh {
  const TriangleTree* tree;
  float rotation[9];  ///< R_MW, row-major.
  float position[3];  ///< p_WM, m.
};

/// Whether the mesh encloses a point, given in M (m).
bool Encloses(const TriangleTree& tree, const float* p);

}  // namespace planbench::kernels
