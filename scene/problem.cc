#include "scene/problem.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <regex>
#include <system_error>

#include "common/error.h"
#include "common/file_kind.h"
#include "common/text.h"

namespace planbench {
namespace fs = std::filesystem;

namespace {

/// Where the other file of a problem should be.
fs::path PartnerOf(const fs::path& file, const std::string& kind) {
  const std::string name = file.filename().string();
  return file.parent_path() / (kind + name.substr(name.find_first_of("0123456789")));
}

}  // namespace

const ProblemFiles* ProblemSet::Find(int index) const {
  const auto found =
      std::lower_bound(problems.begin(), problems.end(), index,
                       [](const ProblemFiles& files, int wanted) { return files.index < wanted; });
  return found != problems.end() && found->index == index ? &*found : nullptr;
}

std::optional<int> ProblemIndexOf(const fs::path& scene_or_request_file) {
  static const std::regex kName(R"((?:scene|request)(\d+)\.ya?ml)");
  const std::string name = scene_or_request_file.filename().string();
  std::smatch match;
  if (!std::regex_match(name, match, kName)) return std::nullopt;
  const std::string digits = match[1];
  int index = 0;
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (result.ec != std::errc()) {
    throw InputError(scene_or_request_file.string() + ": its number is too large");
  }
  return index;
}

std::string ProblemSetNameOf(const fs::path& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

void RefuseUnreachable(const fs::path& path) {
  std::error_code error;
  const bool is_missing = fs::status(path, error).type() == fs::file_type::not_found;
  if (!error) return;
  std::error_code no_link;
  const fs::path target = fs::read_symlink(path, no_link);
  if (!no_link) {
    throw InputError(path.string() + ": is a link to '" + target.string() +
                     "', which cannot be followed: " + error.message());
  }
  if (!is_missing) throw InputError(path.string() + ": " + error.message());
}

void RequireProblemFolder(const fs::path& folder) {
  if (IsFolder(folder)) return;
  RefuseUnreachable(folder);
  throw InputError(folder.string() + ": there is no such folder of problems");
}

void RequireProblemFiles(const fs::path& scene, const fs::path& request) {
  for (const fs::path& file : {scene, request}) {
    if (IsFile(file)) continue;
    RefuseUnreachable(file);
    std::error_code ignored;
    throw InputError(file.string() + (fs::exists(file, ignored)
                                          ? ": is no file"
                                          : ": is missing; a problem is a scene and a "
                                            "request file of the same number"));
  }
}

ProblemSet ListProblemSet(const fs::path& folder) {
  RequireProblemFolder(folder);
  std::map<int, ProblemFiles> by_index;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    const std::optional<int> index = ProblemIndexOf(path);
    if (!index) continue;
    ProblemFiles& files = by_index[*index];
    files.index = *index;
    fs::path& slot = path.filename().string().starts_with("scene") ? files.scene : files.request;
    if (!slot.empty()) {
      throw InputError(folder.string() + ": " + slot.filename().string() + " and " +
                       path.filename().string() + " have the same number");
    }
    slot = path;
  }
  if (by_index.empty()) {
    throw InputError(folder.string() +
                     ": holds no problems (pairs of sceneNNNN.yaml and requestNNNN.yaml, or .yml)");
  }
  ProblemSet set;
  set.name = ProblemSetNameOf(folder);
  if (const auto fault = FindNameFault(set.name)) {
    throw InputError(folder.string() + ": its name " + *fault);
  }
  set.folder = folder;
  for (auto& [index, files] : by_index) {
    if (files.request.empty()) files.request = PartnerOf(files.scene, "request");
    if (files.scene.empty()) files.scene = PartnerOf(files.request, "scene");
    set.problems.push_back(files);
  }
  return set;
}

}  // namespace planbench
