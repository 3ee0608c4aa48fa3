#include "planner_rrtc/ompl_algorithms.h"

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/geometric/planners/est/BiEST.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/est/ProjEST.h>
#include <ompl/geometric/planners/informedtrees/ABITstar.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/BKPIECE1.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/kpiece/LBKPIECE1.h>
#include <ompl/geometric/planners/pdst/PDST.h>
#include <ompl/geometric/planners/prm/LazyPRM.h>
#include <ompl/geometric/planners/prm/LazyPRMstar.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/BiTRRT.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTXstatic.h>
#include <ompl/geometric/planners/rrt/RRTsharp.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/geometric/planners/rrt/TRRT.h>
#include <ompl/geometric/planners/sbl/SBL.h>
#include <ompl/geometric/planners/stride/STRIDE.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "planner_rrtc/scan_neighbors.h"

namespace planbench {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

template <typename Algorithm>
ob::PlannerPtr Make(const ob::SpaceInformationPtr& si) {
  return std::make_shared<Algorithm>(si);
}

/// One that asks for the nearest state alone, of all it has.
template <typename Algorithm>
ob::PlannerPtr MakeScanning(const ob::SpaceInformationPtr& si) {
  auto planner = std::make_shared<Algorithm>(si);
  planner->template setNearestNeighbors<ScanNeighbors>();
  return planner;
}

/// A roadmap of OMPL's from the starts towards one sample of the goal; ends with its first path.
template <typename Roadmap>
class OneQueryRoadmap : public Roadmap {
 public:
  using Roadmap::Roadmap;

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& ptc) final {
    checkValidity();
    while (const ob::State* state = pis_.nextStart()) {
      startM_.push_back(addMilestone(si_->cloneState(state)));
    }
    if (startM_.empty()) return ob::PlannerStatus::INVALID_START;
    if (const ob::State* state = pis_.nextGoal(ptc)) {
      goalM_.push_back(addMilestone(si_->cloneState(state)));
    }
    if (goalM_.empty()) return ob::PlannerStatus::INVALID_GOAL;

    ob::State* sample = si_->allocState();
    const ob::PathPtr solution = FindPath(ptc, sample);
    si_->freeState(sample);
    if (!solution) return ob::PlannerStatus::TIMEOUT;
    pdef_->addSolutionPath(solution, /*approximate=*/false, /*difference=*/0, getName());
    return ob::PlannerStatus::EXACT_SOLUTION;
  }

 protected:
  /// Grows the roadmap until it has a path. `sample`: for its samples. Null if stopped.
  virtual ob::PathPtr FindPath(const ob::PlannerTerminationCondition& ptc, ob::State* sample) = 0;

  using Roadmap::addMilestone, Roadmap::checkValidity, Roadmap::getName, Roadmap::goalM_,
      Roadmap::pdef_, Roadmap::pis_, Roadmap::si_, Roadmap::startM_;
};

/// OMPL's PRM divides its time between growing and expanding by the clock and looks for solutions
/// in a second thread, so that no two runs are alike. The same roadmap, grown only, in one thread.
template <bool kStar>
class RepeatablePrm final : public OneQueryRoadmap<og::PRM> {
 public:
  explicit RepeatablePrm(const ob::SpaceInformationPtr& si) : OneQueryRoadmap(si, kStar) {}

 private:
  ob::PathPtr FindPath(const ob::PlannerTerminationCondition& ptc, ob::State* sample) override {
    if (!sampler_) sampler_ = si_->allocValidStateSampler();
    ob::PathPtr solution;
    while (!ptc && !maybeConstructSolution(startM_, goalM_, solution)) {
      if (sampler_->sample(sample)) addMilestone(si_->cloneState(sample));
    }
    return solution;
  }
};

/// OMPL's lazy roadmap, which asks for the time before each path that it tries, too. OMPL's own
/// does so between samples only, and tries path after path until one is free or none is left: once
/// the limit has come no edge is free (EdgeChecker::StopWhen), and a large roadmap takes long to
/// undo. Frees its states, too, which OMPL's own leaves behind when it is destroyed (1.5).
template <typename LazyRoadmap>
class PunctualRoadmap final : public OneQueryRoadmap<LazyRoadmap> {
 public:
  explicit PunctualRoadmap(const ob::SpaceInformationPtr& si) : OneQueryRoadmap<LazyRoadmap>(si) {}
  ~PunctualRoadmap() override { this->freeMemory(); }

