#include "planner_rrtc/rrtc_planner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/samplers/informed/RejectionInfSampler.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <limits>
#include <mutex>

#include "common/error.h"
#include "planner_rrtc/edge_validity.h"
#include "planner_rrtc/goal_box_region.h"
#include "planner_rrtc/ompl_joint_space.h"
#include "planner_rrtc/rrtc_settings.h"

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
  const OmplSilence silence;
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

}  // namespace

/// OMPL's objects for one joint space, and RRT-Connect's memory.
class RrtcPlanner::Workspace {
 public:
  explicit Workspace(const JointSpace& joints)
      : space_(std::make_shared<OmplJointSpace>(joints)),
        si_(std::make_shared<ob::SpaceInformation>(space_)),
        states_(std::make_shared<EdgeStateValidity>(si_)),
        motions_(std::make_shared<EdgeMotionValidator>(si_)) {
    si_->setStateValidityChecker(states_);
    si_->setMotionValidator(motions_);
    space_->setStateSamplerAllocator([this](const ob::StateSpace* space) {
      return std::make_shared<JointSampler>(space, space_->joints(), sampler_kind_, sampler_seed_++,
                                            &num_samples_);
    });
    si_->setup();
    rrt_connect_ = std::make_shared<RrtConnect>(si_, RrtConnect::Settings{});
  }

  SearchResult Search(const RrtcSettings& settings, SearchQuery& query) {
    states_->set_edges(&query.edges());
    motions_->set_edges(&query.edges());
    sampler_kind_ = settings.sampler;
    sampler_seed_ = query.seed();
    num_samples_ = 0;
    return settings.ompl_algorithm == nullptr ? SearchWithRrtConnect(settings, query)
                                              : SearchWithOmpl(settings, query);
  }

  /// OMPL's planner with the settings' range and parameters. Throws InputError, prefixed by
  /// `origin`, for parameters that it refuses.
  ob::PlannerPtr MakeOmplPlanner(const RrtcSettings& settings, const std::string& origin) const {
    ob::PlannerPtr planner = settings.ompl_algorithm->make(si_);
    ob::ParamSet& parameters = planner->params();
    // Where a roadmap has one, it limits how far neighbours may be apart, which is another matter.
    const bool is_roadmap =
        settings.ompl_algorithm->planner_class == PlannerClass::kSampleThenSearch;
    if (parameters.hasParam("range") && !is_roadmap) {
      parameters.setParam("range", fmt::format("{}", settings.rrt_connect.range));
    }
    for (const auto& [key, value] : settings.ompl_parameters) {
      if (!parameters.hasParam(key)) {
        std::vector<std::string> known;
        parameters.getParamNames(known);
        throw InputError(fmt::format("{}: ompl.{}: {} has no such parameter; it has {}", origin,
                                     key, settings.AlgorithmName(), fmt::join(known, ", ")));
      }
      if (!SetParameter(&parameters, key, value)) {
        throw InputError(
            fmt::format("{}: ompl.{}: '{}' is no value of this parameter", origin, key, value));
      }
    }
    return planner;
  }

 private:
  ob::ProblemDefinitionPtr MakeProblem(const SearchQuery& query) const {
    auto problem = std::make_shared<ob::ProblemDefinition>(si_);
    ob::State* start = space_->allocState();
    space_->SetPositions(start, query.start());
    problem->addStartState(start);
    space_->freeState(start);
    // Another seed than the sampler's, lest goals and samples be the same numbers.
    problem->setGoal(std::make_shared<GoalBoxRegion>(si_, *space_, query.goal(), ~query.seed()));
    return problem;
  }

  SearchResult SearchWithRrtConnect(const RrtcSettings& settings, SearchQuery& query) {
    const ob::ProblemDefinitionPtr problem = MakeProblem(query);
    RrtConnect& planner = *rrt_connect_;
    planner.clear();
    planner.set_settings(settings.rrt_connect);
    planner.setProblemDefinition(problem);
    if (!planner.isSetup()) planner.setup();
    planner.solve(ob::PlannerTerminationCondition([&query] { return query.ShouldStop(); }));

    SearchResult result = ResultOf(*problem, query);
    result.guidance_s = planner.counters().nearest_s;
    result.counters = {{"iterations", static_cast<double>(planner.counters().iterations)},
                       {"states_start_tree", planner.NumStates(0)},
                       {"states_goal_tree", planner.NumStates(1)}};
    if (settings.rrt_connect.domain_radius > 0) {
      result.counters["out_of_domain"] = static_cast<double>(planner.counters().out_of_domain);
    }
    return result;
  }

