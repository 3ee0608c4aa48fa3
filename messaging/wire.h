#pragma once

#include <lcm/lcm_coretypes.h>

#include <cstdint>
#include <limits>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/text.h"
#include "messaging/codec.h"

/// Between lcmt_ structs and bytes.
namespace planbench::wire {

/// Bytes of an lcmt_ struct, its type's fingerprint first.
template <typename Wire>
std::vector<std::uint8_t> Pack(const Wire& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int size = message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  if (size < 0) throw std::logic_error(std::string(Wire::getTypeName()) + ": cannot be encoded");
  bytes.resize(static_cast<std::size_t>(size));  // Text ends at its first NUL on the wire.
  return bytes;
}

/// The request_id of an lcmt_ struct, of a session its run_id, printable; "" if it has none.
template <typename Wire>
std::string RequestIdOf(const Wire& message) {
  if constexpr (requires { message.request_id; }) {
    return Escaped(message.request_id);
  } else if constexpr (requires { message.run_id; }) {
    return Escaped(message.run_id);
  } else {
    return "";
  }
}

/// The lcmt_ struct in `bytes`; throws MessageError for another type, truncation, excess. The
/// error has the request_id if that could still be read.
template <typename Wire>
Wire Unpack(std::span<const std::uint8_t> bytes, const std::string& channel) {
  const std::string type = Wire::getTypeName();
  Wire message{};
  const auto fail = [&](const std::string& what) {
    throw MessageError(channel + ": " + what, RequestIdOf(message));
  };
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    fail("too large for a " + type);
  }
  const int size = static_cast<int>(bytes.size());
  std::int64_t fingerprint = 0;
  if (__int64_t_decode_array(bytes.data(), 0, size, &fingerprint, 1) < 0) {
    fail("too short for a " + type);
  }
  if (fingerprint != Wire::getHash()) fail("not a " + type + " of this version");
  int used = -1;
  try {
    used = message.decode(bytes.data(), 0, size);
  } catch (const std::length_error&) {  // A count that no memory could hold.
  } catch (const std::bad_alloc&) {
  }
  if (used < 0) {
    fail("truncated or damaged " + type +
         ": a count (num_...) or the length of a text does not match what follows, or rows hold 0 "
         "numbers");
  }
  if (used != size) fail(std::to_string(size - used) + " bytes after the end of the " + type);
  return message;
}

}  // namespace planbench::wire
