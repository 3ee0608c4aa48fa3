#include "report/wording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace planbench {
namespace {

constexpr std::size_t kMostNamed = 4;

}  // namespace

std::string Count(int count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string Named(const std::vector<std::string>& names) {
  const std::size_t num_named = std::min(names.size(), kMostNamed);
  return fmt::format(
      "{}{}",
      fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(num_named), ", "),
      names.size() > num_named ? fmt::format(" and {} more", names.size() - num_named) : "");
}

std::string Enumerated(std::vector<std::string> names) {
  if (names.size() < 2 || names.size() > kMostNamed + 1) return Named(names);
  const std::string last = std::move(names.back());
  names.pop_back();
  return Named(names) + " and " + last;
}

}  // namespace planbench
