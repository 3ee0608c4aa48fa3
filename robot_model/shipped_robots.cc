#include "robot_model/shipped_robots.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/file_kind.h"
#include "common/sibling_program.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

// The folder `robots` of the checkout, or of the installation; empty if the program stands
// elsewhere.
fs::path ShippedRobots() {
  fs::path above = ProgramFolder();
  while (above.has_relative_path()) {
    for (const char* robots : {"robots", "share/planbench/robots"}) {
      if (IsRobotFolder(above / robots / "fetch")) return above / robots;
    }
    above = above.parent_path();
  }
  return {};
}

}  // namespace

bool IsRobotFolder(const fs::path& path) { return IsFile(path / "robot.yaml"); }

fs::path FindRobotFolder(const fs::path& folder_or_name) {
  if (IsRobotFolder(folder_or_name)) return folder_or_name;
  const fs::path shipped = ShippedRobots();
  std::vector<std::string> names;
  if (!shipped.empty()) {
    for (const fs::directory_entry& entry : fs::directory_iterator(shipped)) {
      if (entry.path().filename() == folder_or_name) return entry.path();
      names.push_back(entry.path().filename().string());
    }
  }
  if (IsFolder(folder_or_name)) return folder_or_name;  // whoever reads it tells what it lacks
  std::sort(names.begin(), names.end());
  throw InputError(
      fmt::format("{}: no such folder{}{}", folder_or_name.string(),
                  names.empty() ? "" : ", and no robot of that name ships; those are: ",
                  fmt::join(names, ", ")));
}

}  // namespace planbench
