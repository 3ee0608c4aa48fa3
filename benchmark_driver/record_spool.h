#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace planbench {

/// Run records as they are sent, kept for loggers that do not have them yet: the first ones in
/// memory, from kMemoryBytes on in a temporary file. Takes a few bytes of memory a record beyond.
class RecordSpool {
 public:
  static constexpr std::size_t kMemoryBytes = std::size_t{8} << 20;

  struct Record {
    std::string id;
    std::vector<std::uint8_t> bytes;
  };

  explicit RecordSpool(std::size_t memory_bytes = kMemoryBytes) : memory_bytes_(memory_bytes) {}

  std::size_t size() const { return places_.size(); }
  /// Throws std::runtime_error if the file cannot be written.
  void Add(const Record& record);
  /// Throws std::runtime_error if the file cannot be read.
  Record At(std::size_t index);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  struct Place {
    std::int64_t offset = 0;  ///< In memory, and after its end in the file.
    std::uint32_t id_bytes = 0;
    std::uint32_t bytes = 0;
  };
  [[noreturn]] static void Fail(const char* what);

  const std::size_t memory_bytes_;
  std::vector<Place> places_;
  std::string memory_;
  std::unique_ptr<std::FILE, Close> file_;
  std::int64_t file_bytes_ = 0;
};

}  // namespace planbench
