#include "benchmark_driver/planner_renewal.h"

namespace planbench {

PlannerRenewal::PlannerRenewal(std::optional<int> problems,
                               std::function<void(const std::string&)> start_anew)
    : problems_(problems), start_anew_(std::move(start_anew)) {}

void PlannerRenewal::Renew(const std::string& problem_set, int problem_index,
                           PlannerClient* planner) {
  if (!problems_) return;
  {
    const std::scoped_lock lock(mutex_);
    Asked& asked = asked_[planner->planner()];
    std::pair problem(problem_set, problem_index);
    if (asked.num_problems > 0 && asked.problem == problem) return;
    asked.problem = std::move(problem);
    if (asked.num_problems < *problems_) {
      ++asked.num_problems;
      return;
    }
    asked.num_problems = 1;
  }
  if (planner->ExpectAnother()) start_anew_(planner->planner());
}

}  // namespace planbench
