#include "planner_rrtc/ompl_planner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/samplers/informed/RejectionInfSampler.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>
#include <ompl/util/Exception.h>
#include <ompl/util/RandomNumbers.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>

#include "common/error.h"
#include "planner_rrtc/ompl_algorithms.h"
#include "planner_rrtc/ompl_joint_space.h"
#include "planner_rrtc/ompl_parameter.h"
#include "planner_rrtc/stopped_search.h"
#include "planning/goal_sampler.h"

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

/// Silences OMPL for a while.
class OmplSilence {
 public:
  OmplSilence() : level_(ompl::msg::getLogLevel()) { ompl::msg::setLogLevel(ompl::msg::LOG_NONE); }
  ~OmplSilence() { ompl::msg::setLogLevel(level_); }
  OmplSilence(const OmplSilence&) = delete;
  OmplSilence& operator=(const OmplSilence&) = delete;

 private:
  ompl::msg::LogLevel level_;
};

bool SetParameter(ob::ParamSet* parameters, const std::string& key, const std::string& value) {
  try {
    return parameters->setParam(key, value);
  } catch (const std::exception&) {  // what OMPL's conversion of numbers throws
    return false;
  }
}

/// A number of 32 bits, not 0, different for seeds that differ anywhere in their 64 bits (but for
/// chance).
std::uint32_t OmplSeed(std::uint64_t seed) {
  // The finalizer of SplitMix64 (Steele, Lea and Flood, 2014) spreads all bits over the upper half.
  seed += 0x9e3779b97f4a7c15u;
  seed = (seed ^ (seed >> 30)) * 0xbf58476d1ce4e5b9u;
  seed = (seed ^ (seed >> 27)) * 0x94d049bb133111ebu;
  const auto folded = static_cast<std::uint32_t>(seed >> 32);
  return folded == 0 ? 1 : folded;
}

/// Path length, for spaces that OMPL cannot sample the informed subset of: by rejection.
class PathLengthObjective final : public ob::PathLengthOptimizationObjective {
 public:
  using ob::PathLengthOptimizationObjective::PathLengthOptimizationObjective;

  ob::InformedSamplerPtr allocInformedStateSampler(const ob::ProblemDefinitionPtr& problem,
                                                   unsigned int max_calls) const override {
    return std::make_shared<ob::RejectionInfSampler>(problem, max_calls);
  }
};

/// OMPL's questions, answered by the EdgeChecker of the query being served, *edges.
class EdgeStateValidity final : public ob::StateValidityChecker {
 public:
  EdgeStateValidity(const ob::SpaceInformationPtr& si, EdgeChecker* const* edges)
      : ob::StateValidityChecker(si), edges_(edges) {}

  bool isValid(const ob::State* state) const override {
    return (*edges_)->IsValidState({OmplPositions(state), si_->getStateDimension()});
  }

 private:
  EdgeChecker* const* edges_;
};

class EdgeMotionValidator final : public ob::MotionValidator {
 public:
  EdgeMotionValidator(const ob::SpaceInformationPtr& si, EdgeChecker* const* edges)
      : ob::MotionValidator(si), edges_(edges) {}

  /// OMPL's contract: s1 is known to be valid.
  bool checkMotion(const ob::State* s1, const ob::State* s2) const override {
    const std::size_t n = si_->getStateDimension();
    const bool valid = (*edges_)->IsValidEdge({OmplPositions(s1), n}, {OmplPositions(s2), n},
                                              /*from_is_free=*/true);
    ++(valid ? valid_ : invalid_);
    return valid;
  }
  /// The last valid state is at most an edge resolution before what is not.
  bool checkMotion(const ob::State* s1, const ob::State* s2,
                   std::pair<ob::State*, double>& last_valid) const override {
    const std::size_t n = si_->getStateDimension();
    const double part = (*edges_)->FindFreePart({OmplPositions(s1), n}, {OmplPositions(s2), n});
    ++(part == 1 ? valid_ : invalid_);
    if (part == 1) return true;
    if (last_valid.first != nullptr) {
      si_->getStateSpace()->interpolate(s1, s2, part, last_valid.first);
    }
    last_valid.second = part;
    return false;
  }

 private:
  EdgeChecker* const* edges_;
};

class GoalBoxRegion final : public ob::GoalSampleableRegion {
 public:
  /// `space` and `box` must outlive it.
  GoalBoxRegion(const ob::SpaceInformationPtr& si, const OmplJointSpace& space, const GoalBox& box,
                std::uint64_t seed)
      : ob::GoalSampleableRegion(si),
        space_(space),
        box_(box),
        sampler_(space.joints(), box, seed) {
    // What is sampled of a goal many turns away is off it by the rounding of the turns.
    setThreshold(GoalBox::kRounding);
  }

