#pragma once

#include <string>
#include <vector>

#include "messaging/messages.h"
#include "planning/path_library.h"

namespace planbench {

/// Which runs to learn from.
struct Lessons {
  std::vector<std::string> sets;         ///< Of these problem sets; empty: all.
  std::vector<std::string> contestants;  ///< Of these; empty: anybody's.
};

/// Of each problem the shortest simplified path that the referee confirmed (and, where it judged
/// with meshes, found free by them too). Throws InputError if there is none, a set or contestant is
/// not among the runs, or paths are of different joints.
PathLibrary LearnPaths(const std::vector<RunRecordMessage>& runs, const Lessons& lessons);

}  // namespace planbench
