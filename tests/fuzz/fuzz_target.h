#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

namespace planbench {

using Bytes = std::vector<std::uint8_t>;

/// A reader of what strangers write.
struct FuzzTarget {
  std::string name;
  /// Reads the input. An InputError is an answer, anything else that is thrown a fault.
  std::function<void(std::span<const std::uint8_t> input)> read;
  std::vector<Bytes> seeds;  ///< Inputs that are right, or nearly so.
  int num_inputs = 0;        ///< That the test of every day tries.
};
inline void PrintTo(const FuzzTarget& target, std::ostream* out) { *out << target.name; }

/// All of them, each with its seeds and with what tests/fuzz/corpus/NAME/ holds: inputs that once
/// did harm. Some write into a folder that lives as long as the process.
const std::vector<FuzzTarget>& FuzzTargets();

}  // namespace planbench
