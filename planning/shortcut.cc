#include "planning/shortcut.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <random>
#include <vector>

#include "common/random.h"
#include "planning/path_measures.h"

namespace planbench {
namespace {

/// Random shortcuts tried in a round.
constexpr int kAttempts = 20;

/// A path whose edges are the input's, or were found valid since.
struct CheckedPath {
  Path waypoints;
  std::vector<bool> found_valid;  ///< Of each edge.
};

CheckedPath BypassWaypoints(EdgeChecker* edges, const Path& path,
                            const std::function<bool()>& should_stop) {
  CheckedPath result = {{path.front()}, {}};
  std::size_t i = 0;
  while (i + 1 < path.size()) {
    std::size_t next = i + 1;
    for (std::size_t j = path.size() - 1; j > i + 1 && !should_stop(); --j) {
      if (edges->IsValidEdge(path[i], path[j])) {
        next = j;
        break;
      }
    }
    result.waypoints.push_back(path[next]);
    result.found_valid.push_back(next > i + 1);
    i = next;
  }
  return result;
}

/// A point on a path: on the edge from waypoint `segment` to the next.
struct PathPoint {
  std::size_t segment = 0;
  double from_segment_start = 0;  ///< Length along the edge.
  Configuration q;
};

/// A checked path with the lengths of its edges.
class MeasuredPath {
 public:
  MeasuredPath(const JointSpace& space, CheckedPath path) : space_(space), path_(std::move(path)) {
    Measure();
  }

  const Path& waypoints() const { return path_.waypoints; }
  bool FoundValid(std::size_t segment) const { return path_.found_valid[segment]; }
  double EdgeLength(std::size_t segment) const { return lengths_[segment]; }
  double TotalLength() const { return std::accumulate(lengths_.begin(), lengths_.end(), 0.0); }

  PathPoint At(double length) const {
    PathPoint point;
    while (point.segment + 1 < lengths_.size() && length > lengths_[point.segment]) {
      length -= lengths_[point.segment++];
    }
    const double segment_length = lengths_[point.segment];
    point.from_segment_start = std::min(length, segment_length);
    const double t = segment_length > 0 ? point.from_segment_start / segment_length : 0.0;
    point.q.resize(waypoints()[point.segment].size());
    space_.Interpolate(waypoints()[point.segment], waypoints()[point.segment + 1], t, point.q);
    return point;
  }

  /// Length along the path between two points, `a` on an earlier edge than `b`.
  double Between(const PathPoint& a, const PathPoint& b) const {
    double length = lengths_[a.segment] - a.from_segment_start + b.from_segment_start;
    for (std::size_t s = a.segment + 1; s < b.segment; ++s) length += lengths_[s];
    return length;
  }

  /// Puts the edge a -> b in place of what lies between the points; it and what remains of the two
  /// cut edges have been found valid.
  void Replace(const PathPoint& a, const PathPoint& b) {
    CheckedPath path;
    const auto append = [&path](const Configuration& q, bool found_valid) {
      if (path.waypoints.back() == q) return;
      path.waypoints.push_back(q);
      path.found_valid.push_back(found_valid);
    };
    path.waypoints.push_back(waypoints().front());
    for (std::size_t s = 0; s < a.segment; ++s) append(waypoints()[s + 1], FoundValid(s));
    append(a.q, true);
    append(b.q, true);
    append(waypoints()[b.segment + 1], true);
    for (std::size_t s = b.segment + 1; s < lengths_.size(); ++s) {
      append(waypoints()[s + 1], FoundValid(s));
    }
    path_ = std::move(path);
    Measure();
  }

 private:
  void Measure() {
    lengths_.clear();
    for (std::size_t i = 1; i < waypoints().size(); ++i) {
      lengths_.push_back(space_.Distance(waypoints()[i - 1], waypoints()[i]));
    }
  }

  const JointSpace& space_;
  CheckedPath path_;
  std::vector<double> lengths_;
};

/// Tries shortcuts between points of a path, and takes those that are valid.
class Shortener {
 public:
  Shortener(EdgeChecker* edges, CheckedPath path)
      : edges_(edges), path_(edges->space(), std::move(path)) {}

  const MeasuredPath& path() const { return path_; }

  /// Between the points at two lengths from the start, `from` <= `to`. True if it was taken.
  bool Try(double from, double to) {
    const PathPoint a = path_.At(from);
    const PathPoint b = path_.At(to);
    if (a.segment == b.segment) return false;
    const double gain = path_.Between(a, b) - edges_->space().Distance(a.q, b.q);
    if (gain < kLeastGain * path_.TotalLength()) return false;
    const Path& waypoints = path_.waypoints();
    if (!edges_->IsValidEdge(a.q, b.q) || !IsPartValid(a.segment, waypoints[a.segment], a.q) ||
        !IsPartValid(b.segment, b.q, waypoints[b.segment + 1])) {
      return false;
    }
    path_.Replace(a, b);
    return true;
  }

  /// Across each corner, between the points that far from it, as fractions of the edges on either
  /// side.
  void CutCorners(double fraction, const std::function<bool()>& should_stop) {
    double at = 0;  // of waypoint i
    for (std::size_t i = 1; i + 1 < path_.waypoints().size() && !should_stop(); ++i) {
      const double before = path_.EdgeLength(i - 1);
      const double after = path_.EdgeLength(i);
      at += before;
      if (!Try(at - fraction * before, at + fraction * after)) continue;
      // Two corners stand for it: on from the second.
      at += path_.EdgeLength(i) - fraction * before;
      ++i;
    }
  }

 private:
  /// What a shortcut gains at least, of the path's length: less is not worth checking an edge, nor
  /// two more waypoints.
  static constexpr double kLeastGain = 3e-3;

  /// Part of a proven edge needs no proof. The samples of part of a sampled edge lie elsewhere than
  /// those of the whole; and how the input's edges were found valid is not known here.
  bool IsPartValid(std::size_t segment, const Configuration& from, const Configuration& to) {
    return (edges_->method() == EdgeCheck::kCertified && path_.FoundValid(segment)) ||
           edges_->IsValidEdge(from, to);
  }

  EdgeChecker* edges_;
  MeasuredPath path_;
};

}  // namespace

Path ShortcutPath(EdgeChecker* edges, const Path& path, std::uint64_t seed, int rounds,
                  const std::function<bool()>& should_stop) {
  if (path.size() < 3) return path;
  Shortener shortener(edges, BypassWaypoints(edges, path, should_stop));
  std::mt19937_64 generator(seed);
  for (int round = 0; round < rounds; ++round) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (should_stop() || shortener.path().waypoints().size() == 2) {
        return shortener.path().waypoints();
      }
      const double total = shortener.path().TotalLength();
      const double at_1 = UniformFraction(&generator) * total;
      const double at_2 = UniformFraction(&generator) * total;
      shortener.Try(std::min(at_1, at_2), std::max(at_1, at_2));
    }
    for (const double fraction : {0.5, 0.25}) shortener.CutCorners(fraction, should_stop);
  }
  return shortener.path().waypoints();
}

}  // namespace planbench