  double distanceGoal(const ob::State* state) const override {
    const JointSpace& joints = space_.joints();
    double sum = 0;
    for (int j = 0; j < joints.size(); ++j) {
      const auto k = static_cast<std::size_t>(j);
      const double nominal = box_.nominal[k];
      const double offset = joints.Difference(j, nominal, OmplPositions(state)[k]);
      const double inside = std::clamp(offset, box_.lower[k] - nominal, box_.upper[k] - nominal);
      sum += (offset - inside) * (offset - inside);
    }
    return std::sqrt(sum);
  }
  void sampleGoal(ob::State* state) const override {
    space_.SetPositions(state, sampler_.Sample());
  }
  unsigned int maxSampleCount() const override {
    return static_cast<unsigned int>(sampler_.max_samples());
  }

 private:
  const OmplJointSpace& space_;
  const GoalBox& box_;
  mutable GoalSampler sampler_;
};

}  // namespace

/// OMPL's objects for one joint space.
class OmplPlanner::Workspace {
 public:
  Workspace(const JointSpace& joints, Metric metric)
      : space_(std::make_shared<OmplJointSpace>(joints, metric)),
        si_(std::make_shared<ob::SpaceInformation>(space_)) {
    si_->setStateValidityChecker(std::make_shared<EdgeStateValidity>(si_, &edges_));
    si_->setMotionValidator(std::make_shared<EdgeMotionValidator>(si_, &edges_));
    si_->setup();
  }

  SearchResult Search(const RrtcSettings& settings, SearchQuery& query) {
    edges_ = &query.edges();
    space_->SeedSamplers(settings.sampler, query.seed());
    {
      // What the planners' own generators are seeded from. OMPL finds fault with setting it more
      // than once a process, because generators that exist keep their seeds; here none does.
      const OmplSilence silence;
      ompl::RNG::setSeed(OmplSeed(query.seed()));
    }
    const ob::ProblemDefinitionPtr problem = MakeProblem(query);
    const ob::OptimizationObjectivePtr& objective = problem->getOptimizationObjective();
    objective->setCostThreshold(query.anytime() ? ob::Cost(0) : objective->infiniteCost());
    double best = std::numeric_limits<double>::infinity();
    problem->setIntermediateSolutionCallback(
        [&](const ob::Planner*, const std::vector<const ob::State*>&, const ob::Cost cost) {
          if (!(cost.value() < best)) return;
          best = cost.value();
          query.ReportSolution(/*lower_bound=*/0, best, space_->num_samples());
        });
    const ob::PlannerPtr planner = MakePlanner(settings, "settings", problem);
    const ob::PlannerStatus status = Solve(settings, query, planner.get());

    SearchResult result;
    if (problem->hasExactSolution()) {
      result.status = PlanStatus::kSolved;
      result.path = PathOf(*problem);
      if (settings.ompl_algorithm->anytime) {
        result.cost = problem->getSolutionPath()->length();
        if (result.cost < best) {
          query.ReportSolution(/*lower_bound=*/0, result.cost, space_->num_samples());
        }
      }
    } else {
      const bool gave_up = !query.ShouldStop();
      result = StoppedSearch(query);
      if (gave_up) {
        result.message = fmt::format("{} gave up: {}", settings.AlgorithmName(), status.asString());
      }
    }
    result.remains = planner;
    result.guidance_ticks = *space_->neighbor_ticks();
    result.counters = {{"iterations", static_cast<double>(space_->num_samples())}};
    return result;
  }

  double Extent() const { return space_->getMaximumExtent(); }
  /// Without a start and a goal.
  ob::ProblemDefinitionPtr EmptyProblem() const {
    auto problem = std::make_shared<ob::ProblemDefinition>(si_);
    problem->setOptimizationObjective(std::make_shared<PathLengthObjective>(si_));
    return problem;
  }

  /// Whether the planner limits motions as the setting `range` says. Where a roadmap has a
  /// parameter of this name, it limits how far neighbours may be apart, which is another matter.
  static bool HasRange(const OmplAlgorithm& algorithm, ob::Planner& planner) {
    return algorithm.planner_class != PlannerClass::kSampleThenSearch &&
           planner.params().hasParam("range");
  }

