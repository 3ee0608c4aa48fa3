#include "benchmark_driver/record_spool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace planbench {

bool RecordSpool::Write(const std::string& text) {
  if (!file_) {
    std::string name = folder_ / "records_XXXXXX";
    const int descriptor = mkostemp(name.data(), O_CLOEXEC);
    if (descriptor < 0) return false;
    unlink(name.c_str());
    file_.reset(fdopen(descriptor, "w+"));
    if (!file_) return false;
    // Bytes that found no room would be written anew, in vain, before anything is read.
    std::setvbuf(file_.get(), nullptr, _IONBF, 0);
  }
  return fseeko(file_.get(), file_bytes_, SEEK_SET) == 0 &&
         std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size();
}

void RecordSpool::Add(const Record& record) {
  const std::size_t num_bytes = record.id.size() + record.bytes.size();
  to_file_ = to_file_ || num_bytes > memory_left_;
  if (to_file_ && !Write(record.id + std::string(record.bytes.begin(), record.bytes.end()))) {
    spdlog::warn(
        "run records for loggers to come cannot be kept in a file in {}: {}; from now on they take "
        "memory",
        folder_.string(), std::strerror(errno));
    to_file_ = false;
    memory_left_ = std::numeric_limits<std::size_t>::max();
  }
  places_.push_back({file_bytes_, static_cast<std::uint32_t>(record.id.size()),
                     static_cast<std::uint32_t>(record.bytes.size())});
  if (to_file_) {
    file_bytes_ += static_cast<std::int64_t>(num_bytes);
  } else {
    in_memory_[places_.size() - 1] = record;
    memory_left_ -= num_bytes;
  }
}

RecordSpool::Record RecordSpool::At(std::size_t index) {
  const Place& place = places_.at(index);
  if (const auto found = in_memory_.find(index); found != in_memory_.end()) return found->second;
  std::string text(place.id_bytes + place.bytes, '\0');
  if (fseeko(file_.get(), place.offset, SEEK_SET) != 0 ||
      std::fread(text.data(), 1, text.size(), file_.get()) != text.size()) {
    throw std::runtime_error(fmt::format("run records in a file in {} cannot be read: {}",
                                         folder_.string(), std::strerror(errno)));
  }
  return {text.substr(0, place.id_bytes), {text.begin() + place.id_bytes, text.end()}};
}

}  // namespace planbench
