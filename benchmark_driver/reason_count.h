#pragma once

#include <map>
#include <string>

namespace planbench {

/// Counts why runs failed. Reasons that differ in their figures alone ("0.012 m deep", "segment 3
/// at 0.25:") are one.
class ReasonCount {
 public:
  void Add(const std::string& reason);
  /// Of those most often given the first, as it was worded; empty if there is none.
  const std::string& Commonest() const;

 private:
  struct Reason {
    std::string example;
    int count = 0;
  };
  std::map<std::string, Reason> reasons_;  // By their words.
  std::string none_;
};

}  // namespace planbench
