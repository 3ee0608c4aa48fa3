#pragma once

#include <string>
#include <utility>

#include "common/error.h"

namespace planbench {

/// The argument "NAME=VALUE" of a flag, cut at its first '='; neither may be empty. Throws
/// InputError that names the flag and `form`, what its arguments look like.
inline std::pair<std::string, std::string> SplitNameValue(const std::string& argument,
                                                          const std::string& flag,
                                                          const std::string& form = "NAME=VALUE") {
  const std::size_t equals = argument.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == argument.size()) {
    throw InputError(flag + " '" + argument + "': expected " + form);
  }
  return {argument.substr(0, equals), argument.substr(equals + 1)};
}

}  // namespace planbench
