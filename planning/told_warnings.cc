#include "planning/told_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace planbench {
namespace {

constexpr std::size_t kMostTold = 40;
constexpr char kMore[] = "there are more warnings; see the scene server's log";

}  // namespace

void TellWarnings(const std::string& kind, const std::vector<std::string>& warnings,
                  std::map<std::string, std::string>* settings) {
  std::vector<std::string> told = ToldWarnings(kind, *settings);
  for (const std::string& warning : warnings) {
    if (std::ranges::find(told, warning) == told.end()) told.push_back(warning);
  }
  if (told.size() > kMostTold) {
    told.resize(kMostTold);
    told.emplace_back(kMore);
  }
  for (std::size_t i = 0; i < told.size(); ++i) {
    (*settings)[fmt::format("{} {:02}", kind, i + 1)] = told[i];
  }
}

std::vector<std::string> ToldWarnings(const std::string& kind,
                                      const std::map<std::string, std::string>& settings) {
  std::vector<std::string> told;
  for (const auto& [key, value] : settings) {
    if (key.starts_with(kind + " ")) told.push_back(value);
  }
  return told;
}

}  // namespace planbench
