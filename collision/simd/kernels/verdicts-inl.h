// Included once per instruction set, see sphere_kernel.cc.
#if defined(PLANBENCH_KERNELS_VERDICTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANBENCH_KERNELS_VERDICTS_INL_H_
#undef PLANBENCH_KERNELS_VERDICTS_INL_H_
#else
#define PLANBENCH_KERNELS_VERDICTS_INL_H_
#endif

#include <bit>
#include <utility>

#include "collision/simd/kernels/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planbench::kernels::HWY_NAMESPACE {

/// What is known of lanes so far. Functions that take note of something return true to stop.
template <bool kAround>
class Verdicts {
 public:
  Verdicts(M alive, bool stop_at_first)
      : stop_at_first_(stop_at_first),
        alive_(alive),
        hits_(hn::FirstN(Lanes(), 0)),
        hits_before_(hits_),
        certain_(hits_),
        doubts_(hits_),
        doubts_before_(hits_) {}

  /// Lanes whose verdict is not certain yet.
  M alive() const { return alive_; }
  /// Lanes that are not proven free; where open tests are looked for, by the test at hand.
  M hits() const { return hits_; }
  M certain() const { return certain_; }
  bool Done() const { return (stop_at_first_ && !None(certain_)) || None(alive_); }

  /// Of all tests.
  BlockVerdict InBits() const {
    return {Bits(hn::Or(hits_, hits_before_)), Bits(certain_),
            Bits(hn::AndNot(certain_, hn::Or(doubts_, doubts_before_)))};
  }

  /// Lanes that the test just made left open. The next one starts as if none were: it is to be
  /// known whether that leaves them open, too.
  M BeginNext() {
    const M open = hn::Or(hits_, doubts_);
    hits_before_ = hn::Or(hits_before_, std::exchange(hits_, hn::FirstN(Lanes(), 0)));
    doubts_before_ = hn::Or(doubts_before_, std::exchange(doubts_, hn::FirstN(Lanes(), 0)));
    return open;
  }

  /// Radius grown by the motion; lanes not proven free already matter no more but for certainty.
  HWY_INLINE V Grown(float radius, V motion) const {
    if constexpr (kAround) return Fill(radius) + hn::IfThenZeroElse(hits_, motion);
    return Fill(radius);
  }

  void Doubt(M lanes) { doubts_ = hn::Or(doubts_, lanes); }
  /// Lanes that are not proven free.
  void Block(M lanes) { hits_ = hn::Or(hits_, lanes); }
  /// Lanes that collide for certain.
  bool Settle(M certain) {
    hits_ = hn::Or(hits_, certain);
    certain_ = hn::Or(certain_, certain);
    alive_ = hn::AndNot(certain, alive_);
    return stop_at_first_ || None(alive_);
  }

  /// Balls (of one node, or the sum of a pair) of a radius that touch.
  HWY_INLINE bool Note(V squared, float radius, M touching, bool doubtful) {
    touching = hn::And(touching, alive_);
    if (None(touching)) return false;
    if (doubtful) {
      Doubt(touching);
      return false;
    }
    M certain = touching;
    if constexpr (kAround) {
      Block(touching);
      certain = hn::And(certain, hn::Le(squared, Fill(radius * radius)));
      if (None(certain)) return false;
    }
    return Settle(certain);
  }

  /// Something within what is inside of the robot for certain, of that radius.
  HWY_INLINE bool NoteInner(V squared, float inner) {
    const M deep = hn::And(alive_, hn::Le(squared, Fill(inner * inner)));
    return !None(deep) && Settle(deep);
  }

  /// What touches(lane, margin) in the lanes given; `motion` bounds that of all of its points,
  /// `padding` is part of every margin.
  template <typename Touches>
  bool NoteExact(M lanes, V motion, float padding, Touches touches) {
    alignas(64) float margins[kBlock];
    Store(hn::IfThenZeroElse(hits_, motion), margins);
    LaneMask touching = 0;
    LaneMask certain = 0;
    for (LaneMask open = Bits(lanes); open != 0; open &= open - 1) {
      const int lane = std::countr_zero(open);
      if (!touches(lane, margins[lane] + padding)) continue;
      touching |= LaneMask{1} << lane;
      if (margins[lane] > 0 && !touches(lane, padding)) continue;
      certain |= LaneMask{1} << lane;
      if (stop_at_first_) break;
    }
    if (touching == 0) return false;
    Block(MaskOf(touching));
    return certain != 0 && Settle(MaskOf(certain));
  }

 private:
  bool stop_at_first_;
  M alive_;
  // See BlockVerdict; where open tests are looked for, of the one at hand and of those before it.
  M hits_;
  M hits_before_;
  M certain_;
  M doubts_;
  M doubts_before_;
};

}  // namespace planbench::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
