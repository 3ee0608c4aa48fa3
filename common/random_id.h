#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <random>
#include <string>

namespace planbench {

/// 64 random bits from the operating system as 16 hexadecimal digits: no two processes or requests
/// have the same, and nobody can tell the next one.
inline std::string RandomId() {
  std::random_device random;
  const auto high = static_cast<std::uint64_t>(random()) << 32U;
  return fmt::format("{:016x}", high | (random() & 0xffffffffU));
}

/// An id that nobody can tell before it is used, so that no answer can be prepared for it; also, a
/// planner or scene server that outlives a driver remembers the answers of attempts that are over.
inline std::string UniqueId(const std::string& what) { return what + "@" + RandomId(); }

}  // namespace planbench
