#pragma once

#include <cstdint>
#include <string>

namespace planbench {

/// "2024-05-06T07:08:09.123456Z" of a time in us since the Unix epoch.
std::string IsoTime(std::int64_t utime);

}  // namespace planbench
