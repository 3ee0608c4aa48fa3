#pragma once

#include <cstdio>
#include <functional>
#include <string>

#include "common/standard_output.h"

namespace planbench {

/// Takes a line for the user, when it is known: what follows may take minutes.
using SayLine = std::function<void(const std::string&)>;

/// To standard output, at once.
inline void PrintLine(const std::string& line) {
  WriteOut(line + "\n");
  std::fflush(stdout);
}

}  // namespace planbench
