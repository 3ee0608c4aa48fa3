#include "benchmark_driver/await_nodes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <vector>

#include "common/error.h"
#include "common/version.h"

namespace planbench {
namespace {

/// After which the user is told what is waited for.
constexpr std::chrono::seconds kSilence{5};

std::string Heard(const NodeRegistry& registry) {
  std::vector<std::string> heard;
  for (const NodeStatusMessage& node : registry.Live()) {
    if (node.kind == NodeKind::kDriver) continue;
    heard.push_back(fmt::format("{} ({})", node.name, EnumName(node.kind)));
  }
  return heard.empty() ? "nobody" : fmt::format("{}", fmt::join(heard, ", "));
}

}  // namespace

void AwaitNodes(NodeRegistry* registry, double timeout_s,
                const std::function<std::string()>& missing, const std::function<void()>& watch) {
  const auto begin = std::chrono::steady_clock::now();
  const auto deadline = begin + std::chrono::duration<double>(timeout_s);
  bool told = false;
  while (true) {
    watch();
    const std::string what = missing();
    if (what.empty()) return;
    const auto now = std::chrono::steady_clock::now();
    if (now >= deadline) {
      throw InputError(fmt::format("not on the bus within {} s: {}; heard: {}", timeout_s, what,
                                   Heard(*registry)));
    }
    if (!told && now - begin > kSilence) {
      spdlog::info("waiting for {}; heard: {}", what, Heard(*registry));
      told = true;
    }
    registry->Discover("driver");
    registry->WaitUntil([] { return false; }, std::chrono::milliseconds(200));
  }
}

void RequireSameBuild(const NodeStatusMessage& node) {
  if (node.version == Version() && node.commit == Commit()) return;
  throw InputError(fmt::format("the {} '{}' on {} is of another build: {} ({}) against {} ({})",
                               EnumName(node.kind), node.name, node.host, node.version, node.commit,
                               Version(), Commit()));
}

}  // namespace planbench
