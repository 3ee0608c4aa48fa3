#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <functional>
#include <string>

namespace planbench {

/// Takes a line for the user, when it is known: what follows may take minutes.
using SayLine = std::function<void(const std::string&)>;

/// To standard output, at once.
inline void PrintLine(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

}  // namespace planbench
