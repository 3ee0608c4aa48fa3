#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/progress_line.h"
#include "messaging/messages.h"

namespace planbench {

/// Progress of a session on stderr, with running success counts. Not thread-safe.
class ProgressBar {
 public:
  /// `earlier`: runs of an earlier part of the session, which count among the `num_runs`.
  ProgressBar(int num_runs, const std::vector<RunRecordMessage>& earlier);

  void Add(const RunRecordMessage& record);
  /// A run that turned out not to be needed.
  void Drop() { line_.Drop(); }

 private:
  struct Tally {
    int solved = 0;
    int done = 0;
  };
  void Count(const RunRecordMessage& record);

  int num_done_ = 0;
  std::map<std::string, Tally> tallies_;  // by planner
  ProgressLine line_;
};

}  // namespace planbench
