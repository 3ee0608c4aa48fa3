#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace planbench {

/// The configuration space of a planning group: n joints in group order; positions in rad
/// (revolute, continuous) or m (prismatic). Continuous joints wrap: differences and motions take
/// the short way round. Whole turns are taken from joints that are same_after_turn alone, so that
/// the robot's posture, with all that follows the group's joints, stays what it was.
class JointSpace {
 public:
  struct Joint {
    std::string name;
    bool continuous = false;  ///< Unbounded revolute joint.
    bool prismatic = false;
    double lower = 0;         ///< -pi for a continuous joint.
    double upper = 0;         ///< +pi for a continuous joint.
    double max_velocity = 0;  ///< rad/s or m/s; 0: none is given
    /// Whether all that follows a joint that turns is in the same posture when it has made a turn.
    /// So it is of every continuous one (RobotModel::MakeGroup).
    bool same_after_turn = true;
  };

  /// Bounds of limits are inclusive; a position may exceed them by this much (rad or m), the
  /// rounding of positions that were written as text.
  static constexpr double kLimitTolerance = 1e-6;
  /// rad, the bound of continuous joints, of either sign. Turned further, an angle is rounded by
  /// more than paths may be off their ends.
  static constexpr double kFarthestTurned = 1e6;

  JointSpace() = default;
  explicit JointSpace(std::vector<Joint> joints);

  int size() const { return static_cast<int>(joints_.size()); }
  const Joint& joint(int j) const { return joints_[static_cast<std::size_t>(j)]; }
  const std::vector<Joint>& joints() const { return joints_; }
  /// Index of a joint, -1 if the group has none of that name.
  int Find(const std::string& name) const;

  /// Signed motion of joint j from `from` to `to`, in [-pi, pi] for continuous joints.
  double Difference(int j, double from, double to) const;
  /// L2 norm of the differences (rad and m unweighted).
  double Distance(std::span<const double> from, std::span<const double> to) const;
  /// Point at fraction t in [0, 1] of the straight motion. Continuous joints come out in [-pi, pi);
  /// with t = 0 and t = 1 the ends come out exactly as given.
  void Interpolate(std::span<const double> from, std::span<const double> to, double t,
                   std::span<double> out) const;
  /// Brings continuous joints into [-pi, pi).
  void Wrap(std::span<double> q) const;
  /// `position` of joint j; of a continuous joint that is beyond half a turn, as far as turns can
  /// be told, in [-pi, pi) instead.
  double WithoutTurns(int j, double position) const;
  /// What is odd about a position whose whole turns are taken out ("is at 90 rad, 14.3 turns;
  /// degrees?"): a continuous joint's that is more than one turn away from 0. Else nothing.
  std::optional<std::string> FindTurnsDoubt(int j, double position) const;
  /// Takes the turns out of a whole configuration as a file gives it; what is odd about that, a
  /// line each ("joint 'wheel' is at 90 rad, ..."): FindTurnsDoubt, and a joint outside its limits.
  std::vector<std::string> TakeTurnsOut(std::span<double> q) const;
  /// Brings joints that may turn more than once round to the turn, within their limits, that is
  /// nearest to where they are at `to`; those that are not same_after_turn stay.
  void ToNearestTurn(std::span<const double> to, std::span<double> q) const;
  /// The same space, of which those joints stay where `q` has them.
  JointSpace Held(const std::vector<int>& joints, std::span<const double> q) const;
  /// "[-1.5, 2]": what positions of joint j may be.
  std::string DescribeLimits(int j) const;
  /// Index of the first joint outside its limits (by more than kLimitTolerance) or not finite, -1
  /// if none.
  int FirstOutsideLimits(std::span<const double> q) const;
  /// The same in words ("joint 'elbow' at 3 is outside its limits [-1.5, 2]"), nothing if none.
  std::optional<std::string> FindLimitFault(std::span<const double> q) const;
  bool WithinLimits(std::span<const double> q) const;

 private:
  std::vector<Joint> joints_;
  // What positions may be, with the tolerance; of continuous joints any from which a turn can be
  // told.
  std::vector<double> lowest_;
  std::vector<double> highest_;
};

/// `angle` (rad) brought into [-pi, pi).
double WrapAngle(double angle);

}  // namespace planbench
