#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace planbench {

/// Run records as they are sent, kept for loggers that do not have them yet: the first ones in
/// memory, from kMemoryBytes on in an unlinked file in `folder`, which takes a few bytes of memory
/// a record. Where that cannot be written they stay in memory, as a warning says once.
class RecordSpool {
 public:
  static constexpr std::size_t kMemoryBytes = std::size_t{8} << 20;

  struct Record {
    std::string id;
    std::vector<std::uint8_t> bytes;
  };

  explicit RecordSpool(std::filesystem::path folder, std::size_t memory_bytes = kMemoryBytes)
      : folder_(std::move(folder)), memory_left_(memory_bytes) {}

  std::size_t size() const { return places_.size(); }
  void Add(const Record& record);
  /// Throws std::runtime_error if the file cannot be read.
  Record At(std::size_t index);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  struct Place {  ///< In the file.
    std::int64_t offset = 0;
    std::uint32_t id_bytes = 0;
    std::uint32_t bytes = 0;
  };
  /// False, with errno, if the file cannot be made or written; what it holds can be read still.
  bool Write(const std::string& text);

  const std::filesystem::path folder_;
  std::size_t memory_left_;  ///< Bytes that records may take before there is a file.
  std::vector<Place> places_;
  std::map<std::size_t, Record> in_memory_;
  std::unique_ptr<std::FILE, Close> file_;
  std::int64_t file_bytes_ = 0;
  bool to_file_ = false;  ///< Whatever comes, from the first on that found no room in memory.
};

}  // namespace planbench
