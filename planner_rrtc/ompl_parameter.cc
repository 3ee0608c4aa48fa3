#include "planner_rrtc/ompl_parameter.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

namespace planbench {
namespace {

struct Bounds {
  double least = -std::numeric_limits<double>::infinity();
  // The most that OMPL suggests for any. Far beyond, its arithmetic overflows.
  double most = 1e6;
  bool integers = false;
};

/// Of the trees that OMPL sorts neighbours into. A node of degree k is split over a matrix of more
/// than k by k distances.
constexpr double kMostDegree = 1000;

/// Of samples that are drawn without a look at the clock: of a million no answer came within 30 s.
constexpr double kMostBatch = 1e5;

std::optional<double> FiniteNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// OMPL suggests "first:last" or "first:step:last", which is where to look for good values, not
/// where others have no meaning: only its signs and shares are taken for limits. Without a point it
/// means integers. OMPL counts and divides by those without a check: at 0 it may crash.
Bounds BoundsOf(const std::string& name, const std::string& suggestion) {
  Bounds bounds;
  const std::optional<double> first = FiniteNumber(suggestion.substr(0, suggestion.find(':')));
  const std::optional<double> last = FiniteNumber(suggestion.substr(suggestion.rfind(':') + 1));
  if (first && last && *first < *last) {
    bounds.integers = suggestion.find('.') == std::string::npos;
    if (*first >= 0) bounds.least = 0;
    if (*first >= 0 && *last == 1) bounds.most = 1;
    if (bounds.integers) bounds = {std::min(*first, 1.0), Bounds().most, true};
    if (name.find("batch") != std::string::npos) bounds.most = kMostBatch;
    // With a degree of 1 the trees have no branches.
    if (name.find("degree") != std::string::npos) bounds = {*first, kMostDegree, true};
  }
  if (name == "range") bounds.least = 0;
  for (const char* share : {"bias", "fraction", "probability"}) {
    if (name.find(share) != std::string::npos) bounds = {0, 1, false};
  }
  return bounds;
}

}  // namespace

std::string WhyRefused(const ompl::base::GenericParam& parameter, const std::string& value) {
  const std::string& suggestion = parameter.getRangeSuggestion();
  if (suggestion == "0,1") {  // OMPL takes all other words for true.
    const std::vector<std::string_view> words = {"0", "1", "false", "true"};
    const bool known = std::find(words.begin(), words.end(), value) != words.end();
    return known ? "" : fmt::format("'{}' is neither 0 (false) nor 1 (true)", value);
  }
  const std::optional<double> number = FiniteNumber(value);
  if (!number) return fmt::format("'{}' is no finite number", value);
  const Bounds bounds = BoundsOf(parameter.getName(), suggestion);
  if (bounds.integers && *number != std::round(*number)) {
    return fmt::format("{} is no whole number", value);
  }
  if (*number < bounds.least || *number > bounds.most) {
    return std::isfinite(bounds.least)
               ? fmt::format("{} is not from {} to {}", value, bounds.least, bounds.most)
               : fmt::format("{} is more than {}", value, bounds.most);
  }
  return "";
}

}  // namespace planbench
