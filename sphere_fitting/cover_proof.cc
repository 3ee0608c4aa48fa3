#include "sphere_fitting/cover_proof.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "sphere_fitting/thinned_points.h"

namespace planbench {
namespace {

using Eigen::Vector3d;
using Piece = std::array<Vector3d, 3>;

constexpr double kMargin = 1e-9;      // m: more than rounding does to points and distances
constexpr double kVoidMargin = 1e-7;  // m: more than it does to points in which spheres meet
constexpr double kResolution = 2e-4;  // of the body's extent
constexpr int kPatientRounds = 20;    // Voids that are still there are closed with more force.

double RoundUp(double radius) { return std::ceil(radius * 1e6) / 1e6; }

// By how much a ball would have to grow to contain the points with a margin; at most 0: it does.
double Lacking(const Ball& ball, std::span<const Vector3d> points) {
  double farthest2 = 0;
  for (const Vector3d& point : points) {
    farthest2 = std::max(farthest2, (point - ball.center).squaredNorm());
  }
  return std::sqrt(farthest2) + kMargin - ball.radius;
}

struct Nearest {
  std::size_t ball = 0;
  double lacking = std::numeric_limits<double>::infinity();
};
Nearest NearestBall(std::span<const Ball> balls, std::span<const Vector3d> points) {
  Nearest nearest;
  for (std::size_t k = 0; k < balls.size(); ++k) {
    const double lacking = Lacking(balls[k], points);
    if (lacking < nearest.lacking) nearest = {k, lacking};
  }
  return nearest;
}

// Finds the pieces of triangles, not longer than the resolution, that are in none of the balls.
template <typename Bare>
class Subdivision {
 public:
  // `bare(piece, nearest)` is called for each; it may enlarge balls, and returns whether to go on.
  Subdivision(const std::vector<Ball>& balls, double resolution, const Bare& bare)
      : balls_(balls), resolution_(resolution), bare_(bare), all_(balls.size()) {
    std::iota(all_.begin(), all_.end(), std::size_t{0});
  }
  // False: not to go on.
  bool Visit(const Piece& triangle) { return Visit(triangle, all_); }

 private:
  // `near`: the balls that reach the piece.
  bool Visit(const Piece& piece, const std::vector<std::size_t>& near) {
    for (const std::size_t k : near) {
      if (Lacking(balls_[k], piece) <= 0) return true;
    }
    std::size_t longest = 0;
    double length2 = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double edge2 = (piece[(k + 1) % 3] - piece[k]).squaredNorm();
      if (edge2 > length2) {
        longest = k;
        length2 = edge2;
      }
    }
    if (length2 <= resolution_ * resolution_) {
      const Nearest nearest = NearestBall(balls_, piece);
      return nearest.lacking <= 0 || bare_(piece, nearest);
    }
    const Vector3d& from = piece[longest];
    const Vector3d& to = piece[(longest + 1) % 3];
    const Vector3d& top = piece[(longest + 2) % 3];
    const Vector3d middle = (from + to) / 2;
    std::vector<std::size_t> nearer;
    const double radius = std::max(std::sqrt(length2) / 2, (top - middle).norm());
    for (const std::size_t k : near) {
      const double reach = balls_[k].radius + radius + kMargin;
      if ((balls_[k].center - middle).squaredNorm() <= reach * reach) nearer.push_back(k);
    }
    return Visit({from, middle, top}, nearer) && Visit({middle, to, top}, nearer);
  }

  const std::vector<Ball>& balls_;
  double resolution_;
  const Bare& bare_;
  std::vector<std::size_t> all_;
};

template <typename Bare>
void ForBarePieces(const LinkBody& body, const std::vector<Ball>& balls, double resolution,
                   const Bare& bare) {
  Subdivision<Bare> subdivision(balls, resolution, bare);
  for (const Solid* solid : body.hulls()) {
    const TriangleMesh& mesh = solid->mesh();
    for (const auto& [a, b, c] : mesh.triangles) {
      if (!subdivision.Visit({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]})) return;
    }
  }
}

// The points in which three spheres meet, or pass each other within rounding: none or two.
std::vector<Vector3d> MeetingPoints(const Ball& a, const Ball& b, const Ball& c) {
  const Vector3d ab = b.center - a.center;
  const double d = ab.norm();
  if (d == 0) return {};
  const Vector3d x = ab / d;
  const Vector3d ac = c.center - a.center;
  const double i = x.dot(ac);
  const Vector3d off = ac - i * x;
  const double j = off.norm();
  if (j < 1e-11) return {};  // On one line: they meet in a circle or not at all.
  const Vector3d y = off / j;
  const double px = (a.radius * a.radius - b.radius * b.radius + d * d) / (2 * d);
  const double py =
      (a.radius * a.radius - c.radius * c.radius + i * i + j * j - 2 * i * px) / (2 * j);
  const double pz2 = a.radius * a.radius - px * px - py * py;
  if (pz2 < -1e-12) return {};
  const Vector3d foot = a.center + px * x + py * y;
  const Vector3d rise = std::sqrt(std::max(0.0, pz2)) * x.cross(y);
  return {foot + rise, foot - rise};
}

