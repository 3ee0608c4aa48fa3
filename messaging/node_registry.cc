#include "messaging/node_registry.h"

#include "messaging/channels.h"

namespace planbench {

NodeRegistry::NodeRegistry(Bus* bus)
    : bus_(bus),
      statuses_(bus->Subscribe<NodeStatusMessage>(
          channel::kNodeStatus,
          [this](const NodeStatusMessage& status) {
            const std::scoped_lock lock(mutex_);
            nodes_[status.name] = {status, std::chrono::steady_clock::now()};
            changed_.notify_all();
          })),
      sets_(bus->Subscribe<ProblemSetsMessage>(channel::kProblemSets,
                                               [this](const ProblemSetsMessage& sets) {
                                                 const std::scoped_lock lock(mutex_);
                                                 problem_sets_ = sets;
                                                 changed_.notify_all();
                                               })) {}

std::vector<NodeStatusMessage> NodeRegistry::Live() const {
  const std::scoped_lock lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  std::vector<NodeStatusMessage> live;
  for (const auto& [name, entry] : nodes_) {
    if (now - entry.heard < kLostAfter) live.push_back(entry.status);
  }
  return live;
}

std::vector<NodeStatusMessage> NodeRegistry::Live(NodeKind kind) const {
  std::vector<NodeStatusMessage> live = Live();
  std::erase_if(live, [kind](const NodeStatusMessage& status) { return status.kind != kind; });
  return live;
}

std::optional<NodeStatusMessage> NodeRegistry::Find(const std::string& name, NodeKind kind) const {
  for (NodeStatusMessage& status : Live(kind)) {
    if (status.name == name) return std::move(status);
  }
  return std::nullopt;
}

std::optional<ProblemSetsMessage> NodeRegistry::ProblemSets() const {
  const std::scoped_lock lock(mutex_);
  return problem_sets_;
}

void NodeRegistry::Discover(const std::string& sender) {
  bus_->Publish(channel::kDiscover, DiscoverMessage{sender});
}

bool NodeRegistry::WaitUntil(const std::function<bool()>& condition,
                             std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (!condition()) {
    std::unique_lock lock(mutex_);
    if (std::chrono::steady_clock::now() >= deadline) return false;
    changed_.wait_for(lock, std::chrono::milliseconds(100));
  }
  return true;
}

}  // namespace planbench
