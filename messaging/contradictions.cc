#include "messaging/contradictions.h"

#include <spdlog/spdlog.h>

#include "common/text.h"

namespace planbench {

void Contradictions::Note(const PacketSender& sender, const std::string& channel,
                          const std::string& what) {
  const std::scoped_lock lock(mutex_);
  ++count_;
  const std::pair key(sender.Text(), channel);
  const auto known = entries_.find(key);
  if (known != entries_.end()) {
    ++known->second.count;
    return;
  }
  if (entries_.size() == kMaxEntries) return;
  entries_[key] = {key.first, channel, Printable(what), 1};
  spdlog::warn(
      "{} on {}: {}: refused; whatever else it sends there that contradicts is counted, not told",
      key.first, channel, Printable(what));
}

std::int64_t Contradictions::count() const {
  const std::scoped_lock lock(mutex_);
  return count_;
}

std::vector<Contradictions::Entry> Contradictions::entries() const {
  const std::scoped_lock lock(mutex_);
  std::vector<Entry> entries;
  for (const auto& [key, entry] : entries_) entries.push_back(entry);
  return entries;
}

}  // namespace planbench
