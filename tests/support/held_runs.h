#pragma once

#include <utility>
#include <vector>

#include "messaging/record_log.h"

namespace planbench {

/// Runs that a test holds, to be visited; what is visited is gone afterwards, as of a log.
inline EachRun Held(std::vector<RunRecordMessage> runs) {
  return [runs = std::move(runs)](const VisitRun& visit) {
    for (const RunRecordMessage& run : runs) visit(RunRecordMessage(run));
  };
}

}  // namespace planbench
