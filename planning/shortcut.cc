#include "planning/shortcut.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <random>
#include <vector>

#include "planning/path_metrics.h"

namespace planbench {
namespace {

Path BypassWaypoints(EdgeChecker* edges, const Path& path,
                     const std::function<bool()>& should_stop) {
  Path result = {path.front()};
  std::size_t i = 0;
  while (i + 1 < path.size()) {
    std::size_t next = i + 1;
    for (std::size_t j = path.size() - 1; j > i + 1 && !should_stop(); --j) {
      if (edges->IsValidEdge(path[i], path[j])) {
        next = j;
        break;
      }
    }
    result.push_back(path[next]);
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

/// A path with the lengths of its edges.
class MeasuredPath {
 public:
  MeasuredPath(const JointSpace& space, Path path) : space_(space), path_(std::move(path)) {
    for (std::size_t i = 1; i < path_.size(); ++i) {
      lengths_.push_back(space_.Distance(path_[i - 1], path_[i]));
    }
  }

  const Path& path() const { return path_; }
  double TotalLength() const { return std::accumulate(lengths_.begin(), lengths_.end(), 0.0); }

  PathPoint At(double length) const {
    PathPoint point;
    while (point.segment + 1 < lengths_.size() && length > lengths_[point.segment]) {
      length -= lengths_[point.segment++];
    }
    const double segment_length = lengths_[point.segment];
    point.from_segment_start = std::min(length, segment_length);
    const double t = segment_length > 0 ? point.from_segment_start / segment_length : 0.0;
    point.q.resize(path_[point.segment].size());
    space_.Interpolate(path_[point.segment], path_[point.segment + 1], t, point.q);
    return point;
  }

  /// Length along the path between two points, `a` on an earlier edge than `b`.
  double Between(const PathPoint& a, const PathPoint& b) const {
    double length = lengths_[a.segment] - a.from_segment_start + b.from_segment_start;
    for (std::size_t s = a.segment + 1; s < b.segment; ++s) length += lengths_[s];
    return length;
  }

  /// Puts the edge a -> b in place of what lies between the points.
  void Replace(const PathPoint& a, const PathPoint& b) {
    Path path(path_.begin(), path_.begin() + static_cast<std::ptrdiff_t>(a.segment) + 1);
    if (path.back() != a.q) path.push_back(a.q);
    path.push_back(b.q);
    auto rest = path_.begin() + static_cast<std::ptrdiff_t>(b.segment) + 1;
    if (*rest == b.q) ++rest;
    path.insert(path.end(), rest, path_.end());
    *this = MeasuredPath(space_, std::move(path));
  }

  MeasuredPath& operator=(MeasuredPath&& other) noexcept {
    path_ = std::move(other.path_);
    lengths_ = std::move(other.lengths_);
    return *this;
  }

 private:
  const JointSpace& space_;
  Path path_;
  std::vector<double> lengths_;
};

}  // namespace

Path ShortcutPath(EdgeChecker* edges, const Path& path, std::uint64_t seed, int attempts,
                  const std::function<bool()>& should_stop) {
  if (path.size() < 3) return path;
  const JointSpace& space = edges->space();
  MeasuredPath measured(space, BypassWaypoints(edges, path, should_stop));

  std::mt19937_64 generator(seed);
  // Not std::uniform_real_distribution: its values differ between standard libraries.
  const auto uniform01 = [&generator] { return static_cast<double>(generator() >> 11) * 0x1p-53; };

  for (int attempt = 0; attempt < attempts && measured.path().size() > 2; ++attempt) {
    if (should_stop()) break;
    const double total = measured.TotalLength();
    const double at_1 = uniform01() * total;
    const double at_2 = uniform01() * total;
    const PathPoint a = measured.At(std::min(at_1, at_2));
    const PathPoint b = measured.At(std::max(at_1, at_2));
    if (a.segment == b.segment) continue;
    // Gains below this are rounding, not worth two more waypoints.
    constexpr double kLeastGain = 1e-6;  // rad or m
    if (space.Distance(a.q, b.q) > measured.Between(a, b) - kLeastGain) continue;
    // The parts that remain of the two cut edges are new edges too: their samples lie elsewhere
    // than those of the whole edge.
    if (!edges->IsValidEdge(a.q, b.q)) continue;
    if (!edges->IsValidEdge(measured.path()[a.segment], a.q)) continue;
    if (!edges->IsValidEdge(b.q, measured.path()[b.segment + 1])) continue;
    measured.Replace(a, b);
  }
  return measured.path();
}

}  // namespace planbench
