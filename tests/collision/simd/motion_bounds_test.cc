// Bounds on motions along a direction, against motions that are driven to their furthest.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "collision/simd/kernels/motion_bounds-inl.h"
#include "common/random.h"
#include "tests/support/trials.h"

namespace planbench::kernels {
namespace {

using Eigen::Vector3d;

/// A chain of bodies, and points of the last one within a radius of its node's middle.
class DrawnChain {
 public:
  explicit DrawnChain(std::mt19937_64* random) : random_(*random) {
    const int num_joints = 1 + static_cast<int>(5 * Fraction());
    robot_.num_joints = num_joints;
    robot_.bodies.emplace_back();
    for (int j = 0; j < num_joints; ++j) {
      Body body;
      body.parent = j;
      body.joint = j;
      body.prismatic = Fraction() < 0.25;
      body.turns = true;
      const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> rotation =
          body.prismatic
              ? Eigen::Matrix3f::Identity()
              : Eigen::AngleAxisf(static_cast<float>(3 * Fraction()), Direction().cast<float>())
                    .toRotationMatrix();
      std::copy_n(rotation.data(), 9, body.rotation);
      const Eigen::Vector3f position = (0.5 * Fraction() * Direction()).cast<float>();
      std::copy_n(position.data(), 3, body.position);
      const Eigen::Vector3f axis = Direction().cast<float>();
      std::copy_n(axis.data(), 3, body.axis);
      robot_.bodies.push_back(body);
      q_.push_back(3 * (2 * Fraction() - 1));
      // Short stretches, and such as turn a joint all the way round.
      half_widths_.push_back(std::pow(10, -2 + 2.5 * Fraction()));
    }
    const Eigen::Vector3f center = (0.5 * Fraction() * Direction()).cast<float>();
    radius_ = 0.3 * Fraction();
    Node node{};
    std::copy_n(center.data(), 3, node.center);
    node.radius = static_cast<float>(radius_);
    robot_.nodes.push_back(node);
    weights_.assign(static_cast<std::size_t>(num_joints), 0.0);
    normal_ = Direction();
  }

  /// The furthest that points were found to move along the normal; learns the weights.
  double Furthest() {
    double furthest = 0;
    for (int start = 0; start < 20; ++start) {
      std::vector<double> best;
      for (const double width : half_widths_) best.push_back(Fraction() < 0.5 ? width : -width);
      Vector3d point = start < 2 ? Vector3d(start == 0 ? normal_ : -normal_) : Direction();
      double least = Moved(best, point);
      for (int step = 0; step < 30; ++step) {
        std::vector<double> moved = best;
        Vector3d other = point;
        if (step % 2 == 0) {
          other = (point + 0.5 * Direction()).normalized();
        } else {
          const auto j = static_cast<std::size_t>(Fraction() * static_cast<double>(moved.size()));
          moved[j] = half_widths_[j] * (2 * Fraction() - 1);
        }
        const double reached = Moved(moved, other);
        if (reached < least) continue;
        least = reached;
        best = moved;
        point = other;
      }
      furthest = std::max(furthest, least);
    }
    return furthest;
  }

  double Bound() {
    constexpr double kBoundFactor = 1 + 1e-5;
    std::vector<float> weights;
    for (const double weight : weights_) {
      weights.push_back(static_cast<float>(weight * kBoundFactor));
    }
    robot_.reaches = weights;
    std::vector<float> q, half_widths;
    for (std::size_t j = 0; j < q_.size(); ++j) {
      q.insert(q.end(), kBlock, static_cast<float>(q_[j]));
      half_widths.insert(half_widths.end(), kBlock, static_cast<float>(half_widths_[j]));
    }
    SphereScratch scratch;
    scratch.Reset(robot_, {});
    BlockQuery query;
    query.q = q.data();
    query.half_widths = half_widths.data();
    HWY_NAMESPACE::Placement placement(robot_, &scratch.buffers(), query.q, 0);
    const int last = robot_.num_joints;
    placement.PlaceRoot(0, last);
    const HWY_NAMESPACE::MotionBounds<true> bounds(robot_, &scratch.buffers(), query, 0, placement);
    const HWY_NAMESPACE::MovingPart part{0, last, robot_.nodes[0].radius, robot_.reaches.data()};
    const Eigen::Vector3f n = normal_.cast<float>();
    return HWY_NAMESPACE::hn::GetLane(
        bounds.Along(HWY_NAMESPACE::Fill(n.data()), part, robot_.reaches.data()));
  }

