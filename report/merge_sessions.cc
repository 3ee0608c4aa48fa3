#include "report/merge_sessions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "common/error.h"
#include "common/sibling_program.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/event_log.h"
#include "messaging/event_log_reader.h"
#include "messaging/record_log.h"
#include "messaging/session_conditions.h"
#include "results/reproduce.h"
#include "results/shell_quoted.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

/// A session as the folders tell of it.
struct Part {
  std::string folder;      ///< The last one that told of it.
  SessionMessage session;  ///< Its last word.
  std::set<std::string> request_ids;

  int num_missing() const {
    return std::max(0, session.num_runs - static_cast<int>(request_ids.size()));
  }
};

struct Run {
  std::string folder;
  RunRecordMessage record;
};

/// `id` with the run id that it begins with replaced.
std::string Renamed(const std::string& id, const std::string& from, const std::string& to) {
  return id.starts_with(from) ? to + id.substr(from.size()) : id;
}

RunRecordMessage Renamed(RunRecordMessage record, const std::string& run_id) {
  const std::string from = record.run_id;
  record.run_id = record.request.run_id = record.result.run_id = run_id;
  for (std::string* id : {&record.request_id, &record.request.request_id, &record.result.request_id,
                          &record.path_check.request_id, &record.simplified_check.request_id}) {
    *id = Renamed(*id, from, run_id);
  }
  return record;
}

/// Distinct texts that are not empty, in their order.
std::string Joined(const std::vector<std::string>& texts, const char* separator) {
  std::vector<std::string> distinct;
  for (const std::string& text : texts) {
    if (!text.empty() && std::find(distinct.begin(), distinct.end(), text) == distinct.end()) {
      distinct.push_back(text);
    }
  }
  return fmt::format("{}", fmt::join(distinct, separator));
}

class Merge {
 public:
  void Read(const std::string& folder) {
    const fs::path log = FindEventLog(folder);
    RecordedSession recorded = ReadRecords(log);
    logs_.push_back(log);
    for (SessionMessage& session : recorded.sessions) {
      Part& part = parts_[session.run_id];
      if (!part.folder.empty()) RequireEqual(part, {folder, session, {}});
      if (!part.folder.empty() && SessionOrder(session) < SessionOrder(part.session)) continue;
      part.folder = folder;
      part.session = std::move(session);
    }
    for (RunRecordMessage& record : recorded.runs) {
      const auto part = parts_.find(record.run_id);
      if (part == parts_.end()) {
        throw InputError(
            fmt::format("--merge: {}: run {} is of the session {}, which it does not "
                        "describe",
                        log.string(), record.request_id, record.run_id));
      }
      part->second.request_ids.insert(record.request_id);
      runs_.push_back({folder, std::move(record)});
    }
  }

  /// Equal runs once, under one run id.
  void Unite() {
    if (parts_.empty()) throw InputError("--merge: the folders hold no session");
    for (const auto& [run_id, part] : parts_) {
      for (const auto& [other_id, other] : parts_) {
        if (run_id < other_id) RequireEqual(part, other);
      }
    }
    MakeSession();
    std::map<std::tuple<std::string, std::string, int, Direction, int>, std::size_t> places;
    std::vector<Run> united;
    for (Run& run : runs_) {
      run.record = Renamed(std::move(run.record), session_.run_id);
      const RunRecordMessage& record = run.record;
      const auto [place, is_new] =
          places.try_emplace({record.contestant, record.problem_set, record.problem_index,
                              record.request.direction, record.trial},
                             united.size());
      if (is_new) {
        united.push_back(std::move(run));
        continue;
      }
      const Run& known = united[place->second];
      if (known.record == record) continue;
      throw InputError(fmt::format(
          "--merge: {} and {} tell differently of {}, {} {}, {}, trial {}: two runs of one kind "
          "are not parts of one session",
          known.folder, run.folder, record.contestant, record.problem_set, record.problem_index,
          EnumName(record.request.direction), record.trial));
    }
    num_repeated_ = runs_.size() - united.size();
    runs_ = std::move(united);
    session_.num_runs += static_cast<int>(runs_.size());
  }

  void Write(const fs::path& file) const {
    fs::remove(file);
    EventLog log(file, EventLog::Mode::kNew);
    const std::int64_t utime = session_.start_utime;
    log.Write({channel::kSession, Encode(session_), utime});
    std::set<std::string> scenes;
    for (const fs::path& from : logs_) {
      ReadEventLog(from, [&](const ReceivedMessage& message) {
        if (message.channel != channel::kScene) return;
        const auto scene = Decode<SceneMessage>(message.bytes, message.channel);
        if (scene.ok && scenes.insert(scene.scene_id).second) log.Write(message);
      });
    }
    for (const Run& run : runs_) {
      log.Write({channel::kRunRecord, Encode(run.record), run.record.start_utime});
    }
    log.Flush();
  }

