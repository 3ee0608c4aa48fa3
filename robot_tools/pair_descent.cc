#include "robot_tools/pair_descent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "common/random.h"
#include "robot_tools/joint_draw.h"
#include "robot_tools/link_balls.h"
#include "robot_tools/link_chain.h"

namespace planbench {
namespace {

// The first few bring together most pairs that touch. A pair is given the others if these bring it
// nearer than a third of the radii that enclose the two links.
constexpr int kFewDescents = 32;
constexpr int kDescents = 128;
constexpr double kNear = 1.0 / 3;
constexpr int kDrawnSweeps = 2;
constexpr int kSweeps = 100;
// Of the gap; a descent whose sweeps gain less has ended.
constexpr double kLeastGain = 1e-3;
// Of a joint that moves both links: the range is narrowed to a cell on either side of the best.
constexpr int kZooms = 6;
constexpr int kZoomCells = 16;

// The turn of `angle` that is within the limits, else the limit that is nearest to it on the
// circle. Infinite limits: any.
double NearestAngle(double angle, double lower, double upper) {
  if (!std::isfinite(lower) || !std::isfinite(upper)) return angle;
  constexpr double kTurn = 2 * std::numbers::pi;
  double beyond = std::fmod(angle - lower, kTurn);
  if (beyond < 0) beyond += kTurn;
  if (lower + beyond <= upper) return lower + beyond;
  return lower + beyond - upper < kTurn - beyond ? upper : lower;
}

class PairDescent {
 public:
  PairDescent(const Robot& robot, int link_a, int link_b)
      : model_(robot.model),
        balls_{BallsOfLink(robot.spheres, link_a), BallsOfLink(robot.spheres, link_b)},
        positions_(robot.model.DefaultPositions()) {
    for (const int joint : JointsThatPlace(model_, link_a, link_b)) {
      if (NumPositions(TheJoint(joint).type) == 1) joints_.push_back(joint);
    }
    const LinkChain chain = ChainBetween(model_, link_a, link_b);
    std::map<int, int> times;  // By position.
    for (const std::vector<int>& side : chain) {
      for (const int joint : side) ++times[TheJoint(joint).position_index];
    }
    for (std::size_t side = 0; side < chain.size(); ++side) {
      for (const int joint : chain[side]) {
        steps_[side].push_back(MakeStep(joint, times[TheJoint(joint).position_index] == 1));
      }
    }
    for (const int joint : joints_) {
      if (times[TheJoint(joint).position_index] > 1) shared_.push_back(joint);
    }
  }

  bool Meets(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const double near = kNear * (balls_[0].around.radius + balls_[1].around.radius);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kDescents && (i < kFewDescents || least < near); ++i) {
      DrawPositions(model_, joints_, &random, &positions_);
      const std::size_t a = DrawBall(balls_[0], &random);
      least = std::min(least, Descend(a, DrawBall(balls_[1], &random)));
      if (least <= kContactGap) return true;
    }
    return false;
  }

 private:
  // A joint between a link and the link C that carries both.
  struct Step {
    const Joint* joint = nullptr;
    bool is_free = false;  // It alone moves with its position.
    double lower = 0;      // Of the joint itself.
    double upper = 0;
    Eigen::Vector3d axis_C = Eigen::Vector3d::Zero();
    Eigen::Vector3d origin_C = Eigen::Vector3d::Zero();
  };

  const Joint& TheJoint(int joint) const {
    return model_.joints()[static_cast<std::size_t>(joint)];
  }
  double& PositionOf(const Joint& joint) {
    return positions_[static_cast<std::size_t>(joint.position_index)];
  }

  Step MakeStep(int index, bool alone) const {
    const Joint& joint = TheJoint(index);
    const Joint& leader = joint.leader >= 0 ? TheJoint(joint.leader) : joint;
    Step step;
    step.joint = &joint;
    step.is_free = alone && NumPositions(joint.type) == 1 && joint.position_index >= 0 &&
                   joint.multiplier != 0;
    if (!step.is_free) return step;
    step.lower = joint.multiplier * leader.lower + joint.offset;
    step.upper = joint.multiplier * leader.upper + joint.offset;
    if (step.lower > step.upper) std::swap(step.lower, step.upper);
    return step;
  }

  void Place() {
    for (std::size_t side = 0; side < steps_.size(); ++side) {
      Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
      for (auto step = steps_[side].rbegin(); step != steps_[side].rend(); ++step) {
        X = X * step->joint->X_PJ;
        step->origin_C = X.translation();
        step->axis_C = X.linear() * step->joint->axis_J;
        X = X * JointMotion(*step->joint, positions_);
      }
      X_CL_[side] = X;
    }
  }

