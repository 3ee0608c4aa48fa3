#include "planning/peak_memory.h"

#include <fstream>
#include <sstream>
#include <string>

namespace planbench {

void ResetPeakMemory() {
  // proc(5): writing 5 resets the peak resident set size ("high water mark").
  std::ofstream clear_refs("/proc/self/clear_refs");
  clear_refs << "5" << std::flush;
}

double PeakMemoryMb() {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (!line.starts_with("VmHWM:")) continue;
    std::istringstream value(line.substr(6));
    double kib = 0;
    value >> kib;
    return kib / 1024;
  }
  return 0;
}

}  // namespace planbench
