#include "common/content_hash.h"

#include <xxhash.h>

#include <bit>
#include <cstdio>

namespace planbench {

struct ContentHash::State {
  XXH3_state_t* xxh = XXH3_createState();
  ~State() { XXH3_freeState(xxh); }
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) { XXH3_128bits_reset(state_->xxh); }

ContentHash::~ContentHash() = default;

void ContentHash::Add(std::string_view text) {
  Add(text.size());
  XXH3_128bits_update(state_->xxh, text.data(), text.size());
}

void ContentHash::Add(std::int64_t value) {
  unsigned char bytes[8];
  auto bits = static_cast<std::uint64_t>(value);
  for (unsigned char& byte : bytes) {
    byte = static_cast<unsigned char>(bits & 0xff);
    bits >>= 8;
  }
  XXH3_128bits_update(state_->xxh, bytes, sizeof(bytes));
}

void ContentHash::Add(double value) {
  // -0.0 and 0.0 compare equal, so they must hash equal.
  Add(std::bit_cast<std::int64_t>(value == 0.0 ? 0.0 : value));
}

void ContentHash::Add(std::span<const double> values) {
  Add(values.size());
  for (const double value : values) Add(value);
}

std::string ContentHash::HexDigest() const {
  const XXH128_hash_t digest = XXH3_128bits_digest(state_->xxh);
  char text[33];
  std::snprintf(text, sizeof(text), "%016llx%016llx",
                static_cast<unsigned long long>(digest.high64),
                static_cast<unsigned long long>(digest.low64));
  return text;
}

}  // namespace planbench
