#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "messaging/messages.h"

namespace planbench {

/// A field of two sessions (lcmtypes/lcmt_session.lcm) that is not the same in both.
struct ConditionDifference {
  std::string field;  ///< Its place: "node[ara].setting[tip_guide].value".
  std::string first;  ///< "nothing" if it is in the other session alone.
  std::string second;
};

/// Whether flags or settings, as texts, say the same: "0.1" and "0.10" are one number.
bool IsSameSetting(const std::string& first, const std::string& second);

/// Runs of two sessions belong together only if nothing differs that can change a result: every
/// field must be equal, settings as IsSameSetting has it, but for those that tell when and where a
/// session ran, what it ran, what tables say beside contestants, and which collision models their
/// planners offer; sets and planners that only one of them has do not matter. The first field that
/// differs, if any.
std::optional<ConditionDifference> FindConditionDifference(const SessionMessage& first,
                                                           const SessionMessage& second);
/// The same of two processes of one name; the models that they offer count.
std::optional<ConditionDifference> FindConditionDifference(const NodeStatusMessage& first,
                                                           const NodeStatusMessage& second);

/// Runs of machines with different vector instructions belong together all the same, but need not
/// be alike to the last digit: a line that says so and names those that sessions and `cpu`, one
/// more of theirs, tell of (in brackets behind each processor); nothing if they are at most one.
std::optional<std::string> DescribeInstructionDifference(
    const std::vector<SessionMessage>& sessions, std::string_view cpu = {});

}  // namespace planbench
