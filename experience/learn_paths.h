#pragma once

#include <string>
#include <vector>

#include "messaging/record_log.h"
#include "planning/path_library.h"

namespace planbench {

/// Which runs to learn from.
struct Lessons {
  std::vector<std::string> sets;  ///< Of these problem sets; empty: all.
  /// Of these, by their names in tables or on the bus; empty: anybody's.
  std::vector<std::string> contestants;
};

struct Learned {
  PathLibrary library;
  int num_against_meshes = 0;  ///< Paths that the referee confirmed and the meshes refused.
};

/// Of each problem the shortest simplified path that the referee confirmed and, where it judged
/// with meshes too, found free by them. Throws InputError if there is none, a set or contestant is
/// not among the runs, or paths are of different joints.
Learned LearnPaths(const EachRun& each_run, const Lessons& lessons);

}  // namespace planbench