  std::string Summary(const fs::path& out) const {
    return fmt::format("{}: {} runs of {} session{}, {} of them told of more than once{}",
                       out.string(), runs_.size(), parts_.size(), parts_.size() == 1 ? "" : "s",
                       num_repeated_,
                       missing_shards_.empty()
                           ? ""
                           : fmt::format("; shards missing: {}", fmt::join(missing_shards_, ", ")));
  }

 private:
  static void RequireEqual(const Part& first, const Part& second) {
    SessionMessage renamed = second.session;
    renamed.run_id = first.session.run_id;
    renamed.conditions.request.run_id = first.session.conditions.request.run_id;
    const auto difference = FindConditionDifference(first.session, renamed);
    if (!difference) return;
    throw InputError(fmt::format("--merge: {} is {} in {} and {} in {}", difference->field,
                                 difference->first, first.folder, difference->second,
                                 second.folder));
  }

  /// Its number of runs is that of the runs that are missing.
  void MakeSession() {
    std::vector<const Part*> parts;
    for (const auto& [run_id, part] : parts_) parts.push_back(&part);
    std::stable_sort(parts.begin(), parts.end(), [](const Part* a, const Part* b) {
      return a->session.start_utime < b->session.start_utime;
    });
    session_ = parts.front()->session;
    std::vector<std::string> hosts, processors, commands;
    std::set<std::string> shards;
    session_.finished = true;
    session_.total_time_s = 0;
    session_.num_runs = 0;
    for (const Part* part : parts) {
      const SessionMessage& session = part->session;
      session_.finished = session_.finished && session.finished;
      if (const auto shard = session.settings.find("shard"); shard != session.settings.end()) {
        shards.insert(shard->second);
      }
      session_.total_time_s += session.total_time_s;
      session_.num_runs += part->num_missing();
      hosts.push_back(session.host);
      processors.push_back(session.cpu);
      commands.push_back(ReproducingCommand(session.settings));
      session_.left_out.insert(session.left_out.begin(), session.left_out.end());
      session_.conditions.problem_sets.insert(session.conditions.problem_sets.begin(),
                                              session.conditions.problem_sets.end());
      std::erase_if(session_.settings, [&](const auto& flag) {
        const auto other = session.settings.find(flag.first);
        return other == session.settings.end() || other->second != flag.second;
      });
      AddNew(session.conditions.contestants, &Contestant::planner,
             &session_.conditions.contestants);
      AddNew(session.nodes, &NodeStatusMessage::name, &session_.nodes);
    }
    session_.host = Joined(hosts, ", ");
    session_.cpu = Joined(processors, ", ");
    FindMissingShards(shards);
    session_.finished = session_.finished && missing_shards_.empty();
    const std::string command = Joined(commands, " && ");
    if (!command.empty()) session_.settings[kMergedCommands] = command;
  }

  /// Of texts "I/N", of any N, those that are not there.
  void FindMissingShards(const std::set<std::string>& shards) {
    for (const std::string& shard : shards) {
      const std::size_t slash = shard.find('/');
      if (slash == std::string::npos) continue;
      const int count = std::atoi(shard.c_str() + slash + 1);
      for (int i = 1; i <= count; ++i) {
        const std::string other = fmt::format("{}/{}", i, count);
        if (!shards.contains(other)) missing_shards_.insert(other);
      }
    }
  }

  template <typename Value>
  static void AddNew(const std::vector<Value>& values, std::string Value::*name,
                     std::vector<Value>* all) {
    for (const Value& value : values) {
      if (std::none_of(all->begin(), all->end(),
                       [&](const Value& known) { return known.*name == value.*name; })) {
        all->push_back(value);
      }
    }
  }

  std::vector<fs::path> logs_;
  std::map<std::string, Part> parts_;  ///< By run id.
  std::vector<Run> runs_;
  std::size_t num_repeated_ = 0;
  std::set<std::string> missing_shards_;
  SessionMessage session_;
};

}  // namespace

std::string MergeSessions(const std::vector<std::string>& session_folders, const fs::path& out) {
  const fs::path logger = SiblingProgram("logger");
  if (fs::exists(out) && !fs::is_empty(out)) {
    throw InputError("--merge: " + out.string() + " exists already and is not empty");
  }
  Merge merge;
  for (const std::string& folder : session_folders) merge.Read(folder);
  merge.Unite();
  // The logger makes the folder of the messages, as it does of those of a bus.
  const fs::path messages = (fs::absolute(out) / "").parent_path().string() + ".merging";
  merge.Write(messages);
  const int code =
      std::system(fmt::format("{} --from {} --out {}", ShellQuoted(logger.string()),
                              ShellQuoted(messages.string()), ShellQuoted(out.string()))
                      .c_str());
  fs::remove(messages);
  if (code != 0) throw InputError("--merge: " + out.string() + " could not be written");
  return merge.Summary(out);
}

}  // namespace planbench
