#pragma once

#include <cstddef>

namespace planbench {

/// Element of a container by an index of any integer type.
template <typename Container, typename Index>
auto& At(Container& container, Index index) {
  return container[static_cast<std::size_t>(index)];
}

}  // namespace planbench
