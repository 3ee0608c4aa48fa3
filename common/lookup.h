#pragma once

#include <optional>

namespace planbench {

/// What a map holds by a key, if anything.
template <typename Map>
std::optional<typename Map::mapped_type> Lookup(const Map& map, const typename Map::key_type& key) {
  const auto found = map.find(key);
  return found == map.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace planbench
