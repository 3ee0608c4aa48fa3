#include "messaging/event_log_files.h"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include "common/error.h"
#include "common/file_kind.h"
#include "common/read_text.h"

namespace planbench {

namespace fs = std::filesystem;

namespace {

/// Of FILE.07: 7.
std::optional<int> NumberAfter(const std::string& first_name, const std::string& name) {
  if (!name.starts_with(first_name + ".")) return std::nullopt;
  const std::string_view digits = std::string_view(name).substr(first_name.size() + 1);
  int number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (number < 1 || fmt::format("{:02}", number) != digits) return std::nullopt;
  return number;
}

/// How many files the log of a session folder has, as its run.json tells; 0 if that tells nothing.
/// A logger that was killed may have begun more.
std::size_t NumFilesTold(const fs::path& run_json) {
  if (!IsFile(run_json)) return 0;
  const auto told = nlohmann::json::parse(ReadText(run_json), nullptr, false);
  if (!told.is_object()) return 0;
  const auto number = told.find("event_log_files");
  return number != told.end() && number->is_number_unsigned() ? number->get<std::size_t>() : 0;
}

}  // namespace

fs::path EventLogFile(const fs::path& event_log, int number) {
  return number == 0 ? event_log : fs::path(fmt::format("{}.{:02}", event_log.string(), number));
}

std::vector<fs::path> EventLogFiles(const fs::path& event_log) {
  fs::path base = event_log;
  if (base.extension() == ".00") base.replace_extension();
  const fs::path folder = base.has_parent_path() ? base.parent_path() : fs::path(".");
  std::set<int> numbers;
  std::set<fs::path> logs;
  std::error_code ignored;  // a folder that cannot be listed may hold a file that can be read
  fs::directory_iterator entry(folder, ignored);
  for (; !ignored && entry != fs::directory_iterator(); entry.increment(ignored)) {
    const auto number = NumberAfter(base.filename().string(), entry->path().filename().string());
    if (number) numbers.insert(*number);
    if (entry->path().extension() == ".lcmlog") logs.insert(entry->path().filename());
  }
  std::vector<fs::path> files = {event_log};
  for (const int number : numbers) {
    const fs::path expected = EventLogFile(base, static_cast<int>(files.size()));
    files.push_back(EventLogFile(base, number));
    if (files.back() != expected) {
      throw InputError(fmt::format("{} is missing between the files of the event log {}",
                                   expected.string(), event_log.string()));
    }
  }
  // Of several logs in the folder it is not known of which run.json tells.
  if (logs != std::set<fs::path>{event_log.filename()}) return files;
  const fs::path run_json = folder / "run.json";
  if (const std::size_t num_told = NumFilesTold(run_json); files.size() < num_told) {
    throw InputError(fmt::format("{} is missing: the event log {} has {} files, as {} tells",
                                 EventLogFile(base, static_cast<int>(files.size())).string(),
                                 event_log.string(), num_told, run_json.string()));
  }
  return files;
}

}  // namespace planbench
