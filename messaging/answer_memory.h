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
  /// Answers kept.
  static constexpr std::size_t kCapacity = 64;

  /// nullptr if there is none (any more).
  const std::vector<std::uint8_t>* Find(const std::string& request_id) const {
    for (const auto& [id, answer] : answers_) {
      if (id == request_id) return &answer;
    }
    return nullptr;
  }

  const std::vector<std::uint8_t>& Add(const std::string& request_id,
                                       std::vector<std::uint8_t> answer) {
    answers_.emplace_back(request_id, std::move(answer));
    if (answers_.size() > kCapacity) answers_.pop_front();
    return answers_.back().second;
  }

 private:
  std::list<std::pair<std::string, std::vector<std::uint8_t>>> answers_;
};

}  // namespace planbench
