#include "benchmark_driver/published_study.h"

#include <array>

namespace planbench {

std::span<const PublishedFigures> PublishedStudy() {
  static constexpr char kAra[] = "ARA*";
  static constexpr char kRrtConnect[] = "RRT-Connect";
  static constexpr std::array<PublishedFigures, 6> kStudy = {{
      {"shelf_zero_test", kAra, 100, 47, 53, 0, 0, 0.085, 0.085},
      {"shelf_zero_test", kRrtConnect, 100, 85, std::nullopt, 15, std::nullopt, 15, 16},
      {"shelf_height_test", kAra, 100, 47, 52, 0, 1, 0.09, 0.09},
      {"shelf_height_test", kRrtConnect, 100, 82, std::nullopt, 18, std::nullopt, 15, 16},
      {"shelf_height_rot_test", kAra, 100, 43, 43, 6, 8, 0.17, 0.17},
      {"shelf_height_rot_test", kRrtConnect, 100, 76, std::nullopt, 24, std::nullopt, 15, 16},
  }};
  return kStudy;
}

const PublishedFigures* FindPublished(std::string_view problem_set, std::string_view algorithm) {
  for (const PublishedFigures& figures : PublishedStudy()) {
    if (figures.problem_set == problem_set && figures.algorithm == algorithm) return &figures;
  }
  return nullptr;
}

}  // namespace planbench
