#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "messaging/messages.h"
#include "results/session_plan.h"

namespace planbench {

/// What a session that is resumed was to make before; nothing if that is not known, of a session of
/// an earlier version that was not finished. Throws InputError for a plan that cannot be read, and
/// if `call` asks a planner in other directions than before.
std::optional<SessionPlan> EarlierPlan(const SessionMessage& last, const PlannedCall& call);

/// The shards that it lacks with that plan, in lines; a part by itself, which was not merged of
/// any, waits for none. `plan`: nothing if it is not known.
std::vector<std::string> AwaitedShards(const SessionMessage& last,
                                       const std::optional<SessionPlan>& plan);

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
/// with the commands of both (kMergedCommands).
std::map<std::string, std::string> FlagsOfResumed(const std::map<std::string, std::string>& before,
                                                  std::map<std::string, std::string> now,
                                                  PlanScope scope);

}  // namespace planbench
