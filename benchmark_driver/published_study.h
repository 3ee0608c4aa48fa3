#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace planbench {

/// What the reference study (Sotirchos and Ajanović, arXiv 2406.09623) published of one planner on
/// one of its problem sets: 100 problems, 60 s a request, single thread, Xeon E5-6248R.
struct PublishedFigures {
  std::string_view problem_set;
  std::string_view algorithm;  ///< As planners describe themselves: "ARA*", "RRT-Connect".
  int num_problems = 0;
  int solved_forward = 0;
  std::optional<int> solved_backward;  ///< Where forward failed; nothing: not tried.
  int failed = 0;
  std::optional<int> unsolvable;  ///< Nothing: not told apart from the failed.
  /// Median time of the attempt that succeeded, s, read off a violin plot: between these two. A
  /// failed forward attempt before it is not in it.
  double median_from_s = 0;
  double median_to_s = 0;
};

/// Every row of the study's tables.
std::span<const PublishedFigures> PublishedStudy();

/// Figures of that set and algorithm; null if the study has none.
const PublishedFigures* FindPublished(std::string_view problem_set, std::string_view algorithm);

}  // namespace planbench
