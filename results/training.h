#pragma once

#include <map>
#include <string>

namespace planbench {

/// Setting of a contestant that is given the path of another (`first_path_of`): kLearnedFrom of
/// that one.
inline constexpr char kFirstPathLearnedFrom[] = "first_path_learned_from";

/// Beside the name of a contestant in tables of a set that it has learned from, and what that says.
inline constexpr char kTrained[] = "(trained)";
inline constexpr char kTrainedNote[] =
    "(trained): has learned from this very set, which is therefore no test.";

/// The problem sets from which a contestant of such settings, or the one whose path it is given,
/// has learned, ", " between; empty if there are none.
std::string LearnedFrom(const std::map<std::string, std::string>& settings);

/// Whether what was learned from these sets (LearnedFrom) was learned from `problem_set`.
bool IsTrainedOn(const std::string& learned_from, const std::string& problem_set);

}  // namespace planbench
