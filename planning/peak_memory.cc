#include "planning/peak_memory.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <string_view>

namespace planbench {
namespace {

/// A file of /proc kept open for the life of the process: opening one takes ten times as long as
/// reading it, and this is done for every request.
class ProcFile {
 public:
  ProcFile(const char* path, int flags) : descriptor_(open(path, flags | O_CLOEXEC)) {}
  ~ProcFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  ProcFile(const ProcFile&) = delete;
  ProcFile& operator=(const ProcFile&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

void ResetPeakMemory() {
  static const ProcFile clear_refs("/proc/self/clear_refs", O_WRONLY);
  // proc(5): writing 5 resets the peak resident set size ("high water mark"). Where that is not
  // permitted there is nothing to be done.
  [[maybe_unused]] const ssize_t written = pwrite(clear_refs.descriptor(), "5", 1, 0);
}

double PeakMemoryMb() {
  static const ProcFile status("/proc/self/status", O_RDONLY);
  std::array<char, 4096> buffer;
  const ssize_t size = pread(status.descriptor(), buffer.data(), buffer.size(), 0);
  if (size <= 0) return 0;
  const std::string_view text(buffer.data(), static_cast<std::size_t>(size));
  constexpr std::string_view kKey = "\nVmHWM:";
  const std::size_t key = text.find(kKey);
  if (key == std::string_view::npos) return 0;
  const std::size_t begin = text.find_first_not_of(" \t", key + kKey.size());
  if (begin == std::string_view::npos) return 0;
  long long kib = 0;
  std::from_chars(text.data() + begin, text.data() + text.size(), kib);
  return static_cast<double>(kib) / 1024;
}

}  // namespace planbench
