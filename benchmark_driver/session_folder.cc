#include "benchmark_driver/session_folder.h"

#include "common/error.h"

namespace planbench {

std::filesystem::path EventLogOf(const std::filesystem::path& session_folder) {
  if (!std::filesystem::is_directory(session_folder)) {
    throw InputError("--resume: " + session_folder.string() + " is no folder");
  }
  std::filesystem::path log;
  for (const auto& entry : std::filesystem::directory_iterator(session_folder)) {
    if (entry.path().extension() != ".lcmlog") continue;
    if (!log.empty()) {
      throw InputError("--resume: " + session_folder.string() + " holds several .lcmlog files");
    }
    log = entry.path();
  }
  if (log.empty()) {
    throw InputError("--resume: " + session_folder.string() + " holds no .lcmlog file");
  }
  return log;
}

void RequireSameConditions(const SessionMessage& earlier,
                           const std::map<std::string, std::string>& settings) {
  const auto value_in = [](const std::map<std::string, std::string>& all, const char* key) {
    const auto found = all.find(key);
    return found == all.end() ? std::string() : found->second;
  };
  for (const char* key :
       {"time_limit_s", "seed", "collision_model", "edge_resolution_m", "edge_check",
        "referee_step_m", "anytime", "simplify", "clearance", "planner_settings"}) {
    const std::string before = value_in(earlier.settings, key);
    const std::string now = value_in(settings, key);
    if (before != now) {
      throw InputError("--resume: the session was begun with " + std::string(key) + " '" + before +
                       "', which cannot become '" + now + "'");
    }
  }
}

}  // namespace planbench