  SearchResult SearchWithOmpl(const RrtcSettings& settings, SearchQuery& query) {
    {
      // What the planners' own generators are seeded from. OMPL finds fault with setting it more
      // than once a process, because generators that exist keep their seeds; here none does.
      const OmplSilence silence;
      ompl::RNG::setSeed(OmplSeed(query.seed()));
    }
    const ob::ProblemDefinitionPtr problem = MakeProblem(query);
    const auto objective = std::make_shared<PathLengthObjective>(si_);
    objective->setCostThreshold(query.anytime() ? ob::Cost(0) : objective->infiniteCost());
    problem->setOptimizationObjective(objective);
    double best = std::numeric_limits<double>::infinity();
    problem->setIntermediateSolutionCallback(
        [&](const ob::Planner*, const std::vector<const ob::State*>&, const ob::Cost cost) {
          if (!query.anytime() || !(cost.value() < best)) return;
          best = cost.value();
          query.ReportSolution(/*epsilon=*/0, best, num_samples_);
        });
    const ob::PlannerPtr planner = MakeOmplPlanner(settings, "settings");
    planner->setProblemDefinition(problem);
    planner->setup();
    const ob::PlannerStatus status =
        planner->solve(ob::PlannerTerminationCondition([&query] { return query.ShouldStop(); }));

    SearchResult result = ResultOf(*problem, query);
    if (result.status == PlanStatus::kSolved && settings.ompl_algorithm->anytime) {
      result.cost = problem->getSolutionPath()->length();
      if (query.anytime() && result.cost < best) {
        query.ReportSolution(/*epsilon=*/0, result.cost, num_samples_);
      }
    } else if (result.status == PlanStatus::kTimedOut && !query.ShouldStop()) {
      result.message = fmt::format("{} gave up: {}", settings.AlgorithmName(), status.asString());
    }
    result.counters = {{"iterations", static_cast<double>(num_samples_)}};
    return result;
  }

  static SearchResult ResultOf(const ob::ProblemDefinition& problem, const SearchQuery& query) {
    SearchResult result;
    if (problem.hasExactSolution()) {
      result.status = PlanStatus::kSolved;
      const std::size_t n = query.start().size();
      const auto* path = problem.getSolutionPath()->as<og::PathGeometric>();
      for (std::size_t i = 0; i < path->getStateCount(); ++i) {
        const double* q = OmplPositions(path->getState(static_cast<unsigned int>(i)));
        result.path.emplace_back(q, q + n);
      }
    } else if (query.Cancelled()) {
      result.status = PlanStatus::kCancelled;
      result.message = "cancelled";
    } else {
      result.status = PlanStatus::kTimedOut;
      result.message = "no path was found within the time limit";
    }
    return result;
  }

  std::shared_ptr<OmplJointSpace> space_;
  ob::SpaceInformationPtr si_;
  std::shared_ptr<EdgeStateValidity> states_;
  std::shared_ptr<EdgeMotionValidator> motions_;
  std::shared_ptr<RrtConnect> rrt_connect_;
  // Of the request being served:
  SamplerKind sampler_kind_ = SamplerKind::kUniform;
  std::uint64_t sampler_seed_ = 0;
  std::int64_t num_samples_ = 0;
};

RrtcPlanner::RrtcPlanner(const Robot& robot, const YamlNode& settings)
    : Planner(robot),
      settings_(std::make_unique<RrtcSettings>(ReadRrtcSettings(settings, RrtcSettings{}))) {
  RedirectOmplMessages();
  for (const PlanningGroup& group : robot.groups) {
    workspaces_[&group.space] = std::make_unique<Workspace>(group.space);
  }
  if (settings_->ompl_algorithm != nullptr) {
    // Refuses bad parameters now rather than at the first request.
    workspaces_.begin()->second->MakeOmplPlanner(*settings_, settings.Where());
  } else if (!settings_->ompl_parameters.empty()) {
    settings.At("ompl").Fail("RRT-Connect has no parameters of OMPL's");
  }
}

RrtcPlanner::~RrtcPlanner() = default;

PlannerDescription RrtcPlanner::Describe() const {
  PlannerDescription description;
  description.algorithm = settings_->AlgorithmName();
  description.planner_class = settings_->ompl_algorithm != nullptr
                                  ? settings_->ompl_algorithm->planner_class
                                  : PlannerClass::kSamplingGuided;
  description.backward = true;
  description.anytime = settings_->ompl_algorithm != nullptr && settings_->ompl_algorithm->anytime;
  description.collision_models = EnumValues<CollisionModel>();
  description.settings = DescribeSettings(*settings_);
  return description;
}

SearchResult RrtcPlanner::Search(SearchQuery& query) {
  return workspaces_.at(&query.space())
      ->Search(SettingsOfRequest(*settings_, query.parameters()), query);
}

std::unique_ptr<Planner> MakeRrtcPlanner(const Robot& robot, const YamlNode& settings) {
  return std::make_unique<RrtcPlanner>(robot, settings);
}

}  // namespace planbench
