#include "logger/utc_time.h"

#include <fmt/format.h>

#include <ctime>

namespace planbench {

std::string IsoTime(std::int64_t utime) {
  constexpr std::int64_t kPerSecond = 1'000'000;
  std::int64_t seconds = utime / kPerSecond;
  std::int64_t microseconds = utime % kPerSecond;
  if (microseconds < 0) {
    microseconds += kPerSecond;
    --seconds;
  }
  const std::time_t time = seconds;
  std::tm utc = {};
  if (gmtime_r(&time, &utc) == nullptr) return fmt::format("{} us", utime);  // no year to name
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}Z", utc.tm_year + 1900,
                     utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec,
                     microseconds);
}

}  // namespace planbench
