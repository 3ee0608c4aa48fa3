#include "report/compared_pairs.h"

#include <cstddef>
#include <map>

namespace planbench {

std::vector<ComparedPair> ComparePairs(const ComparedSessions& compared) {
  std::vector<ComparedPair> pairs;
  const auto compare_all = [&](const std::string& set,
                               const std::map<std::string, Outcomes>& by_contestant) {
    const std::size_t num_before = pairs.size();
    std::vector<PairedComparison> of_set;
    const auto& contestants = compared.contestants();
    for (std::size_t a = 0; a < contestants.size(); ++a) {
      for (std::size_t b = a + 1; b < contestants.size(); ++b) {
        const auto first = by_contestant.find(contestants[a].name);
        const auto second = by_contestant.find(contestants[b].name);
        if (first == by_contestant.end() || second == by_contestant.end()) continue;
        of_set.push_back(Compare(first->second, second->second));
        if (of_set.back().num_problems == 0) {
          of_set.pop_back();
          continue;
        }
        pairs.push_back({set, first->first, second->first, of_set.back()});
      }
    }
    const std::vector<double> adjusted = AdjustedPValues(of_set);
    for (std::size_t i = 0; i < adjusted.size(); ++i) {
      pairs[num_before + i].adjusted_p = adjusted[i];
    }
  };
  for (const auto& [set, by_contestant] : compared.outcomes()) compare_all(set, by_contestant);
  if (compared.outcomes().size() > 1) compare_all(kAllSets, compared.pooled());
  return pairs;
}

}  // namespace planbench
