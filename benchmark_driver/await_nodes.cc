#include "benchmark_driver/await_nodes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <vector>

#include "common/error.h"

namespace planbench {

void AwaitNodes(NodeRegistry* registry, double timeout_s,
                const std::function<std::string()>& missing, const std::function<void()>& watch) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (true) {
    watch();
    const std::string what = missing();
    if (what.empty()) return;
    if (std::chrono::steady_clock::now() >= deadline) {
      std::vector<std::string> heard;
      for (const NodeStatusMessage& node : registry->Live()) {
        if (node.kind == NodeKind::kDriver) continue;
        heard.push_back(fmt::format("{} ({})", node.name, EnumName(node.kind)));
      }
      if (heard.empty()) heard.emplace_back("nobody");
      throw InputError(fmt::format("not on the bus within {} s: {}; heard: {}", timeout_s, what,
                                   fmt::join(heard, ", ")));
    }
    registry->Discover("driver");
    registry->WaitUntil([] { return false; }, std::chrono::milliseconds(200));
  }
}

}  // namespace planbench
