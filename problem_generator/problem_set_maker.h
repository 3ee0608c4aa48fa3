#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "problem_generator/problem_generator.h"

namespace planbench {

struct MadeProblems {
  std::vector<Problem> problems;        ///< In the order asked for.
  std::map<std::string, int> by_query;  ///< How many were made for which query.
  Rejections rejections;                ///< Over all of them.
};

/// Makes the problems `indices` (k of ProblemGenerator), all with the same attempt, on `threads`
/// threads; what comes out does not depend on their number. `made` is called after each problem,
/// with their number so far, one call at a time. Throws InputError, naming the place in the
/// specification that stood in the way most often, if a problem cannot be made with the effort
/// allowed.
MadeProblems MakeProblems(const ProblemSpec& spec, const Robot& robot, std::uint64_t seed,
                          const std::vector<int>& indices, int attempt, int threads,
                          const std::function<void(int)>& made = {});

/// Throws InputError if `folder` cannot be written problems to: it is a file, or holds problems
/// already and they are not to be replaced.
void RequireProblemFolder(const std::filesystem::path& folder, bool replace);

/// Writes the problems as sceneNNNN.yaml and requestNNNN.yaml, after creating the folder or
/// removing the problems it holds.
void WriteProblemSet(const std::vector<Problem>& problems, const std::filesystem::path& folder);

/// Writes one of them, over what was there.
void WriteToFolder(const Problem& problem, const std::filesystem::path& folder);

}  // namespace planbench
