#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <string>
#include <utility>
#include <vector>

namespace planbench {

/// The last answers given, as bytes, by request id: requests are repeated until their answer
/// arrives, and a request that has been answered is not worked on again.
class AnswerMemory {
 public:
  /// Answers kept, and bytes of them: scenes may be large. The last one is kept whatever its size.
  static constexpr std::size_t kCapacity = 64;
  static constexpr std::size_t kMostBytes = std::size_t{128} << 20;

  explicit AnswerMemory(std::size_t most_bytes = kMostBytes) : most_bytes_(most_bytes) {}

  /// nullptr if there is none (any more).
  const std::vector<std::uint8_t>* Find(const std::string& request_id) const {
    for (const auto& [id, answer] : answers_) {
      if (id == request_id) return &answer;
    }
    return nullptr;
  }

  const std::vector<std::uint8_t>& Add(const std::string& request_id,
                                       std::vector<std::uint8_t> answer) {
    bytes_ += answer.size();
    answers_.emplace_back(request_id, std::move(answer));
    while (answers_.size() > kCapacity || (bytes_ > most_bytes_ && answers_.size() > 1)) {
      bytes_ -= answers_.front().second.size();
      answers_.pop_front();
    }
    return answers_.back().second;
  }

 private:
  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  std::list<std::pair<std::string, std::vector<std::uint8_t>>> answers_;
};

}  // namespace planbench
