#include "common/base64.h"

#include <yaml-cpp/binary.h>

namespace planbench {

std::string EncodeBase64(const std::vector<std::uint8_t>& bytes) {
  return YAML::EncodeBase64(bytes.data(), bytes.size());
}

}  // namespace planbench
