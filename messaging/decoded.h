#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/error.h"
#include "messaging/codec.h"
#include "messaging/packet_reader.h"

namespace planbench {

/// Decodes what an event log holds of a channel, and counts what it cannot.
template <typename Message>
class Decoded {
 public:
  Decoded(const std::filesystem::path& event_log, const char* channel)
      : event_log_(event_log.string()), channel_(channel) {}

  /// Nothing for a message of another channel, or one that is passed over.
  std::optional<Message> Take(const ReceivedMessage& message) {
    if (message.channel != channel_) return std::nullopt;
    try {
      auto decoded = Decode<Message>(message.bytes, message.channel);
      ++num_decoded_;
      return decoded;
    } catch (const MessageError& error) {
      if (num_passed_over_++ == 0) fault_ = error.what();
      return std::nullopt;
    }
  }

  /// Throws InputError if there were such messages and none could be decoded: they are of another
  /// version.
  void RequireAny() const {
    if (num_passed_over_ > 0 && num_decoded_ == 0) throw InputError(event_log_ + ": " + fault_);
  }

  /// Adds a line if anything was passed over: how many, and what is wrong with the first.
  void TellPassedOver(std::vector<std::string>* lines) const {
    if (num_passed_over_ == 0) return;
    lines->push_back(num_passed_over_ == 1
                         ? fmt::format("{}: one message is passed over: {}", event_log_, fault_)
                         : fmt::format("{}: {} messages are passed over, the first: {}", event_log_,
                                       num_passed_over_, fault_));
  }

 private:
  std::string event_log_;
  std::string channel_;
  int num_decoded_ = 0;
  int num_passed_over_ = 0;
  std::string fault_;  ///< Of the first.
};

}  // namespace planbench
