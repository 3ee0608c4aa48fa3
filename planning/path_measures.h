#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "collision/edge_checker.h"
#include "planning/plan_result.h"

namespace planbench {

/// A path whose measures are taken, in the scene that the checker holds.
class PathSurvey {
 public:
  /// The path has waypoints, all of the group's size, and is sampled as `edges` says;
  /// `base_positions`: full positions that held joints have. Refers to all of them.
  PathSurvey(const EdgeChecker& edges, const Path& path, std::span<const double> base_positions)
      : edges_(&edges), path_(&path), base_positions_(base_positions) {}

  const JointSpace& space() const { return edges_->space(); }
  const Path& path() const { return *path_; }

  /// Travel of the tip link's origin, straight from sample to sample, m; of several tips, the sum
  /// of theirs.
  double TipTravel() const;

  /// Distance to the nearest collision over samples, m; infinite if there is nothing to collide
  /// with.
  struct Clearance {
    double minimum_m;
    double mean_m;  ///< Each sample weighted by the motion it stands for.
  };
  /// Taken once, however often it is asked for: it is what takes the time.
  const Clearance& clearance();

 private:
  const EdgeChecker* edges_;
  const Path* path_;
  std::span<const double> base_positions_;
  std::optional<Clearance> clearance_;
};

/// How the tables show the median of a measure; what has no heading is not shown.
struct MeasureColumn {
  const char* heading = nullptr;             ///< Of raw paths.
  const char* heading_simplified = nullptr;  ///< Of simplified paths.
  double scale = 1;
  int decimals = 2;
};

/// A measure of path quality: all that the judge, the messages, the database, the tables and the
/// documentation know of it.
struct PathMeasure {
  const char* name;     ///< In messages; column of the database, `_simplified` added for such.
  const char* unit;     ///< "" if it has none.
  const char* meaning;  ///< As docs/database.md says it.
  double (*take)(PathSurvey& path);
  /// Taken of valid paths only, and if asked for.
  bool is_clearance = false;
  MeasureColumn column = {};
};

/// Every measure, in the order in which they are shown.
std::span<const PathMeasure> PathMeasures();

/// Values by the measure's name: finite, or infinite where there is nothing to collide with. What
/// was not taken is absent.
using MeasuredValues = std::map<std::string, double>;

/// The value of that name; nothing if it is absent.
std::optional<double> FindMeasure(const MeasuredValues& values, const std::string& name);

/// Takes the measures; clearances only `with_clearance`.
MeasuredValues TakeMeasures(PathSurvey* path, bool with_clearance);

/// Sum of L2 joint-space distances between waypoints (rad and m unweighted, continuous joints the
/// short way), as OMPL and MotionBenchMaker take it.
double PathLength(const JointSpace& space, const Path& path);

/// Smoothness as OMPL defines it (PathGeometric::smoothness): sum over inner waypoints of
/// (2 (pi - angle) / (a + b))^2 with a, b the lengths of the two segments and `angle` the angle
/// between them; 0 is smoothest. Repeated waypoints are skipped.
double PathSmoothness(const JointSpace& space, const Path& path);

}  // namespace planbench
