#pragma once

#include <map>
#include <string>

namespace planbench {

/// Counts why runs failed. Reasons that differ in their figures alone ("0.012 m deep", "segment 3
/// at 0.25:") are one.
class ReasonCount {
 public:
  void Add(const std::string& reason);
  /// "mostly: " and the one most often given, as it was first worded; "among others: " where it is
  /// not that of half the runs. Empty without any.
  std::string Summary() const;

 private:
  struct Reason {
    std::string example;
    int count = 0;
  };
  std::map<std::string, Reason> reasons_;  // By their words.
};

}  // namespace planbench
