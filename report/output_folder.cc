#include "report/output_folder.h"

#include <system_error>
#include <vector>

#include "common/error.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

}  // namespace

void PrepareFolder(const fs::path& folder,
                   const std::function<bool(const std::string& name)>& is_of_report) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError("cannot make the folder " + folder.string() + ": " + error.message());
  std::vector<fs::path> earlier;
  fs::directory_iterator entries(folder, error);
  for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
    const fs::path& file = entries->path();
    std::error_code unknown;
    if (is_of_report(file.filename().string()) && !fs::is_directory(file, unknown)) {
      earlier.push_back(file);
    }
  }
  if (error) throw InputError("cannot read the folder " + folder.string() + ": " + error.message());
  for (const fs::path& file : earlier) {
    fs::remove(file, error);
    if (error) throw InputError("cannot remove " + file.string() + ": " + error.message());
  }
}

}  // namespace planbench
