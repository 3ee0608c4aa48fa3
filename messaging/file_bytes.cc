#include "messaging/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "common/error.h"
#include "common/file_kind.h"

namespace planbench {

FileBytes::FileBytes(std::filesystem::path file, std::size_t at_once)
    : file_(std::move(file)), at_once_(at_once) {
  descriptor_ = open(file_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) {
    throw InputError(file_.string() + ": cannot be opened: " + std::strerror(errno));
  }
  if (IsFile(file_)) return;
  close(descriptor_);
  throw InputError(file_.string() + ": is a folder, a pipe or a device, not a file");
}

FileBytes::~FileBytes() { close(descriptor_); }

std::span<const std::uint8_t> FileBytes::From(std::uint64_t offset, std::size_t count) {
  if (InMemory(offset).size() < count) {
    bytes_.resize(std::max(count, at_once_));
    bytes_.resize(Read(offset, bytes_));
    begin_ = offset;
  }
  return InMemory(offset);
}

std::span<const std::uint8_t> FileBytes::Exactly(std::uint64_t offset, std::size_t count) {
  const std::span<const std::uint8_t> bytes = From(offset, count);
  if (bytes.size() < count) throw InputError(file_.string() + ": was shortened while it was read");
  return bytes.first(count);
}

void FileBytes::Copy(std::uint64_t offset, std::span<std::uint8_t> bytes) const {
  const std::span<const std::uint8_t> known = InMemory(offset);
  if (known.size() < bytes.size()) {
    Read(offset, bytes);
  } else {
    std::copy_n(known.begin(), bytes.size(), bytes.begin());
  }
}

bool FileBytes::HasGrownTo(std::uint64_t size) {
  if (size <= size_) return true;
  struct stat now = {};
  if (fstat(descriptor_, &now) == 0) size_ = static_cast<std::uint64_t>(now.st_size);
  return size <= size_;
}

std::span<const std::uint8_t> FileBytes::InMemory(std::uint64_t offset) const {
  if (offset < begin_ || offset - begin_ > bytes_.size()) return {};
  return std::span(bytes_).subspan(static_cast<std::size_t>(offset - begin_));
}

std::size_t FileBytes::Read(std::uint64_t offset, std::span<std::uint8_t> bytes) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = pread(descriptor_, bytes.data() + done, bytes.size() - done,
                                static_cast<off_t>(offset + done));
    if (count == 0) break;
    if (count > 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      throw InputError(file_.string() + ": cannot be read: " + std::strerror(errno));
    }
  }
  return done;
}

}  // namespace planbench
