#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace planbench {

/// RFC 4648, filled up with '='.
std::string EncodeBase64(const std::vector<std::uint8_t>& bytes);

}  // namespace planbench
