#pragma once

#include <map>
#include <string>
#include <utility>

namespace planbench {

/// Counts what was drawn and thrown away.
class Rejections {
 public:
  /// `reason`: what is wrong, with whom ("approach goal: no inverse kinematics solution");
  /// `where`: the place in the specification it comes from.
  void Add(const std::string& reason, const std::string& where) { ++counts_[{reason, where}]; }
  void Add(const Rejections& other);

  /// Counts by reason.
  std::map<std::string, long> ByReason() const;
  /// "reason 12, other reason 3", the most frequent first; "nothing" if there are none.
  std::string Summary() const;
  /// Where the most frequent comes from, "" if there are none.
  std::string MostFrequentPlace() const;

 private:
  std::map<std::pair<std::string, std::string>, long> counts_;
};

}  // namespace planbench
