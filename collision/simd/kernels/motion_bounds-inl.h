// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_MOTION_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_MOTION_BOUNDS_INL_H_
#undef PLANBENCH_KERNELS_MOTION_BOUNDS_INL_H_
#else
#define PLANBENCH_KERNELS_MOTION_BOUNDS_INL_H_
#endif

#include "collision/simd/kernels/placement-inl.h"
#include "collision/simd/kernels/points-inl.h"
#include "collision/simd/kernels/scratch.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// Points of a body, within `radius` of its node's middle.
struct MovingPart {
  int node;
  int body;
  float radius;
  const float* weights;  ///< By joint: how far each moves them, m/rad or 1.
};

/// Upper bounds of motions over the boxes of configurations that lanes stand for, m, margins
/// included but where a bound says otherwise. Not kAround: lanes stand for configurations.
template <bool kAround>
class MotionBounds {
 public:
  MotionBounds(const SphereRobot& robot, SphereScratch::Buffers* buffers, const BlockQuery& query,
               int lane, const Placement& placement)
      : robot_(robot),
        placement_(placement),
        sums_(buffers->width_sums.get()),
        query_(query),
        lane_(lane),
        margin_(kAround && query.margins != nullptr ? hn::LoadU(Lanes(), query.margins + lane)
                                                    : Zero()) {
    if constexpr (kAround) SumWidths();
  }

  /// Of a tree relative to what it is tested against, or of a part of it, whose weights stand from
  /// `first` on; only joints of `reach` count.
  HWY_INLINE V Of(const Reach& reach, int first) const {
    V sum = margin_;
    if constexpr (kAround) {
      const float* weights = robot_.reaches.data() + first;
      for (int j = reach.begin; j < reach.end; ++j) {
        sum = hn::MulAdd(Fill(weights[j]), HalfWidth(j), sum);
      }
    }
    return sum;
  }

  /// Not less than that of a whole tree, at less cost.
  HWY_INLINE V AtMost(const Reach& reach) const {
    if constexpr (!kAround) return margin_;
    const V widths = Load(sums_ + reach.end * kBlock) - Load(sums_ + reach.begin * kBlock);
    return hn::MulAdd(Fill(reach.most), widths, margin_);
  }

  /// Of two balls or groups relative to each other, by the joints that move their trees so: less,
  /// as a tree's bound is that of its furthest balls.
  HWY_INLINE V Between(const Reach& reach, int reach_a, int reach_b) const {
    V sum = margin_;
    // What turns about its middle stays where it is, but for points of patches.
    const float* moves = robot_.reaches.data() + reach.first + robot_.num_joints;
    const float* weights_a = robot_.reaches.data() + reach_a;
    const float* weights_b = robot_.reaches.data() + reach_b;
    for (int j = reach.begin; j < reach.end; ++j) {
      if (moves[j] != 0) sum = hn::MulAdd(Fill(weights_a[j] + weights_b[j]), HalfWidth(j), sum);
    }
    return sum;
  }

  /// Along n (unit vectors in W) of a part, by the joints of `moves` between it and the body that
  /// stands still; margins are not included. One joint after another moves it, the outermost first,
  /// each about an axis that is where it is in the middle of the box.
  V Along(const Points& n, const MovingPart& part, const float* moves) const {
    const Points p = placement_.Position(part.node);
    V along = Zero();
    V most = Zero();  // In any direction.
    for (int i = part.body; i != 0; i = BodyAt(i).parent) {
      const Body& body = BodyAt(i);
      if (moves[body.joint] == 0) continue;
      const float weight = part.weights[body.joint];
      const V width = HalfWidth(body.joint);
      const V arc = width * Fill(weight);
      const Poses X_WC = placement_.PosesOf(i);
      V step;
      if (body.prismatic) {
        const V slope = hn::Abs(Dot(n, X_WC.Rotate(Fill(body.axis))));
        step = width * (slope + Fill(kDirectionError));
      } else {
        const Points across = Cross(n, X_WC.Column(2));
        const V lever = hn::Abs(Dot(across, p - X_WC.translation()));
        // The square root of `squared`, which is at most 1, is less. An arc leaves its tangent by
        // no more than half its length times its angle.
        const V squared = SquaredNorm(across);
        const V beside = hn::MulAdd(squared, Fill(0.5f), Fill(0.5f)) * (most + Fill(part.radius));
        const V bend = hn::MulAdd(arc, Fill(0.5f), Fill(weight * kDirectionError));
        step = width * (lever + beside + bend);
      }
      along = along + hn::Min(step, arc);
      most = most + arc;
    }
    return along;
  }
  V margin() const { return margin_; }

 private:
  /// What axes and directions are off by in single precision.
  static constexpr float kDirectionError = 1e-5f;

  const Body& BodyAt(int index) const { return robot_.bodies[static_cast<std::size_t>(index)]; }

  HWY_INLINE V HalfWidth(int joint) const {
    return hn::LoadU(Lanes(), query_.half_widths + joint * kBlock + lane_);
  }

  void SumWidths() {
    V sum = Zero();
    for (int j = 0; j < robot_.num_joints; ++j) {
      Store(sum, sums_ + j * kBlock);
      // By more than the sum is rounded: no difference is below what lies between.
      sum = hn::MulAdd(sum, Fill(1 + 0x1p-22f), HalfWidth(j));
    }
    Store(sum, sums_ + robot_.num_joints * kBlock);
  }

  const SphereRobot& robot_;
  const Placement& placement_;
  float* sums_;  ///< Of half widths, of the joints before each.
  const BlockQuery& query_;
  int lane_;
  V margin_;  ///< Part of every motion.
};

/// Bounds of how far parts move relative to each other, margins included, in lanes that `counts`;
/// in others they stand still.
class RelativeMotion {
 public:
  static constexpr bool kMoves = true;

  /// `most`: in any direction. `moves`: of what joints between the parts.
  RelativeMotion(const MotionBounds<true>& bounds, V most, const float* moves, M counts,
                 const MovingPart& part, const MovingPart* other = nullptr)
      : bounds_(bounds),
        most_(hn::IfThenElseZero(counts, most)),
        moves_(moves),
        counts_(counts),
        part_(part),
        other_(other) {}

  V most() const { return most_; }
  /// Along unit vectors, in W.
  V Along(const Points& n) const {
    V sum = bounds_.margin() + bounds_.Along(n, part_, moves_);
    if (other_ != nullptr) sum = sum + bounds_.Along(n, *other_, moves_);
    return hn::IfThenElseZero(counts_, sum);
  }

 private:
  const MotionBounds<true>& bounds_;
  V most_;
  const float* moves_;
  M counts_;
  const MovingPart& part_;
  const MovingPart* other_;
};

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
