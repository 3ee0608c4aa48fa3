#include "results/training.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/lookup.h"
#include "planning/path_library.h"

namespace planbench {
namespace {

constexpr char kFirstPath[] = "first_path_";

bool Lists(const std::string& list, const std::string& separator, const std::string& item) {
  return !list.empty() &&
         (separator + list + separator).find(separator + item + separator) != std::string::npos;
}

}  // namespace

std::string TrainedMark(const std::vector<std::string>& trained_on, std::size_t num_sets_tried) {
  if (trained_on.empty()) return "";
  if (trained_on.size() == num_sets_tried) return kTrained;
  return fmt::format("(trained on {})", fmt::join(trained_on, ", "));
}

std::map<std::string, std::string> FirstPathSettings(
    const std::string& first_planner, const std::map<std::string, std::string>& its_settings) {
  std::map<std::string, std::string> told = {{kFirstPathOf, first_planner}};
  for (const char* key : {kLearnedFrom, kLearnedScenes}) {
    const std::string value = Lookup(its_settings, key).value_or("");
    if (!value.empty()) told[kFirstPath + std::string(key)] = value;
  }
  return told;
}

void EraseFirstPathSettings(std::map<std::string, std::string>* settings) {
  settings->erase(kFirstPathOf);
  for (const char* key : {kLearnedFrom, kLearnedScenes}) {
    settings->erase(kFirstPath + std::string(key));
  }
}

Training::Training(const std::map<std::string, std::string>& settings) {
  for (const std::string whose : {"", kFirstPath}) {
    lessons_.push_back({Lookup(settings, whose + kLearnedFrom).value_or(""),
                        Lookup(settings, whose + kLearnedScenes).value_or("")});
  }
}

bool Training::Includes(const std::string& problem_set, const std::string& scene_id) const {
  return std::any_of(lessons_.begin(), lessons_.end(), [&](const Lessons& lessons) {
    return lessons.scenes.empty() || scene_id.empty()
               ? Lists(lessons.sets, ", ", problem_set)
               : Lists(lessons.scenes, " ", ShortSceneId(scene_id));
  });
}

}  // namespace planbench
