#pragma once

#include <map>
#include <string>

namespace planbench {

/// A reason without what differs between runs that ended alike: figures ("0.012 m deep", "segment 3
/// at 0.25:", "(57 of 60)") and ids of requests. Names with digits in them stay.
std::string WithoutFigures(const std::string& reason);

/// Counts why runs failed. Reasons that are equal without their figures are one.
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
  std::map<std::string, Reason> reasons_;  // WithoutFigures
};

}  // namespace planbench
