#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace planbench {

/// The bytes of a file from any place on; those around the last place are kept in memory. Not
/// thread-safe.
class FileBytes {
 public:
  /// Throws InputError if it cannot be opened, or is a pipe, say, which is read but once. Reads
  /// `at_once` bytes together, or those that are asked for if they are more.
  explicit FileBytes(std::filesystem::path file, std::size_t at_once = std::size_t{1} << 16);
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  /// At least `count` bytes from `offset` on, or as many as there are; valid until the next call.
  /// Throws InputError if the file cannot be read.
  std::span<const std::uint8_t> From(std::uint64_t offset, std::size_t count);
  /// As many as that, neither more nor fewer; throws InputError if the file has been shortened,
  /// too.
  std::span<const std::uint8_t> Exactly(std::uint64_t offset, std::size_t count);
  /// Copies as many as there are from `offset` on, and leaves in memory what From brought there.
  /// Throws like it.
  void Copy(std::uint64_t offset, std::span<std::uint8_t> bytes) const;
  /// Whether the file has so many bytes by now: somebody may write it.
  bool HasGrownTo(std::uint64_t size);

 private:
  std::span<const std::uint8_t> InMemory(std::uint64_t offset) const;
  std::size_t Read(std::uint64_t offset, std::span<std::uint8_t> bytes) const;

  std::filesystem::path file_;
  std::size_t at_once_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;           ///< When it was last looked at.
  std::uint64_t begin_ = 0;          ///< Of what is in memory.
  std::vector<std::uint8_t> bytes_;  ///< In memory.
};

}  // namespace planbench
