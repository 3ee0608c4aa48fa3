#include "benchmark_driver/record_spool.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace planbench {

void RecordSpool::Fail(const char* what) {
  throw std::runtime_error(std::string("run records that no logger has yet cannot be ") + what +
                           " in a temporary file: " + std::strerror(errno));
}

void RecordSpool::Add(const Record& record) {
  Place place{static_cast<std::int64_t>(memory_.size()),
              static_cast<std::uint32_t>(record.id.size()),
              static_cast<std::uint32_t>(record.bytes.size())};
  const std::string text = record.id + std::string(record.bytes.begin(), record.bytes.end());
  if (!file_ && memory_.size() + text.size() <= memory_bytes_) {
    memory_ += text;
  } else {
    if (!file_) file_.reset(std::tmpfile());
    place.offset += file_bytes_;
    if (!file_ || fseeko(file_.get(), file_bytes_, SEEK_SET) != 0 ||
        std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() ||
        std::fflush(file_.get()) != 0) {
      Fail("kept");
    }
    file_bytes_ += static_cast<std::int64_t>(text.size());
  }
  places_.push_back(place);
}

RecordSpool::Record RecordSpool::At(std::size_t index) {
  const Place& place = places_.at(index);
  std::string text(place.id_bytes + place.bytes, '\0');
  const auto in_memory = static_cast<std::int64_t>(memory_.size());
  if (place.offset < in_memory) {
    text = memory_.substr(static_cast<std::size_t>(place.offset), text.size());
  } else if (fseeko(file_.get(), place.offset - in_memory, SEEK_SET) != 0 ||
             std::fread(text.data(), 1, text.size(), file_.get()) != text.size()) {
    Fail("found");
  }
  return {text.substr(0, place.id_bytes), {text.begin() + place.id_bytes, text.end()}};
}

}  // namespace planbench
