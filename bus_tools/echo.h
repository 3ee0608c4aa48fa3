#pragma once

#include <cstddef>
#include <string>

#include "messaging/packet_reader.h"

namespace planbench {

/// How messages are shown.
struct EchoFormat {
  bool fields = true;                 ///< Else the first line alone.
  std::size_t max_lines = 40;         ///< Of fields; what is left out is counted. 0: all.
  std::size_t max_line_length = 160;  ///< Characters; longer lines end in "...". 0: whole.
};

/// A message as lines: time of receipt (UTC), channel, type and size, then its fields, indented. A
/// message that no type of this version fits, or that is damaged, is said to be.
std::string EchoText(const ReceivedMessage& message, const EchoFormat& format);

}  // namespace planbench
