#include "bus_tools/traffic.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/text.h"

namespace planbench {

void Traffic::Add(const ReceivedMessage& message) {
  Channel& channel = channels_[Printable(message.channel)];
  ++channel.messages;
  ++channel.recent_messages;
  channel.recent_bytes += static_cast<std::int64_t>(message.bytes.size());
}

std::string Traffic::Rates(double seconds, const Bus::Counters& counters) {
  std::size_t width = 7;
  for (const auto& [name, channel] : channels_) width = std::max(width, name.size());
  std::string text = fmt::format("{:<{}}  {:>10}  {:>10}  {:>10}\n", "channel", width, "messages/s",
                                 "kB/s", "messages");
  for (auto& [name, channel] : channels_) {
    text +=
        fmt::format("{:<{}}  {:>10.1f}  {:>10.1f}  {:>10}\n", name, width,
                    static_cast<double>(channel.recent_messages) / seconds,
                    static_cast<double>(channel.recent_bytes) / 1e3 / seconds, channel.messages);
    channel.recent_messages = 0;
    channel.recent_bytes = 0;
  }
  return text +
         fmt::format("lost: {}, came faster than they were read: {}, no packets of LCM: {}\n",
                     counters.lost, counters.dropped, counters.malformed);
}

}  // namespace planbench
