#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace planbench {

/// Among the flags of a session that was made in several ways, as one that was merged of parts: the
/// commands, as JoinCommands gives them.
inline constexpr char kMergedCommands[] = "merged";

/// Among them too: what the parts took and lost (report/session_shares.h).
inline constexpr char kMergedParts[] = "merged_parts";

/// Among them too, of a merged session that was resumed: the kMergedParts that it had.
inline constexpr char kHeldParts[] = "held_parts";

/// Whether a session with these flags was merged of parts, be it one, and may have gone on since:
/// to be given shards until it has all.
bool IsMerged(const std::map<std::string, std::string>& flags);

/// Whether what stands among a session's flags is one, and none of the above, nor its plan
/// (results/session_plan.h).
bool IsFlag(std::string_view setting);

/// The command that runs a session again, from the driver's flags as it recorded them, quoted for a
/// shell; "" if they are not known. Flags that were left out, and those that name this session's
/// own folder or bus, are not in it. Of a session that was made in several ways all of them.
std::string ReproducingCommand(const std::map<std::string, std::string>& flags);

/// Distinct commands in their order, joined by &&; each may be several that were joined.
std::string JoinCommands(const std::vector<std::string>& commands);

/// The command that goes on with a session that was interrupted.
std::string ResumingCommand(const std::map<std::string, std::string>& flags,
                            const std::filesystem::path& session_folder);

/// What makes runs that could not be asked for or judged (messaging/asked_runs.h): "--resume makes
/// them". Of `number` runs, `num_unjudgeable` have a path that the referee's step is too fine for.
std::string WhatMakesThem(int number, int num_unjudgeable);

/// What a resumed session lacks of its earlier plan, and what makes it: `number` runs, of which
/// `num_unjudgeable` as above, and `num_repeats` of disturbed ones; `resuming`: the command.
std::string DescribeOwed(int number, int num_unjudgeable, int num_repeats,
                         const std::string& resuming);

}  // namespace planbench
