#pragma once

#include <string>

#include "benchmark_driver/supervisor.h"

namespace planbench {

/// A real LCM bus that no other process is on.
inline std::string PrivateUdpUrl() {
  return "udpm://239.255.76.67:" + std::to_string(FreeUdpPort()) + "?ttl=0&recv_buf_size=4194304";
}

}  // namespace planbench
