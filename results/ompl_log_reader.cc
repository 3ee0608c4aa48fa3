#include "results/ompl_log_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "common/error.h"
#include "common/read_text.h"
#include "results/ompl_session.h"

namespace planbench {
namespace {

std::vector<std::string> Split(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find(separator, from)) != std::string::npos;) {
    parts.push_back(text.substr(from, at - from));
    from = at + separator.size();
  }
  parts.push_back(text.substr(from));
  return parts;
}

class OmplLogReader {
 public:
  explicit OmplLogReader(const std::filesystem::path& file) : file_(file), text_(ReadText(file)) {}

  void Read(OmplSession* session) {
    try {
      const int num_planners = ReadHeader(&session->session());
      for (int i = 0; i < num_planners; ++i) ReadPlanner(session);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}:{}: {}", file_.string(), line_, error.what()));
    }
  }

 private:
  std::string Next() {
    std::string line;
    if (!std::getline(text_, line)) throw InputError("the log ends here");
    ++line_;
    if (line.ends_with('\r')) line.pop_back();
    return line;
  }

  /// The number that a line of the form "7 runs" begins with.
  static int Count(const std::string& line, const std::string& what) {
    int count = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), count);
    const std::string rest(end, static_cast<std::size_t>(line.data() + line.size() - end));
    if (error != std::errc() || count < 0 || !rest.starts_with(" " + what)) {
      throw InputError("'" + line + "' is not the number of " + what);
    }
    return count;
  }

  /// Returns the number of planners.
  int ReadHeader(StoredSession* session) {
    const auto after = [](const std::string& line, const std::string& begin) {
      return line.substr(begin.size());
    };
    int num_blocks = 0;
    while (true) {
      std::string line = Next();
      if (line.find(" version ") != std::string::npos && session->version.empty()) {
        session->version = line;
      } else if (line.starts_with("Experiment ")) {
        experiment_ = after(line, "Experiment ");
      } else if (line.starts_with("Running on ")) {
        session->host = after(line, "Running on ");
      } else if (line.starts_with("Starting at ")) {
        session->date = after(line, "Starting at ");
      } else if (line.starts_with("<<<|")) {
        std::string block;
        while (!(line = Next()).starts_with("|>>>")) block += line + "\n";
        if (++num_blocks == 2) session->cpu = block.substr(0, block.find('\n'));
      } else if (line.ends_with("is the random seed")) {
        session->seed = line.substr(0, line.find(' '));
      } else if (line.ends_with(" seconds per run")) {
        time_limit_s_ =
            FindAmount({{"time limit", line.substr(0, line.find(' '))}}, "time limit").value_or(0);
      } else if (line.ends_with(" to collect the data")) {
        session->total_time_s =
            FindAmount({{"total time", line.substr(0, line.find(' '))}}, "total time").value_or(0);
      } else if (line.ends_with(" enum type") || line.ends_with(" enum types")) {
        for (int i = Count(line, "enum"); i > 0; --i) {
          std::vector<std::string> names = Split(Next(), "|");
          if (names.front() != "status") continue;
          names.erase(names.begin());
          statuses_ = NumberStatuses(names);
        }
      } else if (line.ends_with(" planners")) {
        return Count(line, "planners");
      }
    }
  }

  /// Names of "7 properties for each run" and what follows.
  std::vector<std::string> ReadNames(int count) {
    std::vector<std::string> names;
    for (; count > 0; --count) {
      std::string name = Next();
      name = name.substr(0, name.rfind(' '));  // the type
      std::replace(name.begin(), name.end(), ' ', '_');
      names.push_back(std::move(name));
    }
    return names;
  }

  OmplProperties ReadValues(const std::vector<std::string>& names, const std::string& text,
                            const std::string& separator) const {
    std::vector<std::string> values = Split(text, separator);
    values.pop_back();  // each value is followed by a separator
    if (values.size() < names.size()) {
      throw InputError(fmt::format("{} values for {} properties", values.size(), names.size()));
    }
    OmplProperties properties;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string& value = values[i];
      if (!value.empty() && value != "nan" && value != "inf") properties[names[i]] = value;
    }
    return properties;
  }

  void ReadPlanner(OmplSession* session) {
    const std::string planner = Next();
    std::string settings;
    for (int i = Count(Next(), "common properties"); i > 0; --i) settings += Next() + "\n";
    const std::size_t contestant = session->Contestant(planner, settings);
    const auto names = ReadNames(Count(Next(), "properties for each run"));
    const int num_runs = Count(Next(), "runs");
    const std::size_t first = session->session().runs.size();
    for (int i = 0; i < num_runs; ++i) {
      session->AddRun(contestant, 0, experiment_, time_limit_s_, statuses_,
                      ReadValues(names, Next(), "; "));
    }
    const std::string line = Next();
    if (line == ".") return;
    const auto progress_names = ReadNames(Count(line, "progress properties for each run"));
    const int num_series = Count(Next(), "runs");
    for (int i = 0; i < num_series; ++i) {
      const std::string series = Next();
      if (i >= num_runs) continue;
      for (const std::string& sample : Split(series, ";")) {
        if (sample.empty()) continue;
        AddProgress(ReadValues(progress_names, sample, ","), &session->session().runs[first + i]);
      }
    }
    if (Next() != ".") throw InputError("a planner's results end with '.'");
  }

  std::filesystem::path file_;
  std::istringstream text_;
  int line_ = 0;
  std::string experiment_;
  double time_limit_s_ = 0;
  OmplStatuses statuses_ = StatusesOfOmpl();
};

}  // namespace

StoredSession ReadOmplLog(const std::filesystem::path& file, const std::string& name,
                          std::vector<std::string>* warnings) {
  OmplSession session(name);
  OmplLogReader(file).Read(&session);
  return session.Take(file, warnings);
}

}  // namespace planbench
