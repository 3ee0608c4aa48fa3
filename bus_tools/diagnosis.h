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
  int num_small = 2000;  ///< Messages of 1 kB sent to measure loss within this machine.
  int num_large = 20;    ///< Messages of 1 MB.
};

/// Looks at the bus of a URL: whether there is a multicast route, and where it leads, how large a
/// receive buffer the kernel grants, who else is on the port, messages of other versions, how many
/// of others' messages were lost on their way here, and how many of its own come back on a port
/// that no session has. On the bus itself it says no more than a driver that waits for others.
/// Throws InputError for a bad URL; a bus that cannot be joined is a finding.
std::vector<Finding> Diagnose(const DiagnosisOptions& options);

/// "good", "note" or "FAULT", the text, and below it what to do.
std::string FindingText(const Finding& finding);

}  // namespace planbench
