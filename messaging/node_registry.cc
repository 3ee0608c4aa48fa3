#include "messaging/node_registry.h"

#include <algorithm>
#include <iterator>

#include "messaging/channels.h"

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;

/// Beyond, nodes that are not live any more are forgotten.
constexpr std::size_t kManyNodes = 256;
/// Rivals make us ask everybody no more often.
constexpr std::chrono::milliseconds kAskPeriod{200};

}  // namespace

NodeRegistry::NodeRegistry(Bus* bus)
    : bus_(bus),
      statuses_(bus->SubscribeFrom<NodeStatusMessage>(
          channel::kNodeStatus, [this](const NodeStatusMessage& status,
                                       const Origin& origin) { OnStatus(status, origin.sender); })),
      sets_(bus->SubscribeFrom<ProblemSetsMessage>(
          channel::kProblemSets, [this](const ProblemSetsMessage& sets, const Origin& origin) {
            OnProblemSets(sets, origin.sender);
          })) {}

NodeRegistry::Key NodeRegistry::KeyOf(NodeKind kind, const std::string& name,
                                      const std::string& instance) {
  if (kind == NodeKind::kSceneServer) return {kind, ""};
  return {kind, kind == NodeKind::kLogger ? name + " " + instance : name};
}

NodeRegistry::Entry* NodeRegistry::Settle(const Key& key, TimePoint now) const {
  const auto found = nodes_.find(key);
  if (found == nodes_.end()) return nullptr;
  Entry& entry = found->second;
  if (entry.rival && now - entry.rival->last >= kLostAfter) entry.rival.reset();
  if (entry.rival &&
      (now - entry.holder.last >= kLostAfter || now - entry.rival->node.since >= kRivalPatience)) {
    entry.holder = *std::exchange(entry.rival, std::nullopt);
  }
  return &entry;
}

void NodeRegistry::ForgetTheDead(TimePoint now) {
  for (auto node = nodes_.begin(); node != nodes_.end();) {
    const Entry* entry = Settle(node->first, now);
    node = now - entry->holder.last >= kLostAfter ? nodes_.erase(node) : std::next(node);
  }
}

void NodeRegistry::OnStatus(const NodeStatusMessage& status, const PacketSender& sender) {
  const auto now = Clock::now();
  const std::scoped_lock lock(mutex_);
  if (nodes_.size() >= kManyNodes) ForgetTheDead(now);
  const Key key = KeyOf(status.kind, status.name, status.instance);
  Entry* entry = Settle(key, now);
  Heard heard{{status, sender, now}, now};
  if (entry == nullptr) {
    if (nodes_.size() < 4 * kManyNodes) nodes_[key] = {heard, std::nullopt};
  } else if (entry->holder.node.sender == sender || now - entry->holder.last >= kLostAfter) {
    if (entry->rival) {
      const Node& rival = entry->rival->node;
      bus_->contradictions().Note(
          rival.sender, channel::kNodeStatus,
          "claims to be '" + rival.status.name + "', which is live at " + sender.Text());
    }
    const Node& holder = entry->holder.node;
    if (holder.sender == sender) heard.node.since = holder.since;
    *entry = {heard, std::nullopt};
  } else if (!entry->rival) {
    entry->rival = heard;
    if (now - asked_ >= kAskPeriod) {
      asked_ = now;
      bus_->Publish(channel::kDiscover, DiscoverMessage{"registry"});
    }
  } else if (entry->rival->node.sender == sender) {
    entry->rival->node.status = status;
    entry->rival->last = now;
  }
  changed_.notify_all();
}

void NodeRegistry::OnProblemSets(const ProblemSetsMessage& sets, const PacketSender& sender) {
  if (!Believes(sender, NodeKind::kSceneServer, "", channel::kProblemSets)) return;
  const std::scoped_lock lock(mutex_);
  problem_sets_ = sets;
  changed_.notify_all();
}

std::vector<NodeStatusMessage> NodeRegistry::Live() const {
  std::vector<NodeStatusMessage> live;
  for (const NodeKind kind : EnumValues<NodeKind>()) {
    for (NodeStatusMessage& status : Live(kind)) live.push_back(std::move(status));
  }
  return live;
}

std::vector<NodeStatusMessage> NodeRegistry::Live(NodeKind kind) const {
  std::vector<NodeStatusMessage> live;
  for (Node& node : LiveNodes(kind)) live.push_back(std::move(node.status));
  return live;
}

std::vector<NodeRegistry::Node> NodeRegistry::LiveNodes(NodeKind kind) const {
  const std::scoped_lock lock(mutex_);
  const auto now = Clock::now();
  std::vector<Node> live;
  for (const auto& [key, unsettled] : nodes_) {
    if (key.first != kind) continue;
    const Entry* entry = Settle(key, now);
    if (now - entry->holder.last < kLostAfter) live.push_back(entry->holder.node);
  }
  return live;
}

std::optional<NodeStatusMessage> NodeRegistry::Find(const std::string& name, NodeKind kind) const {
  auto node = FindNode(name, kind);
  if (!node) return std::nullopt;
  return std::move(node->status);
}

std::optional<NodeRegistry::Node> NodeRegistry::FindNode(const std::string& name,
                                                         NodeKind kind) const {
  for (Node& node : LiveNodes(kind)) {
    if (node.status.name == name) return std::move(node);
  }
  return std::nullopt;
}

std::optional<ProblemSetsMessage> NodeRegistry::ProblemSets() const {
  const std::scoped_lock lock(mutex_);
  return problem_sets_;
}

bool NodeRegistry::Believes(const PacketSender& sender, NodeKind kind, const std::string& name,
                            const std::string& channel) const {
  const std::scoped_lock lock(mutex_);
  const Entry* entry = Settle(KeyOf(kind, name, ""), Clock::now());
  if (entry == nullptr) return false;  // its announcement is still to come
  const Node& holder = entry->holder.node;
  if (holder.sender == sender) return true;
  if (entry->rival && entry->rival->node.sender == sender) return false;
  bus_->contradictions().Note(sender, channel,
                              "is not the " + std::string(EnumName(kind)) + " '" +
                                  holder.status.name + "', which is at " + holder.sender.Text());
  return false;
}

void NodeRegistry::Forget(const NodeStatusMessage& process) {
  const std::scoped_lock lock(mutex_);
  const auto found = nodes_.find(KeyOf(process.kind, process.name, process.instance));
  if (found == nodes_.end()) return;
  Entry& entry = found->second;
  if (entry.holder.node.status.instance != process.instance) return;
  if (entry.rival) {
    entry.holder = *std::exchange(entry.rival, std::nullopt);
  } else {
    nodes_.erase(found);
  }
  changed_.notify_all();
}

void NodeRegistry::Discover(const std::string& sender) {
  bus_->Publish(channel::kDiscover, DiscoverMessage{sender});
}

bool NodeRegistry::WaitUntil(const std::function<bool()>& condition,
                             std::chrono::milliseconds timeout) {
  const auto deadline = Clock::now() + timeout;
  while (!condition()) {
    std::unique_lock lock(mutex_);
    const auto now = Clock::now();
    if (now >= deadline) return false;
    changed_.wait_until(lock, std::min(deadline, now + std::chrono::milliseconds(100)));
  }
  return true;
}

}  // namespace planbench
