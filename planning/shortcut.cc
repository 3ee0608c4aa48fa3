#include "planning/shortcut.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <random>
#include <vector>

#include "planning/path_measures.h"

namespace planbench {
namespace {

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

}  // namespace

Path ShortcutPath(EdgeChecker* edges, const Path& path, std::uint64_t seed, int attempts,
                  const std::function<bool()>& should_stop) {
  if (path.size() < 3) return path;
  const JointSpace& space = edges->space();
  MeasuredPath measured(space, BypassWaypoints(edges, path, should_stop));

  std::mt19937_64 generator(seed);
  // Not std::uniform_real_distribution: its values differ between standard libraries.
  const auto uniform01 = [&generator] { return static_cast<double>(generator() >> 11) * 0x1p-53; };

  // Part of a proven edge needs no proof. The samples of part of a sampled edge lie elsewhere than
  // those of the whole; and how the input's edges were found valid is not known here.
  const auto part_is_valid = [&](std::size_t segment, const Configuration& from,
                                 const Configuration& to) {
    return (edges->method() == EdgeCheck::kCertified && measured.FoundValid(segment)) ||
           edges->IsValidEdge(from, to);
  };
  for (int attempt = 0; attempt < attempts && measured.waypoints().size() > 2; ++attempt) {
    if (should_stop()) break;
    const double total = measured.TotalLength();
    const double at_1 = uniform01() * total;
    const double at_2 = uniform01() * total;
    const PathPoint a = measured.At(std::min(at_1, at_2));
    const PathPoint b = measured.At(std::max(at_1, at_2));
    if (a.segment == b.segment) continue;
    // Less is not worth checking an edge, nor two more waypoints.
    constexpr double kLeastGain = 1e-3;  // of the path's length
    if (space.Distance(a.q, b.q) > measured.Between(a, b) - kLeastGain * total) continue;
    if (!edges->IsValidEdge(a.q, b.q)) continue;
    if (!part_is_valid(a.segment, measured.waypoints()[a.segment], a.q)) continue;
    if (!part_is_valid(b.segment, b.q, measured.waypoints()[b.segment + 1])) continue;
    measured.Replace(a, b);
  }
  return measured.waypoints();
}

}  // namespace planbench
