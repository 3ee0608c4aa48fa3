#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace planbench {

/// Incremental 128-bit content hash (XXH3) of values in a fixed, platform-independent layout:
/// integers and doubles little-endian, strings and lists preceded by their length, -0.0 hashed as
/// 0.0.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void Add(std::string_view text);
  void Add(const char* text) { Add(std::string_view(text)); }
  void Add(double value);
  void Add(std::int64_t value);
  void Add(int value) { Add(static_cast<std::int64_t>(value)); }
  void Add(bool value) { Add(static_cast<std::int64_t>(value)); }
  void Add(std::size_t value) { Add(static_cast<std::int64_t>(value)); }
  void Add(std::span<const double> values);

  /// 32 lower-case hexadecimal digits.
  std::string HexDigest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace planbench