 private:
  ob::PathPtr FindPath(const ob::PlannerTerminationCondition& ptc, ob::State* sample) override {
    ob::PathPtr solution;
    std::pair<std::size_t, std::size_t> ends;  // of a path, among starts and goals
    while (!solution && !ptc) {
      this->sampler_->sampleUniform(sample);
      this->addMilestone(this->si_->cloneState(sample));
      while (!solution && !ptc && this->solutionComponent(&ends) != -1) {
        solution = this->constructSolution(this->startM_[ends.first], this->goalM_[ends.second]);
      }
    }
    return solution;
  }
};

using enum PlannerClass;
constexpr bool kDrawsNear = true;
constexpr std::array kAlgorithms = {
    OmplAlgorithm{"ABITstar", kSearchAndSample, true, false, Make<og::ABITstar>},
    OmplAlgorithm{"BITstar", kSearchAndSample, true, false, Make<og::BITstar>},
    OmplAlgorithm{"BKPIECE1", kSamplingGuided, false, true, Make<og::BKPIECE1>, {}, kDrawsNear},
    OmplAlgorithm{"BiEST", kSamplingGuided, false, true, Make<og::BiEST>, {}, kDrawsNear},
    OmplAlgorithm{"BiTRRT", kSamplingGuided, false, true, MakeScanning<og::BiTRRT>},
    OmplAlgorithm{"EST", kSamplingGuided, false, false, Make<og::EST>, {}, kDrawsNear},
    OmplAlgorithm{"InformedRRTstar", kSamplingGuided, true, false, Make<og::InformedRRTstar>},
    OmplAlgorithm{"KPIECE1", kSamplingGuided, false, false, Make<og::KPIECE1>, {}, kDrawsNear},
    OmplAlgorithm{"LBKPIECE1", kSamplingGuided, false, true, Make<og::LBKPIECE1>, {}, kDrawsNear},
    OmplAlgorithm{"LazyPRM", kSampleThenSearch, false, true, Make<PunctualRoadmap<og::LazyPRM>>},
    OmplAlgorithm{"LazyPRMstar", kSampleThenSearch, false, true,
                  Make<PunctualRoadmap<og::LazyPRMstar>>},
    OmplAlgorithm{"PDST", kSamplingGuided, false, false, Make<og::PDST>},
    OmplAlgorithm{"PRM", kSampleThenSearch, false, true, Make<RepeatablePrm<false>>, "grown only"},
    OmplAlgorithm{"PRMstar", kSampleThenSearch, false, true, Make<RepeatablePrm<true>>,
                  "grown only"},
    OmplAlgorithm{"ProjEST", kSamplingGuided, false, false, Make<og::ProjEST>, {}, kDrawsNear},
    OmplAlgorithm{"RRT", kSamplingGuided, false, false, MakeScanning<og::RRT>},
    OmplAlgorithm{"RRTConnect", kSamplingGuided, false, true, MakeScanning<og::RRTConnect>},
    OmplAlgorithm{"RRTXstatic", kSamplingGuided, true, false, Make<og::RRTXstatic>},
    OmplAlgorithm{"RRTsharp", kSamplingGuided, true, false, Make<og::RRTsharp>},
    OmplAlgorithm{"RRTstar", kSamplingGuided, true, false, Make<og::RRTstar>},
    OmplAlgorithm{"SBL", kSamplingGuided, false, true, Make<og::SBL>, {}, kDrawsNear},
    OmplAlgorithm{"STRIDE", kSamplingGuided, false, false, Make<og::STRIDE>, {}, kDrawsNear},
    OmplAlgorithm{"TRRT", kSamplingGuided, false, false, Make<og::TRRT>},
};

}  // namespace

std::span<const OmplAlgorithm> OmplAlgorithms() { return kAlgorithms; }

const OmplAlgorithm* FindOmplAlgorithm(std::string_view name) {
  const auto* found =
      std::find_if(kAlgorithms.begin(), kAlgorithms.end(),
                   [&](const OmplAlgorithm& algorithm) { return algorithm.name == name; });
  return found == kAlgorithms.end() ? nullptr : found;
}

}  // namespace planbench
