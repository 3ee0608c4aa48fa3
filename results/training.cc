#include "results/training.h"

#include <sstream>

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

std::string LearnedFrom(const std::string& settings) {
  const std::string between = " = ";
  std::map<std::string, std::string> by_key;
  std::istringstream lines(settings);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find(between);
    if (end != std::string::npos) by_key[line.substr(0, end)] = line.substr(end + between.size());
  }
  return LearnedFrom(by_key);
}

bool IsTrainedOn(const std::string& learned_from, const std::string& problem_set) {
  return (", " + learned_from + ", ").find(", " + problem_set + ", ") != std::string::npos;
}

}  // namespace planbench
