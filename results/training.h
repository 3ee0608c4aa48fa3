#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace planbench {

/// Beside the name of a contestant in tables of a set that it has learned from, and what that says.
inline constexpr char kTrained[] = "(trained)";
inline constexpr char kTrainedNote[] =
    "(trained): has learned from problems of this set, which is therefore no test.";

/// The same where several sets are shown together: kTrained if it has learned from all that it is
/// tried on, "(trained on shelf)" if from some, "" if from none.
std::string TrainedMark(const std::vector<std::string>& trained_on, std::size_t num_sets_tried);
inline constexpr char kTrainedOnNote[] =
    "(trained): has learned from problems of the sets, or of those named, which are therefore no "
    "test.";

/// Settings of a contestant that is given the path of another, by which it tells whose
/// (kFirstPathOf) and, if that one, of such settings, has learned from something, from what.
inline constexpr char kFirstPathOf[] = "first_path_of";
std::map<std::string, std::string> FirstPathSettings(
    const std::string& first_planner, const std::map<std::string, std::string>& its_settings);

/// Takes them away.
void EraseFirstPathSettings(std::map<std::string, std::string>* settings);

/// What a contestant of such settings, or the one whose path it is given, has learned from.
class Training {
 public:
  explicit Training(const std::map<std::string, std::string>& settings);

  /// Whether a problem is among that: by its scene, or by the name of its set if either side does
  /// not tell scenes (`scene_id` may be empty).
  bool Includes(const std::string& problem_set, const std::string& scene_id) const;

 private:
  struct Lessons {
    std::string sets;    ///< ", " between.
    std::string scenes;  ///< As kLearnedScenes; empty: not told.
  };
  std::vector<Lessons> lessons_;
};

}  // namespace planbench
