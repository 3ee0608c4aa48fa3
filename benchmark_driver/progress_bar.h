#pragma once

#include <map>
#include <string>

#include "benchmark_driver/run_rows.h"
#include "common/progress_line.h"

namespace planbench {

/// Progress of a session on stderr, with running success counts. Not thread-safe.
class ProgressBar {
 public:
  /// `earlier`: runs of an earlier part of the session, which count among the `num_runs`. Those
  /// that are to be repeated count when they have been.
  ProgressBar(int num_runs, const RunRows& earlier);

  void Add(const RunRow& run);
  /// A run that turned out not to be needed.
  void Drop() { line_.Drop(); }

 private:
  struct Tally {
    int solved = 0;
    int done = 0;
  };
  void Count(const RunRow& run);

  int num_done_ = 0;
  std::map<std::string, Tally> tallies_;  // by planner
  ProgressLine line_;
};

}  // namespace planbench
