#pragma once

#include <map>
#include <set>
#include <string>

namespace planbench {

/// Among a session's flags: which part "I/N" of a whole it is; of one that was merged of several
/// all that it holds, "1/3, 2/3".
inline constexpr char kShardFlag[] = "shard";

/// The parts "I/N" of such a text, and the text of them.
std::set<std::string> ParseShards(const std::string& text);
std::string JoinShards(const std::set<std::string>& shards);

/// By a session's flags; none if it is not a part.
std::set<std::string> ShardsOf(const std::map<std::string, std::string>& flags);

/// Of parts, of any N, the others that make the whole with them.
std::set<std::string> MissingShards(const std::set<std::string>& shards);

/// Those that a session which was merged lacks, by its flags. A part by itself waits for none.
std::set<std::string> AwaitedShards(const std::map<std::string, std::string>& flags);

}  // namespace planbench