  /// OMPL's planner with the settings' range and parameters, set up for the problem. Throws
  /// InputError, prefixed by `origin`, for parameters that it refuses.
  ob::PlannerPtr MakePlanner(const RrtcSettings& settings, const std::string& origin,
                             const ob::ProblemDefinitionPtr& problem) const {
    // What it refuses it throws; its warnings are of names that it gives itself, and of being set
    // up twice.
    const OmplSilence silence;
    ob::PlannerPtr planner = settings.ompl_algorithm->make(si_);
    ob::ParamSet& parameters = planner->params();
    if (settings.range && HasRange(*settings.ompl_algorithm, *planner)) {
      parameters.setParam("range", fmt::format("{}", *settings.range));
    }
    for (const auto& [key, value] : settings.ompl_parameters) {
      if (key == "range" && HasRange(*settings.ompl_algorithm, *planner)) {
        throw InputError(origin + ": ompl.range: is the setting 'range'");
      }
      if (!parameters.hasParam(key)) {
        std::vector<std::string> known;
        parameters.getParamNames(known);
        throw InputError(fmt::format("{}: ompl.{}: {} has no such parameter; it has {}", origin,
                                     key, settings.AlgorithmName(), fmt::join(known, ", ")));
      }
      if (const std::string why = WhyRefused(*parameters.getParam(key), value); !why.empty()) {
        throw InputError(fmt::format("{}: ompl.{}: {}", origin, key, why));
      }
      if (!SetParameter(&parameters, key, value)) {
        throw InputError(
            fmt::format("{}: ompl.{}: '{}' is no value of this parameter", origin, key, value));
      }
    }
    const auto is = [&parameters](const char* key, const char* wanted) {
      std::string value;
      return parameters.getParam(key, value) && value == wanted;
    };
    if (is("ordered_sampling", "1") && is("informed_sampling", "0") &&
        is("sample_rejection", "0")) {  // OMPL would crash.
      throw InputError(origin +
                       ": ompl.ordered_sampling: orders what informed_sampling or "
                       "sample_rejection draws: set one of them, too");
    }
    planner->setProblemDefinition(problem);
    try {
      planner->setup();
    } catch (const ompl::Exception& error) {  // Some parameters are looked at here only.
      throw InputError(fmt::format("{}: {} cannot be set up: {}", origin, settings.AlgorithmName(),
                                   error.what()));
    }
    return planner;
  }

 private:
  /// Throws InputError if OMPL gives up with an exception of its own: some settings it looks at
  /// only here.
  static ob::PlannerStatus Solve(const RrtcSettings& settings, const SearchQuery& query,
                                 ob::Planner* planner) {
    try {
      return planner->solve(
          ob::PlannerTerminationCondition([&query] { return query.ShouldStop(); }));
    } catch (const ompl::Exception& error) {
      throw InputError(fmt::format("{} refused the request within its search: {}",
                                   settings.AlgorithmName(), error.what()));
    }
  }

  ob::ProblemDefinitionPtr MakeProblem(const SearchQuery& query) const {
    const ob::ProblemDefinitionPtr problem = EmptyProblem();
    ob::State* start = space_->allocState();
    space_->SetPositions(start, query.start());
    problem->addStartState(start);
    space_->freeState(start);
    // Another seed than the sampler's, lest goals and samples be the same numbers.
    problem->setGoal(std::make_shared<GoalBoxRegion>(si_, *space_, query.goal(), ~query.seed()));
    return problem;
  }

  Path PathOf(const ob::ProblemDefinition& problem) const {
    Path path;
    for (const ob::State* state : problem.getSolutionPath()->as<og::PathGeometric>()->getStates()) {
      const double* q = OmplPositions(state);
      path.emplace_back(q, q + space_->getDimension());
    }
    return path;
  }

  std::shared_ptr<OmplJointSpace> space_;
  ob::SpaceInformationPtr si_;
  EdgeChecker* edges_ = nullptr;  ///< Of the query being served.
};

OmplPlanner::OmplPlanner(const Robot& robot, RrtcSettings settings, const std::string& origin)
    : Planner(robot), settings_(std::move(settings)) {
  RedirectOmplMessages();
  for (const PlanningGroup& group : robot.groups) {
    workspaces_[&group.space] = std::make_unique<Workspace>(group.space, settings_.metric);
  }
  // Refuses bad parameters now rather than at the first request.
  const Workspace& workspace = *workspaces_.begin()->second;
  const ob::PlannerPtr planner = workspace.MakePlanner(settings_, origin, workspace.EmptyProblem());
  has_range_ = Workspace::HasRange(*settings_.ompl_algorithm, *planner);
}

OmplPlanner::~OmplPlanner() = default;

PlannerDescription OmplPlanner::Describe() const {
  PlannerDescription description;
  description.algorithm = settings_.VariantName();
  description.planner_class = settings_.ompl_algorithm->planner_class;
  description.anytime = settings_.ompl_algorithm->anytime;
  description.bidirectional = settings_.ompl_algorithm->bidirectional;
  description.collision_models = EnumValues<CollisionModel>();
  description.settings = DescribeSettings(settings_);
  if (!has_range_) description.settings.erase("range");
  return description;
}

std::optional<EdgeSampling> OmplPlanner::OwnEdgeSampling(const PlanningGroup& group,
                                                         EdgeCheck method,
                                                         double /*resolution_m*/) const {
  const std::optional<double> fraction = settings_.longest_valid_segment_fraction;
  if (!fraction) return std::nullopt;
  if (method != EdgeCheck::kFixed) {
    throw InputError(
        fmt::format("{}: samples edges, which are to be certified here: ask for edge_check fixed, "
                    "or leave the setting out",
                    settings_.segment_fraction_origin));
  }
  EdgeSampling sampling;
  sampling.weights.assign(static_cast<std::size_t>(group.space.size()), 1.0);
  sampling.step = *fraction * workspaces_.at(&group.space)->Extent();
  sampling.euclidean = settings_.metric == Metric::kL2;
  return sampling;
}

SearchResult OmplPlanner::Search(SearchQuery& query) {
  return workspaces_.at(&query.space())
      ->Search(SettingsOfRequest(settings_, query.parameters()), query);
}

}  // namespace planbench
