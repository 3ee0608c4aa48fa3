#pragma once

#include <map>
#include <string>
#include <vector>

#include "benchmark_driver/resume.h"
#include "benchmark_driver/schedule.h"
#include "messaging/messages.h"

namespace planbench {

/// For the record of a session (kEntrants): which planners a call of the driver asks, and in which
/// directions.
std::string EntrantsText(const std::vector<Entrant>& entrants);

/// All runs that a session was to make before it is resumed, each once, those made included: by the
/// flags, contestants and planners that it told of each time it was begun or resumed. What cannot
/// be known is left out: of a session that does not tell of its flags, and of sets that are not
/// served any more, or not as they were.
std::vector<ScheduledRun> EarlierPlan(const std::vector<SessionMessage>& earlier,
                                      const ProblemSetsMessage& served);

/// Adds to conditions what a session had beside them before it was resumed: sets and contestants,
/// its own first. Throws InputError if a contestant has another's name.
void AddEarlier(const std::vector<SessionMessage>& earlier, SessionConditions* conditions);

/// How what a call is to make relates to what the session was to make before.
enum class PlanScope {
  kAll,   ///< All of it, and maybe more.
  kPart,  ///< Nothing else.
  kOther,
};

/// The flags by which a resumed session is made again: those of the call, or those of before, or
/// with the commands of both (kMergedCommands) and the shards of both. `sets`: those of the call.
std::map<std::string, std::string> FlagsOfResumed(const std::map<std::string, std::string>& before,
                                                  std::map<std::string, std::string> now,
                                                  PlanScope scope,
                                                  const std::vector<std::string>& sets);

}  // namespace planbench
