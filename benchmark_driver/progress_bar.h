#pragma once

#include <chrono>
#include <map>
#include <string>

#include "messaging/messages.h"

namespace planbench {

/// Progress of a session on stderr, with running success counts: one line that is rewritten on a
/// terminal, else a line now and then. Not thread-safe.
class ProgressBar {
 public:
  explicit ProgressBar(int num_runs);
  /// Ends the line.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Counts a run of an earlier part of the session: it does not bear on the estimate of the
  /// remaining time.
  void AddEarlier(const RunRecordMessage& record);
  void Add(const RunRecordMessage& record);

 private:
  struct Tally {
    int solved = 0;
    int done = 0;
  };
  void Count(const RunRecordMessage& record);
  std::string Line() const;
  void Show(bool last);

  int num_runs_;
  int num_done_ = 0;
  int num_earlier_ = 0;
  std::map<std::string, Tally> tallies_;  // by "planner direction"
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point shown_;
  bool on_terminal_;
};

}  // namespace planbench