double Extent(const LinkBody& body) {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  for (const Solid* solid : body.hulls()) {
    for (const Vector3d& vertex : solid->mesh().vertices) {
      low = low.cwiseMin(vertex);
      high = high.cwiseMax(vertex);
    }
  }
  return (high - low).norm();
}

}  // namespace

CoverProof::CoverProof(const LinkBody& body)
    : body_(body),
      resolution_m_(body.has_solids() ? std::max(1e-5, kResolution * Extent(body)) : 1e-5) {}

std::vector<Vector3d> CoverProof::VoidCorners(std::span<const Ball> balls) const {
  std::vector<Vector3d> corners;
  std::vector<std::size_t> near;  // To the first ball, and after it.
  std::vector<std::size_t> around;
  for (std::size_t a = 0; a < balls.size(); ++a) {
    near.clear();
    around.clear();
    for (std::size_t b = 0; b < balls.size(); ++b) {
      const double distance = (balls[b].center - balls[a].center).norm();
      if (b == a || distance > balls[a].radius + balls[b].radius + kVoidMargin) continue;
      around.push_back(b);
      if (b > a) near.push_back(b);
    }
    for (std::size_t m = 0; m < near.size(); ++m) {
      for (std::size_t n = m + 1; n < near.size(); ++n) {
        const std::size_t b = near[m];
        const std::size_t c = near[n];
        for (const Vector3d& point : MeetingPoints(balls[a], balls[b], balls[c])) {
          const bool covered = std::any_of(around.begin(), around.end(), [&](std::size_t k) {
            return k != b && k != c &&
                   (point - balls[k].center).norm() < balls[k].radius - kVoidMargin;
          });
          if (!covered && body_.HullDepth(point) > -kVoidMargin) corners.push_back(point);
        }
      }
    }
  }
  return corners;
}

// From a corner of a void, which balls touch, to a point that they are as far from as any near it.
Vector3d CoverProof::InVoid(std::span<const Ball> balls, const Vector3d& corner) const {
  Vector3d p = corner;
  double clearance = NearestBall(balls, {&p, 1}).lacking;
  for (double step = 100 * resolution_m_; step > kVoidMargin;) {
    bool farther = false;
    for (int direction = 0; direction < 26 && !farther; ++direction) {
      const int code = direction < 13 ? direction : direction + 1;  // 13 is no direction.
      const Eigen::Vector3i signs(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
      const Vector3d to = p + step * signs.cast<double>().normalized();
      const double clearance_there = NearestBall(balls, {&to, 1}).lacking;
      if (clearance_there <= clearance || body_.HullDepth(to) <= -kVoidMargin) continue;
      p = to;
      clearance = clearance_there;
      farther = true;
    }
    if (!farther) step /= 2;
  }
  return p;
}

std::vector<Vector3d> CoverProof::FindBarePoints(const std::vector<Ball>& balls,
                                                 double resolution_m, double apart_m) const {
  ThinnedPoints bare(apart_m);
  ForBarePieces(body_, balls, resolution_m, [&](const Piece& piece, const Nearest&) {
    for (const Vector3d& corner : piece) {
      if (NearestBall(balls, {&corner, 1}).lacking > 0) bare.Add(corner);
    }
    return true;
  });
  for (const Vector3d& corner : VoidCorners(balls)) bare.Add(InVoid(balls, corner));
  return bare.points();
}

void CoverProof::Close(std::vector<Ball>* balls) const {
  ForBarePieces(body_, *balls, resolution_m_, [&](const Piece&, const Nearest& nearest) {
    Ball& ball = (*balls)[nearest.ball];
    ball.radius = RoundUp(ball.radius + nearest.lacking);
    return true;
  });
  for (int round = 0;; ++round) {
    const std::vector<Vector3d> corners = VoidCorners(*balls);
    if (corners.empty()) return;
    const double force = std::max(0, round - kPatientRounds) * 0.01;
    for (const Vector3d& corner : corners) {
      const Vector3d bare = InVoid(*balls, corner);
      const Nearest nearest = NearestBall(*balls, {&bare, 1});
      if (nearest.lacking <= -kVoidMargin) continue;  // What grew for another corner holds it.
      Ball& ball = (*balls)[nearest.ball];
      const double lacking = std::max(0.0, nearest.lacking) + 2 * kVoidMargin;
      ball.radius = RoundUp(ball.radius + lacking + force * ball.radius);
    }
  }
}

bool CoverProof::Holds(const std::vector<Ball>& balls) const {
  bool holds = !balls.empty();
  if (!holds) return !body_.has_solids();
  ForBarePieces(body_, balls, resolution_m_, [&](const Piece&, const Nearest&) {
    holds = false;
    return false;
  });
  return holds && VoidCorners(balls).empty();
}

}  // namespace planbench