  // Where Place has put the links.
  LeastGap Nearest() const {
    return FindLeastGap(balls_[0], balls_[1], X_CL_[0].inverse() * X_CL_[1]);
  }

  static std::size_t DrawBall(const LinkBalls& of_link, std::mt19937_64* random) {
    return static_cast<std::size_t>(UniformFraction(random) *
                                    static_cast<double>(of_link.balls.size()));
  }

  // How near the links come, m: first by bringing two given balls together, then whichever are
  // nearest. With the nearest alone nearly all descents can end in one and the same minimum, and
  // none in the small basin of another in which the links touch.
  double Descend(std::size_t a, std::size_t b) {
    for (int i = 0; i < kDrawnSweeps; ++i) {
      Place();
      Sweep(a, b);
    }
    double gap = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kSweeps; ++i) {
      Place();
      const LeastGap nearest = Nearest();
      const double gain = gap - nearest.gap_m;
      gap = std::min(gap, nearest.gap_m);
      if (gap <= kContactGap || gain < kLeastGain * gap) break;
      Sweep(nearest.a, nearest.b);
    }
    return gap;
  }

  // Brings two balls' centers as near to each other as each joint can, one after the other.
  // Outermost joints come first: they do not move the axes of those that follow. What is best for
  // a joint is known exactly, however long its travel.
  void Sweep(std::size_t a, std::size_t b) {
    const std::array<Eigen::Vector3d, 2> points_L = {balls_[0].balls[a].center,
                                                     balls_[1].balls[b].center};
    std::array<Eigen::Vector3d, 2> points_C = {X_CL_[0] * points_L[0], X_CL_[1] * points_L[1]};
    for (std::size_t side = 0; side < steps_.size(); ++side) {
      for (const Step& step : steps_[side]) {
        if (step.is_free) Approach(step, points_C[1 - side], &points_C[side]);
      }
    }
    for (const int joint : shared_) ZoomIn(TheJoint(joint), points_L);
  }

  void Approach(const Step& step, const Eigen::Vector3d& target, Eigen::Vector3d* point) {
    double& position = PositionOf(*step.joint);
    const double at = step.joint->multiplier * position + step.joint->offset;
    double to;
    if (step.joint->type == JointType::kPrismatic) {
      to = std::clamp(at + step.axis_C.dot(target - *point), step.lower, step.upper);
      *point += (to - at) * step.axis_C;
    } else {
      const Eigen::Vector3d from = *point - step.origin_C;
      const Eigen::Vector3d wanted = target - step.origin_C;
      const double sine = step.axis_C.dot(from.cross(wanted));
      const double cosine = from.dot(wanted) - step.axis_C.dot(from) * step.axis_C.dot(wanted);
      if (std::hypot(sine, cosine) < 1e-12) return;  // One of them is on the axis.
      to = NearestAngle(at + std::atan2(sine, cosine), step.lower, step.upper);
      *point = step.origin_C + Eigen::AngleAxisd(to - at, step.axis_C) * from;
    }
    position = (to - step.joint->offset) / step.joint->multiplier;
  }

  // For a joint that several between the links follow, itself perhaps one of them.
  void ZoomIn(const Joint& joint, const std::array<Eigen::Vector3d, 2>& points_L) {
    double& position = PositionOf(joint);
    const auto distance = [&] {
      Place();
      return (X_CL_[0] * points_L[0] - X_CL_[1] * points_L[1]).norm();
    };
    double best = position;
    double least = distance();
    const std::pair<double, double> range = DrawRange(joint);
    double lower = range.first;
    double upper = range.second;
    for (int i = 0; i < kZooms; ++i) {
      const double cell = (upper - lower) / kZoomCells;
      for (int k = 0; k <= kZoomCells; ++k) {
        position = lower + k * cell;
        const double here = distance();
        if (here >= least) continue;
        least = here;
        best = position;
      }
      lower = std::max(lower, best - cell);
      upper = std::min(upper, best + cell);
    }
    position = best;
  }

  const RobotModel& model_;
  std::array<LinkBalls, 2> balls_;
  std::vector<double> positions_;
  std::vector<int> joints_;                 // Those that are drawn.
  std::vector<int> shared_;                 // Of these, those with which several joints move.
  std::array<std::vector<Step>, 2> steps_;  // Outermost first.
  std::array<Eigen::Isometry3d, 2> X_CL_;
};

}  // namespace

bool FindContact(const Robot& robot, int link_a, int link_b, std::uint64_t seed) {
  return PairDescent(robot, link_a, link_b).Meets(seed);
}

}  // namespace planbench
