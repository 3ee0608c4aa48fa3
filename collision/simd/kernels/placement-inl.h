// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_PLACEMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_PLACEMENT_INL_H_
#undef PLANBENCH_KERNELS_PLACEMENT_INL_H_
#else
#define PLANBENCH_KERNELS_PLACEMENT_INL_H_
#endif

#include <algorithm>

#include "collision/simd/kernels/points-inl.h"
#include "collision/simd/kernels/scratch.h"
#include "collision/simd/kernels/sin_cos-inl.h"
#include "collision/simd/kernels/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// Poses of a body, a lane each, in memory: R_WC row-major, then p_WC.
class Poses {
 public:
  explicit Poses(float* lanes) : lanes_(lanes) {}

  V rotation(int row, int column) const { return Load(At(3 * row + column)); }
  Points translation() const { return LoadPoints(At(9)); }
  void set_rotation(int row, int column, V value) { Store(value, At(3 * row + column)); }
  void set_translation(const Points& p) { Store(p, At(9)); }

  /// Points given in W, in the body's frame.
  HWY_INLINE Points InverseTimes(const Points& p_W) const {
    return InverseRotate(p_W - translation());
  }
  /// Vectors given in W, in the body's frame.
  HWY_INLINE Points InverseRotate(const Points& v_W) const {
    return {Dot(Column(0), v_W), Dot(Column(1), v_W), Dot(Column(2), v_W)};
  }
  /// Vectors given in the body's frame, in W.
  HWY_INLINE Points Rotate(const Points& v_C) const {
    const auto row = [&](int r) {
      return Dot({rotation(r, 0), rotation(r, 1), rotation(r, 2)}, v_C);
    };
    return {row(0), row(1), row(2)};
  }
  HWY_INLINE Points Column(int c) const { return {rotation(0, c), rotation(1, c), rotation(2, c)}; }
  /// The pose in one lane.
  Transform InLane(int lane) const {
    Transform X;
    for (int i = 0; i < 9; ++i) X.rotation[i] = At(i)[lane];
    for (int i = 0; i < 3; ++i) X.translation[i] = At(9 + i)[lane];
    return X;
  }
  /// Points given in the body's frame, in W.
  HWY_INLINE Points operator*(const Points& p_C) const {
    return {Row(0, p_C), Row(1, p_C), Row(2, p_C)};
  }

 private:
  float* At(int k) const { return lanes_ + k * kBlock; }
  HWY_INLINE V Row(int row, const Points& p) const {
    V sum = hn::MulAdd(rotation(row, 0), p.x, Load(At(9 + row)));
    sum = hn::MulAdd(rotation(row, 1), p.y, sum);
    return hn::MulAdd(rotation(row, 2), p.z, sum);
  }

  float* lanes_;
};

/// What the passes over one part of a block (as many lanes as a vector has) share: where bodies and
/// balls are.
class Placement {
 public:
  Placement(const SphereRobot& robot, SphereScratch::Buffers* buffers, const float* q, int lane)
      : robot_(robot), buffers_(*buffers), q_(q + lane), lane_(lane) {
    if (++buffers_.placement == 0) {  // stamps of four billion placements ago look new
      std::fill(buffers_.placed.begin(), buffers_.placed.end(), 0);
      buffers_.placement = 1;
    }
    // Body 0 stands in W; its pose has been written for good.
    for (std::size_t i = 1; i < robot_.bodies.size(); ++i) PlaceBody(static_cast<int>(i));
  }

  const Node& node(int index) const { return robot_.nodes[static_cast<std::size_t>(index)]; }
  Points Position(int node) const { return LoadPoints(PositionLanes(node)); }
  void Position(int node, int lane, float* p) const {
    for (int k = 0; k < 3; ++k) p[k] = PositionLanes(node)[k * kBlock + lane];
  }
  Poses PosesOf(int body) const { return Poses(buffers_.poses.get() + body * 12 * kBlock + lane_); }

  /// Positions the root of a tree.
  HWY_INLINE void PlaceRoot(int node, int body) {
    std::uint32_t& stamp = buffers_.placed[static_cast<std::size_t>(node)];
    if (stamp == buffers_.placement) return;
    stamp = buffers_.placement;
    PlaceNode(node, body);
  }

  /// Positions the children of a node.
  HWY_INLINE void PlaceChildren(int parent, int body) {
    const Node& p = node(parent);
    std::uint32_t& stamp = buffers_.placed[robot_.nodes.size() + static_cast<std::size_t>(parent)];
    if (stamp == buffers_.placement) return;
    stamp = buffers_.placement;
    for (int i = 0; i < p.num_children; ++i) PlaceNode(p.first_child + i, body);
  }

 private:
  const Body& body(int index) const { return robot_.bodies[static_cast<std::size_t>(index)]; }
  float* PositionLanes(int node) const {
    return buffers_.positions.get() + node * 3 * kBlock + lane_;
  }

  HWY_INLINE void PlaceNode(int index, int of_body) {
    const Node& n = node(index);
    const Points p_C = Fill(n.center);
    const Poses X_WC = PosesOf(of_body);
    Store(body(of_body).turns ? X_WC * p_C : X_WC.translation() + p_C, PositionLanes(index));
  }

  HWY_INLINE void PlaceBody(int index) {
    const Body& b = body(index);
    const Poses X_WP = PosesOf(b.parent);
    Poses X_WC = PosesOf(index);
    const bool parent_turns = body(b.parent).turns;
    const V q = hn::LoadU(Lanes(), q_ + b.joint * kBlock);

    Points p_PC = Fill(b.position);
    if (b.prismatic) {
      p_PC = {hn::MulAdd(q, Fill(b.axis[0]), p_PC.x), hn::MulAdd(q, Fill(b.axis[1]), p_PC.y),
              hn::MulAdd(q, Fill(b.axis[2]), p_PC.z)};
    }
    X_WC.set_translation(parent_turns ? X_WP * p_PC : X_WP.translation() + p_PC);

    if (b.prismatic) {
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
          X_WC.set_rotation(row, column, X_WP.rotation(row, column));
        }
      }
      return;
    }
    V sine, cosine;
    SinCos(q, &sine, &cosine);
    for (int row = 0; row < 3; ++row) {
      V m[3];  // the row at joint position 0
      for (int column = 0; column < 3; ++column) {
        if (parent_turns) {
          m[column] = X_WP.rotation(row, 0) * Fill(b.rotation[column]);
          m[column] = hn::MulAdd(X_WP.rotation(row, 1), Fill(b.rotation[3 + column]), m[column]);
          m[column] = hn::MulAdd(X_WP.rotation(row, 2), Fill(b.rotation[6 + column]), m[column]);
        } else {
          m[column] = Fill(b.rotation[3 * row + column]);
        }
      }
      X_WC.set_rotation(row, 0, hn::MulAdd(cosine, m[0], sine * m[1]));
      X_WC.set_rotation(row, 1, hn::NegMulAdd(sine, m[0], cosine * m[1]));
      X_WC.set_rotation(row, 2, m[2]);
    }
  }

  const SphereRobot& robot_;
  SphereScratch::Buffers& buffers_;
  const float* q_;
  int lane_;
};

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
