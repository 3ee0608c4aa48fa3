#include "planner_rrtc/rrtc_planner.h"

#include <fmt/format.h>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/datastructures/NearestNeighborsGNATNoThreadSafety.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include "planner_rrtc/ompl_joint_space.h"

namespace planbench {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// OMPL's warnings and errors go where the process's go; what it has to tell of every request is
/// left out.
void RedirectOmplMessages() {
  class SpdlogHandler final : public ompl::msg::OutputHandler {
   public:
    void log(const std::string& text, ompl::msg::LogLevel level, const char* /*filename*/,
             int /*line*/) override {
      spdlog::log(level >= ompl::msg::LOG_ERROR ? spdlog::level::err : spdlog::level::warn,
                  "OMPL: {}", text);
    }
  };
  static std::once_flag once;
  std::call_once(once, [] {
    static SpdlogHandler handler;
    ompl::msg::useOutputHandler(&handler);
    ompl::msg::setLogLevel(ompl::msg::LOG_WARN);
  });
}

/// Positions with continuous joints wrapped, as the OMPL space wants them.
void SetState(const JointSpace& joints, const Configuration& q, ob::State* state) {
  const std::span<double> positions = OmplPositions(state, q.size());
  std::copy(q.begin(), q.end(), positions.begin());
  joints.Wrap(positions);
}

class QueryStateValidity final : public ob::StateValidityChecker {
 public:
  QueryStateValidity(const ob::SpaceInformationPtr& si, EdgeChecker& edges)
      : ob::StateValidityChecker(si), edges_(edges) {}

  bool isValid(const ob::State* state) const override {
    return edges_.IsValidState(OmplPositions(state, si_->getStateDimension()));
  }

 private:
  EdgeChecker& edges_;
};

class QueryMotionValidator final : public ob::MotionValidator {
 public:
  QueryMotionValidator(const ob::SpaceInformationPtr& si, EdgeChecker& edges)
      : ob::MotionValidator(si), edges_(edges) {}

  bool checkMotion(const ob::State* s1, const ob::State* s2) const override {
    const std::size_t n = si_->getStateDimension();
    // OMPL's contract of this function: s1 has been found valid. RRTConnect keeps it, in the goal
    // tree by a check of the new state before the motion from it to the tree.
    const bool valid = edges_.IsValidEdge(OmplPositions(s1, n), OmplPositions(s2, n),
                                          /*from_is_free=*/true);
    ++(valid ? valid_ : invalid_);
    return valid;
  }

  bool checkMotion(const ob::State* s1, const ob::State* s2,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(s1, s2)) return true;
    // The valid stretch is not measured; s1 is the last state known to be valid.
    if (last_valid.first != nullptr && last_valid.first != s1) {
      si_->copyState(last_valid.first, s1);
    }
    last_valid.second = 0;
    return false;
  }

 private:
  EdgeChecker& edges_;
};

/// A goal box: its nominal point first, then uniform samples, by a generator of its own.
class GoalBoxRegion final : public ob::GoalSampleableRegion {
 public:
  GoalBoxRegion(const ob::SpaceInformationPtr& si, const JointSpace& joints, const GoalBox& box,
                std::uint64_t seed)
      : ob::GoalSampleableRegion(si), joints_(joints), box_(box), rng_(OmplSeed(seed)) {
    is_point_ = box.lower == box.upper;
  }

  double distanceGoal(const ob::State* state) const override {
    const std::span<const double> q = OmplPositions(state, box_.nominal.size());
    double sum = 0;
    for (int j = 0; j < joints_.size(); ++j) {
      const auto k = static_cast<std::size_t>(j);
      const double offset = joints_.Difference(j, box_.nominal[k], q[k]);
      const double inside =
          std::clamp(offset, box_.lower[k] - box_.nominal[k], box_.upper[k] - box_.nominal[k]);
      sum += (offset - inside) * (offset - inside);
    }
    return std::sqrt(sum);
  }

  void sampleGoal(ob::State* state) const override {
    Configuration q = box_.nominal;
    if (nominal_sampled_) {
      for (int j = 0; j < joints_.size(); ++j) {
        const auto k = static_cast<std::size_t>(j);
        double below = box_.lower[k] - q[k];
        double above = box_.upper[k] - q[k];
        if (joints_.joint(j).continuous) {
          // One turn at most; short of half a turn, so that the short way from the nominal point is
          // the sample's.
          constexpr double kHalfTurn = std::numbers::pi - 1e-9;
          below = std::max(below, -kHalfTurn);
          above = std::min(above, kHalfTurn);
        }
        q[k] += rng_.uniformReal(below, above);
      }
    }
    nominal_sampled_ = true;
    SetState(joints_, q, state);
  }

  unsigned int maxSampleCount() const override {
    return is_point_ ? 1 : std::numeric_limits<unsigned int>::max();
  }

 private:
  const JointSpace& joints_;
  const GoalBox& box_;
  bool is_point_ = false;
  mutable bool nominal_sampled_ = false;
  mutable ompl::RNG rng_;
};

/// OMPL's default nearest-neighbour structure with a stop watch on the queries, which are long
/// beside the two clock readings.
template <typename T>
class TimedNeighbors final : public ompl::NearestNeighborsGNATNoThreadSafety<T> {
 public:
  explicit TimedNeighbors(double* seconds) : seconds_(seconds) {}

