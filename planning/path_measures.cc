#include "planning/path_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "planning/motion_time.h"
#include "planning/path_samples.h"
#include "robot_model/group_kinematics.h"

namespace planbench {
namespace {

/// Angle between unit vectors, accurate near 0 and pi too (Kahan), where the arc cosine is not.
double AngleBetween(const std::vector<double>& u, const std::vector<double>& v) {
  double sum_squared = 0;
  double difference_squared = 0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    sum_squared += (u[k] + v[k]) * (u[k] + v[k]);
    difference_squared += (u[k] - v[k]) * (u[k] - v[k]);
  }
  return 2 * std::atan2(std::sqrt(difference_squared), std::sqrt(sum_squared));
}

}  // namespace

std::span<const PathMeasure> PathMeasures() {
  using P = PathSurvey;
  static constexpr auto kMeasures = std::to_array<PathMeasure>({
      {.name = "path_length",
       .unit = "rad, m",
       .meaning = "length in joint space",
       .take = [](P& p) { return PathLength(p.space(), p.path()); },
       .column = {.heading = "length", .heading_simplified = "simplified"}},
      {.name = "tip_travel",
       .unit = "m",
       .meaning =
           "travel of the tip link's origin, from sample to sample of the referee; of several "
           "tips, the sum",
       .take = [](P& p) { return p.TipTravel(); },
       .column = {.heading = "tip m"}},
      {.name = "smoothness",
       .unit = "",
       .meaning = "as OMPL defines it; 0 is smoothest",
       .take = [](P& p) { return PathSmoothness(p.space(), p.path()); }},
      {.name = "motion_time",
       .unit = "s",
       .meaning =
           "shortest time to follow the path exactly, each joint reaching its limit of "
           "velocity in 0.5 s at least; a limit below 0.0001, or none, counts as 1 rad/s or m/s",
       .take = [](P& p) { return MotionTime(p.space(), p.path()); }},
      {.name = "clearance",
       .unit = "m",
       .meaning =
           "smallest distance to a collision at the referee's samples of a valid path, if it was "
           "asked for",
       .take = [](P& p) { return p.clearance().minimum_m; },
       .is_clearance = true,
       .column = {.heading = "clearance mm", .scale = 1e3, .decimals = 1}},
      {.name = "clearance_mean",
       .unit = "m",
       .meaning = "its mean",
       .take = [](P& p) { return p.clearance().mean_m; },
       .is_clearance = true},
  });
  return kMeasures;
}

std::optional<double> FindMeasure(const MeasuredValues& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

MeasuredValues TakeMeasures(PathSurvey* path, bool with_clearance) {
  MeasuredValues values;
  for (const PathMeasure& measure : PathMeasures()) {
    if (with_clearance || !measure.is_clearance) values[measure.name] = measure.take(*path);
  }
  return values;
}

double PathSurvey::TipTravel() const {
  const PlanningGroup& group = edges_->checker().group();
  GroupKinematics kinematics(edges_->checker().robot().model, group, base_positions_);
  const std::vector<int> tips = group.tips();
  double travel_m = 0;
  std::vector<Eigen::Vector3d> previous;  // By tip.
  VisitSamples(*edges_, *path_, [&](int, double, const Configuration& q, double) {
    kinematics.Update(q);
    std::vector<Eigen::Vector3d> p_BT;
    for (const int tip : tips) p_BT.push_back(kinematics.X_BL(tip).translation());
    for (std::size_t i = 0; i < previous.size(); ++i) travel_m += (p_BT[i] - previous[i]).norm();
    previous = std::move(p_BT);
    return true;
  });
  return travel_m;
}

const PathSurvey::Clearance& PathSurvey::clearance() {
  if (clearance_) return *clearance_;
  double minimum_m = std::numeric_limits<double>::infinity();
  std::optional<double> previous_m;
  double weighted_sum = 0;
  double weight = 0;
  VisitSamples(*edges_, *path_, [&](int, double, const Configuration& q, double motion_m) {
    const double clearance_m = edges_->checker().FindClosest(q).distance_m;
    minimum_m = std::min(minimum_m, clearance_m);
    if (previous_m && motion_m > 0) {  // Nothing times infinity is no number.
      weighted_sum += motion_m * (*previous_m + clearance_m) / 2;
      weight += motion_m;
    }
    previous_m = clearance_m;
    return true;
  });
  // A path that moves nothing has the clearance of where it stands.
  return clearance_.emplace(Clearance{minimum_m, weight > 0 ? weighted_sum / weight : minimum_m});
}

double PathLength(const JointSpace& space, const Path& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += space.Distance(path[i - 1], path[i]);
  return length;
}

double PathSmoothness(const JointSpace& space, const Path& path) {
  double smoothness = 0;
  std::vector<double> previous_direction;
  double previous_length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double length = space.Distance(path[i - 1], path[i]);
    if (length == 0) continue;
    std::vector<double> direction = DirectionOf(space, path[i - 1], path[i], length);
    if (previous_length > 0) {
      // The turn between the two directions is pi minus the angle between the two segments.
      const double turn = AngleBetween(previous_direction, direction);
      const double curvature = 2 * turn / (previous_length + length);
      smoothness += curvature * curvature;
    }
    previous_direction = std::move(direction);
    previous_length = length;
  }
  return smoothness;
}

}  // namespace planbench