  /// Of any direction.
  double Arcs() const {
    double arcs = 0;
    for (std::size_t j = 0; j < weights_.size(); ++j) arcs += half_widths_[j] * weights_[j];
    return arcs;
  }

 private:
  double Fraction() { return UniformFraction(&random_); }
  Vector3d Direction() {
    Vector3d v;
    do {
      for (int k = 0; k < 3; ++k) v[k] = 2 * Fraction() - 1;
    } while (v.norm() > 1 || v.norm() < 0.1);
    return v.normalized();
  }

  /// Poses in W of the bodies.
  std::vector<Eigen::Isometry3d> PosesAt(const std::vector<double>& q) const {
    std::vector<Eigen::Isometry3d> poses = {Eigen::Isometry3d::Identity()};
    for (std::size_t j = 0; j < q.size(); ++j) {
      const Body& body = robot_.bodies[j + 1];
      Eigen::Isometry3d X = poses.back();
      X.translate(Eigen::Map<const Eigen::Vector3f>(body.position).cast<double>());
      if (body.prismatic) {
        X.translate(q[j] * Eigen::Map<const Eigen::Vector3f>(body.axis).cast<double>());
      } else {
        X.rotate(Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(body.rotation)
                     .cast<double>());
        X.rotate(Eigen::AngleAxisd(q[j], Vector3d::UnitZ()));
      }
      poses.push_back(X);
    }
    return poses;
  }

  /// How far along the normal a point moves, that way from the middle on the surface of the ball.
  double Moved(const std::vector<double>& by, const Vector3d& way_W) {
    std::vector<double> q = q_;
    for (std::size_t j = 0; j < q.size(); ++j) q[j] += by[j];
    const auto before = PosesAt(q_);
    const auto after = PosesAt(q);
    const Vector3d center =
        before.back() * Eigen::Map<const Eigen::Vector3f>(robot_.nodes[0].center).cast<double>();
    const Vector3d p_W = center + radius_ * way_W;
    const Vector3d p = before.back().inverse() * p_W;
    const Vector3d moved_W = after.back() * p;
    for (std::size_t j = 0; j < q.size(); ++j) {
      // Of a joint that turns, the distance from its axis.
      const Vector3d from_joint = after[j + 1].inverse() * moved_W;
      const double weight = robot_.bodies[j + 1].prismatic ? 1 : from_joint.head<2>().norm();
      weights_[j] = std::max(weights_[j], weight);
    }
    return std::abs(normal_.dot(moved_W - p_W));
  }

  std::mt19937_64& random_;
  SphereRobot robot_;
  double radius_ = 0;
  Vector3d normal_;
  std::vector<double> q_, half_widths_, weights_;
};

TEST(MotionBoundsTest, NothingMovesFurtherAlongADirection) {
  std::mt19937_64 random(7);
  int num_tight = 0;
  int num_less = 0;
  const int num_chains = Trials(2000);
  for (int i = 0; i < num_chains; ++i) {
    DrawnChain chain(&random);
    const double furthest = chain.Furthest();
    const double bound = chain.Bound();
    ASSERT_LE(furthest, bound) << "chain " << i;
    num_tight += furthest > 0.9 * bound ? 1 : 0;
    num_less += bound < 0.7 * chain.Arcs() ? 1 : 0;
  }
  EXPECT_GT(num_tight, num_chains / 20);
  EXPECT_GT(num_less, num_chains / 10);
}

}  // namespace
}  // namespace planbench::kernels
