#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <vector>

namespace planbench {

/// How a fresh problem set is certified.
struct CertifierOptions {
  std::filesystem::path driver;    ///< The program benchmark_driver; the others lie beside it.
  std::filesystem::path robot;     ///< Robot folder.
  std::filesystem::path sessions;  ///< An empty folder for the sessions of the rounds.
  double time_limit_s = 60;        ///< Of each attempt of each planner.
  int max_rounds = 5;              ///< Sets of replacements tried, the first set included.
};

/// What certifying a set came to.
struct Certification {
  int num_rounds = 0;
  std::map<int, int> replaced;  ///< Attempt that a problem was replaced with last, by index.
  std::vector<int> unsolved;    ///< Problems nobody solved in the last round; empty: certified.
};

/// Lets the live planners loose on the problems `indices` of the set in `folder`, both directions,
/// and has those that none of them solves (with a path that the referee finds valid) replaced by
/// `replace(indices, attempt)`, attempt counting from 1; then on the replacements, and so on until
/// every problem has been solved or the rounds are used up. Each round is one run of the driver in
/// a process of its own; what it says goes to stderr. Throws std::runtime_error if the driver fails
/// or has not tried every problem.
Certification CertifyProblemSet(
    const std::filesystem::path& folder, std::vector<int> indices, const CertifierOptions& options,
    const std::function<void(const std::vector<int>& indices, int attempt)>& replace);

}  // namespace planbench
