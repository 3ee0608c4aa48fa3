#pragma once

#include <map>
#include <string>
#include <utility>

#include "robot_model/inverse_kinematics.h"

namespace planbench {

/// Counts what was drawn and thrown away.
class Rejections {
 public:
  /// `reason`: what is wrong, with whom ("approach goal: no inverse kinematics solution");
  /// `where`: the place in the specification it comes from.
  void Add(const std::string& reason, const std::string& where) { ++counts_[{reason, where}]; }
  /// By how much a pose was missed, and how much is allowed.
  struct Miss {
    double off_m = 0;
    double off_rad = 0;
    IkOptions allowed;
    /// In multiples of what is allowed.
    double Size() const;
  };
  /// Of the misses of a reason, the summary tells the least.
  void Add(const std::string& reason, const std::string& where, const Miss& miss);
  void Add(const Rejections& other);

  /// Counts by reason.
  std::map<std::string, long> ByReason() const;
  /// "reason 12, other reason 3 (least miss)", the most frequent first; "nothing" if there are
  /// none.
  std::string Summary() const;
  /// Where the most frequent comes from, "" if there are none.
  std::string MostFrequentPlace() const;

 private:
  void KeepLeast(const std::string& reason, const Miss& miss);

  std::map<std::pair<std::string, std::string>, long> counts_;
  std::map<std::string, Miss> least_misses_;  // By reason.
};

}  // namespace planbench
