#include "results/training.h"

#include "planning/path_library.h"

namespace planbench {

std::string LearnedFrom(const std::map<std::string, std::string>& settings) {
  std::string sets;
  for (const char* key : {kLearnedFrom, kFirstPathLearnedFrom}) {
    const auto found = settings.find(key);
    if (found == settings.end() || found->second.empty()) continue;
    sets += (sets.empty() ? "" : ", ") + found->second;
  }
  return sets;
}

bool IsTrainedOn(const std::string& learned_from, const std::string& problem_set) {
  return (", " + learned_from + ", ").find(", " + problem_set + ", ") != std::string::npos;
}

}  // namespace planbench
