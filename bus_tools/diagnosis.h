#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace planbench {

/// What was looked at, and what to do about it.
struct Finding {
  enum class Kind { kGood, kNote, kFault };
  Kind kind = Kind::kGood;
  std::string text;  ///< What was found, in a line or several.
  std::string mend;  ///< What would mend it; empty where nothing is to be done.
};

struct DiagnosisOptions {
  std::string lcm_url;
  /// How long to listen for other processes.
  std::chrono::milliseconds listen{2500};
  int num_small = 2000;  ///< Messages of 1 kB sent to measure loss.
  int num_large = 20;    ///< Messages of 1 MB.
};

/// Looks at the bus of a URL: whether there is a multicast route, how large a receive buffer the
/// kernel grants, who else is on the port, messages of other versions, and how many of its own
/// messages arrive (on channels that nobody subscribes to by name). Throws InputError for a bad
/// URL; a bus that cannot be joined is a finding.
std::vector<Finding> Diagnose(const DiagnosisOptions& options);

/// "good", "note" or "FAULT", the text, and below it what to do.
std::string FindingText(const Finding& finding);

}  // namespace planbench