  T nearest(const T& data) const override {
    const auto begin = std::chrono::steady_clock::now();
    T neighbor = ompl::NearestNeighborsGNATNoThreadSafety<T>::nearest(data);
    *seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return neighbor;
  }

 private:
  double* seconds_;
};

class SeededRrtConnect final : public og::RRTConnect {
 public:
  SeededRrtConnect(const ob::SpaceInformationPtr& si, std::uint64_t seed) : og::RRTConnect(si) {
    // RRTConnect draws nothing from it today; what it will must not come from OMPL's process-wide
    // seed.
    rng_.setLocalSeed(OmplSeed(seed));
    tStart_ = std::make_shared<TimedNeighbors<Motion*>>(&nearest_seconds_);
    tGoal_ = std::make_shared<TimedNeighbors<Motion*>>(&nearest_seconds_);
  }

  std::size_t NumStartStates() const { return tStart_->size(); }
  std::size_t NumGoalStates() const { return tGoal_->size(); }
  double nearest_seconds() const { return nearest_seconds_; }

 private:
  double nearest_seconds_ = 0;
};

Path ToPath(const ob::PathPtr& path, std::size_t n) {
  Path waypoints;
  for (const ob::State* state : path->as<og::PathGeometric>()->getStates()) {
    const std::span<const double> q = OmplPositions(state, n);
    waypoints.emplace_back(q.begin(), q.end());
  }
  return waypoints;
}

/// The planner's range unless the request brings its own.
double RangeOf(double range, const std::map<std::string, std::string>& parameters) {
  YamlNode request = YamlNode::Parse("{}", "request parameters");
  for (const auto& [key, text] : parameters) {
    request.Override(key, text, "request parameter " + key);
  }
  request.AllowOnly({"range"});
  return parameters.contains("range") ? request.At("range").PositiveDouble() : range;
}

}  // namespace

RrtConnectPlanner::RrtConnectPlanner(const Robot& robot, const YamlNode& settings)
    : Planner(robot) {
  settings.AllowOnly({"range"});
  const std::optional<YamlNode> range = settings.Find("range");
  range_ = range ? range->PositiveDouble() : kDefaultRange;
  RedirectOmplMessages();
}

PlannerDescription RrtConnectPlanner::Describe() const {
  PlannerDescription description;
  description.algorithm = "RRT-Connect";
  description.planner_class = PlannerClass::kSamplingGuided;
  description.backward = true;
  description.anytime = false;
  description.collision_models = AvailableCollisionModels();
  description.settings = {{"range", fmt::format("{}", range_)}};
  return description;
}

SearchResult RrtConnectPlanner::Search(SearchQuery& query) {
  const double range = RangeOf(range_, query.parameters());
  const JointSpace& joints = query.space();
  const ob::StateSpacePtr space = MakeOmplJointSpace(joints);
  std::int64_t iterations = 0;
  space->setStateSamplerAllocator([&](const ob::StateSpace* sampled_space) {
    return MakeOmplSampler(sampled_space, joints, query.seed(), &iterations);
  });

  const auto si = std::make_shared<ob::SpaceInformation>(space);
  si->setStateValidityChecker(std::make_shared<QueryStateValidity>(si, query.edges()));
  si->setMotionValidator(std::make_shared<QueryMotionValidator>(si, query.edges()));
  si->setup();

  const auto problem = std::make_shared<ob::ProblemDefinition>(si);
  ob::State* start = space->allocState();
  SetState(joints, query.start(), start);
  problem->addStartState(start);
  space->freeState(start);
  // Another seed than the sampler's, lest goals and samples be the same numbers.
  problem->setGoal(std::make_shared<GoalBoxRegion>(si, joints, query.goal(), ~query.seed()));

  SeededRrtConnect planner(si, query.seed());
  planner.setRange(range);
  planner.setProblemDefinition(problem);
  planner.setup();
  const ob::PlannerStatus status =
      planner.solve(ob::PlannerTerminationCondition([&query] { return query.ShouldStop(); }));

  SearchResult result;
  result.guidance_s = planner.nearest_seconds();
  result.counters = {{"iterations", static_cast<double>(iterations)},
                     {"states_start_tree", static_cast<double>(planner.NumStartStates())},
                     {"states_goal_tree", static_cast<double>(planner.NumGoalStates())}};
  if (status == ob::PlannerStatus::EXACT_SOLUTION) {
    result.status = PlanStatus::kSolved;
    result.path = ToPath(problem->getSolutionPath(), static_cast<std::size_t>(joints.size()));
  } else if (query.Cancelled()) {
    result.status = PlanStatus::kCancelled;
    result.message = "cancelled";
  } else if (query.ShouldStop()) {
    result.status = PlanStatus::kTimedOut;
    result.message = "the trees did not meet within the time limit";
  } else {
    throw std::runtime_error("OMPL gave up before the time limit: " + status.asString());
  }
  return result;
}

std::unique_ptr<Planner> MakeRrtcPlanner(const Robot& robot, const YamlNode& settings) {
  return std::make_unique<RrtConnectPlanner>(robot, settings);
}

}  // namespace planbench
