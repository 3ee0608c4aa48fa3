#pragma once

#include <stdexcept>
#include <string>

#include "common/text.h"

namespace planbench {

/// Bad input or bad use: a file, a flag, a message or a setting that cannot be accepted. The
/// message is one line that names where (file, line, field or channel) and what to change; what it
/// quotes may be anything (see Printable). Programs print it and exit with 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(Printable(message)) {}
};

}  // namespace planbench
