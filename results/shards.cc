#include "results/shards.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "results/reproduce.h"

namespace planbench {
namespace {

constexpr char kBetweenShards[] = ", ";

}  // namespace

std::set<std::string> ParseShards(const std::string& text) {
  std::set<std::string> shards;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find(kBetweenShards, from), text.size());
    if (to > from) shards.insert(text.substr(from, to - from));
    from = to + std::size(kBetweenShards) - 1;
  }
  return shards;
}

std::string JoinShards(const std::set<std::string>& shards) {
  return fmt::format("{}", fmt::join(shards, kBetweenShards));
}

std::set<std::string> ShardsOf(const std::map<std::string, std::string>& flags) {
  const auto found = flags.find(kShardFlag);
  return found == flags.end() ? std::set<std::string>() : ParseShards(found->second);
}

std::set<std::string> MissingShards(const std::set<std::string>& shards) {
  std::set<int> counts;
  for (const std::string& shard : shards) {
    const std::size_t slash = shard.find('/');
    if (slash != std::string::npos) counts.insert(std::atoi(shard.c_str() + slash + 1));
  }
  std::set<std::string> missing;
  for (const int count : counts) {
    for (int i = 1; i <= count; ++i) {
      std::string shard = fmt::format("{}/{}", i, count);
      if (!shards.contains(shard)) missing.insert(std::move(shard));
    }
  }
  return missing;
}

std::set<std::string> AwaitedShards(const std::map<std::string, std::string>& flags) {
  const std::set<std::string> shards = ShardsOf(flags);
  if (shards.size() < 2 && !flags.contains(kMergedParts)) return {};
  return MissingShards(shards);
}

}  // namespace planbench
