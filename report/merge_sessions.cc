#include "report/merge_sessions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "common/error.h"
#include "common/file_kind.h"
#include "common/lookup.h"
#include "common/scratch_folder.h"
#include "common/sibling_program.h"
#include "messaging/asked_runs.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/decoded.h"
#include "messaging/event_log.h"
#include "messaging/event_log_reader.h"
#include "messaging/record_log.h"
#include "messaging/session_conditions.h"
#include "planning/told_warnings.h"
#include "report/session_shares.h"
#include "results/bus_json.h"
#include "results/reproduce.h"
#include "results/session_plan.h"
#include "results/shell_quoted.h"
#include "results/stored_ids.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

/// Texts between separators, those that are empty left out.
std::vector<std::string> Split(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  while (from <= text.size()) {
    const std::size_t to = std::min(text.find(separator, from), text.size());
    if (to > from) parts.push_back(text.substr(from, to - from));
    from = to + separator.size();
  }
  return parts;
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

bool IsBefore(const SessionMessage& a, const SessionMessage& b) {
  return SessionOrder(a) < SessionOrder(b);
}

/// Whether it is as it was merged: one that went on since tells of its last part alone.
bool TellsOfParts(const SessionMessage& session) { return session.settings.contains(kMergedParts); }

/// Those of a merged session stand in one text.
void AddTexts(const SessionMessage& session, const std::string& text, const char* separator,
              std::vector<std::string>* texts) {
  const auto parts = TellsOfParts(session) ? Split(text, separator) : std::vector{text};
  texts->insert(texts->end(), parts.begin(), parts.end());
}

/// A session as the folders tell of it.
struct Part {
  std::string folder;                ///< The last one that told of it.
  std::vector<SessionMessage> told;  ///< Last words of folders, by SessionOrder.
  std::vector<SessionPlan> plans;    ///< Of these, nothing where they do not tell.
  std::set<std::string> request_ids;

  const SessionMessage& session() const { return told.back(); }
  const SessionPlan& plan() const { return plans.back(); }
  int num_missing() const {
    int num_runs = 0;
    for (const SessionMessage& one : told) {
      if (Counts(one)) num_runs = std::max(num_runs, one.num_runs);
    }
    return std::max(0, num_runs - static_cast<int>(request_ids.size()));
  }
  bool finished() const {
    return std::all_of(told.begin(), told.end(),
                       [&](const SessionMessage& one) { return one.finished || !Counts(one); });
  }
  /// Whether it is of an earlier version, which did not record its plan.
  bool IsWithoutPlan() const {
    return std::any_of(told.begin(), told.end(), [&](const SessionMessage& one) {
      return Counts(one) && !one.settings.contains(kPlanSetting);
    });
  }

  /// Names of the problems that it was to make by its plan and did not leave out.
  std::set<std::string> Kept() const {
    std::set<std::string> kept;
    for (std::size_t i = 0; i < told.size(); ++i) {
      if (!Counts(told[i])) continue;
      for (const std::string& problem : ProblemsOf(plans[i])) {
        if (!told[i].left_out.contains(problem)) kept.insert(problem);
      }
    }
    return kept;
  }

 private:
  /// A session that goes on in another folder is what that says; one that was merged into several
  /// is all of them.
  bool Counts(const SessionMessage& one) const { return TellsOfParts(one) || &one == &session(); }
};

/// Run ids of a session and of those that it was merged of.
using Origins = std::set<std::string>;

/// What is known of a run while its record is left in the log.
struct Run {
  EventPlace place;
  RunStanding standing;
  std::string contestant;
  PlannedRun planned;
  bool suffices = false;  ///< asked_runs.h
  const Origins* origins = nullptr;

  std::string folder() const { return place.file->parent_path().string(); }
};

/// Whether both tell of a request, in sessions that have nothing in common: neither is a repeat of
/// the other.
bool AreOfStrangers(const Run& a, const Run& b) {
  return a.standing.was_asked && b.standing.was_asked &&
         std::none_of(a.origins->begin(), a.origins->end(),
                      [&](const std::string& run_id) { return b.origins->contains(run_id); });
}

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

class Merge {
 public:
  void Read(const std::string& folder) {
    const fs::path log = FindEventLog(folder);
    const StoredIds stored = ReadDatabase(folder);
    RecordedSession recorded = ReadRecords(log);
    logs_.push_back(log);
    passed_over_.insert(passed_over_.end(), recorded.passed_over.begin(),
                        recorded.passed_over.end());
    AddShares(folder, recorded.sessions);
    if (const StoredIds lost = stored.Without(recorded.sessions, recorded.runs); !lost.empty()) {
      throw InputError(
          fmt::format("{}: its results.sqlite holds what {} lacks and what would be lost: "
                      "{} (to merge without it, take results.sqlite out of the folder)",
                      folder, log.filename().string(), lost.Text()));
    }
    std::map<std::string, SessionMessage> last_words;
    for (SessionMessage& session : recorded.sessions) {
      const auto [last, is_new] = last_words.try_emplace(session.run_id, session);
      if (!is_new && !IsBefore(session, last->second)) last->second = std::move(session);
    }
    for (auto& [run_id, session] : last_words) {
      Part& part = parts_[run_id];
      SessionPlan plan = PlanOf(folder, session);
      if (!part.told.empty()) RequireEqual(part, {folder, {session}, {plan}, {}});
      const auto place = std::upper_bound(part.told.begin(), part.told.end(), session, IsBefore);
      if (place == part.told.end()) part.folder = folder;
      part.plans.insert(part.plans.begin() + (place - part.told.begin()), std::move(plan));
      part.told.insert(place, std::move(session));
    }
    for (const RecordedRun& one : recorded.runs) {
      const RunRecordMessage record = ReadRecord(one.place);
      const auto part = parts_.find(record.run_id);
      if (part == parts_.end()) {
        throw InputError(fmt::format("{}: run {} is of the session {}, which it does not describe",
                                     log.string(), record.request_id, record.run_id));
      }
      part->second.request_ids.insert(record.request_id);
      Run& run = runs_.emplace_back();
      run.place = one.place;
      run.standing = one.standing;
      run.contestant = record.contestant;
      run.planned.trial = {record.problem_set, record.problem_index, record.trial};
      run.planned.planner = record.planner;
      run.planned.direction = record.request.direction;
      run.suffices = Suffices(record);
      run.origins = &origins_[record.run_id];
    }
  }

  /// Equal runs once, under one run id.
  void Unite() {
    if (parts_.empty()) throw InputError("the folders hold no session");
    // Each with each: what only one of two has is not compared, so that two which are equal to a
    // third need not be so to each other.
    for (const auto& [run_id, part] : parts_) {
      for (const auto& [other_id, other] : parts_) {
        if (run_id < other_id) RequireEqual(part, other);
      }
    }
    MakeSession();
    std::map<std::tuple<std::string, PlannedTrial, Direction>, std::size_t> places;
    std::vector<Run> united;
    for (Run& run : runs_) {
      const auto [place, is_new] = places.try_emplace(
          {run.contestant, run.planned.trial, run.planned.direction}, united.size());
      if (is_new) {
        united.push_back(std::move(run));
        continue;
      }
      Run& known = united[place->second];
      const bool are_of_strangers = AreOfStrangers(run, known);
      if (!are_of_strangers && Replaces(run.standing, known.standing)) {
        known = std::move(run);
        continue;
      }
      if (!are_of_strangers && !Contradicts(run.standing, known.standing)) continue;
      if (RecordOf(run) == RecordOf(known)) continue;
      const auto& [set, problem, trial] = run.planned.trial;
      throw InputError(
          fmt::format("{} and {} tell differently of {}, {} {}, {}, trial {}: two runs of one kind "
                      "are not parts of one session",
                      known.folder(), run.folder(), run.contestant, set, problem,
                      EnumName(run.planned.direction), trial));
    }
    num_told_again_ = runs_.size() - united.size();
    runs_ = std::move(united);
    KeepProblems();
    CountRuns();
  }

  void Write(const fs::path& file) {
    EventLog log(file, EventLog::Mode::kNew);
    const std::int64_t utime = session_.start_utime;
    log.Write({channel::kSession, Encode(session_), utime});
    std::set<std::string> scenes;
    for (const fs::path& from : logs_) {
      Decoded<SceneMessage> answers(from, channel::kScene);
      ReadEventLog(from, [&](const ReceivedMessage& message) {
        const auto answer = answers.Take(message);
        if (answer && answer->ok && scenes.insert(answer->scene_id).second) log.Write(message);
      });
      answers.TellPassedOver(&passed_over_);
    }
    for (const Run& run : runs_) {
      log.Write({channel::kRunRecord, Encode(RecordOf(run)), run.standing.start_utime});
    }
    log.Flush();
  }

  /// What was odd on the buses of all (results/bus_json.h).
  std::string bus() const { return shares_.bus(); }

  std::string Summary(const fs::path& out) const {
    const auto instructions = DescribeInstructionDifference({session_});
    return fmt::format(
        "{}: {} runs of {} session{}, {} of them told of more than once{}{}{}{}{}{}", out.string(),
        runs_.size(), parts_.size(), parts_.size() == 1 ? "" : "s", num_told_again_,
        num_to_repeat_ == 0
            ? ""
            : fmt::format("; disturbed and still to be made again (--resume): {}", num_to_repeat_),
        missing_shards_.empty()
            ? ""
            : fmt::format("; shards missing: {}", fmt::join(missing_shards_, "; ")),
        without_bus_.empty() ? ""
                             : fmt::format("; what was lost on the bus is not known: {}",
                                           fmt::join(without_bus_, ", ")),
        instructions ? fmt::format("; {}", *instructions) : "", passed_over_.empty() ? "" : "; ",
        fmt::join(passed_over_, "; "));
  }

 private:
  /// As it stands in the merged session, whose run id is known.
  RunRecordMessage RecordOf(const Run& run) const {
    return Renamed(ReadRecord(run.place), session_.run_id);
  }

  void AddShares(const std::string& folder, const std::vector<SessionMessage>& told) {
    const fs::path run_json = fs::path(folder) / "run.json";
    std::optional<std::string> bus;
    if (IsFile(run_json)) bus = ReadBusJson(run_json);
    if (!bus || !IsToldOf(*bus)) without_bus_.push_back(folder);
    try {
      shares_.Add(told, bus);
      for (const SessionMessage& session : told) {
        Origins& origins = origins_[session.run_id];
        origins.insert(session.run_id);
        origins.merge(SessionShares::MergedRunIds(session.settings));
      }
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", folder, error.what()));
    }
  }

  /// Nothing if it does not tell.
  static SessionPlan PlanOf(const std::string& folder, const SessionMessage& session) {
    try {
      return ReadPlan(session.settings).value_or(SessionPlan());
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", folder, error.what()));
    }
  }

  /// Nothing, which is told of, if the database cannot be read.
  StoredIds ReadDatabase(const std::string& folder) {
    try {
      return ReadStoredIds(folder);
    } catch (const InputError& error) {
      passed_over_.push_back(fmt::format("not compared with the event log: {}", error.what()));
      return {};
    }
  }

  static void RequireEqual(const Part& first, const Part& second) {
    SessionMessage renamed = second.session();
    renamed.run_id = first.session().run_id;
    renamed.conditions.request.run_id = first.session().conditions.request.run_id;
    const auto refuse = [&](const std::string& field, std::string_view of_first,
                            std::string_view of_second) {
      return InputError(fmt::format("{} is {} in {} and {} in {}", field, of_first, first.folder,
                                    of_second, second.folder));
    };
    if (const auto difference = FindConditionDifference(first.session(), renamed)) {
      throw refuse(difference->field, difference->first, difference->second);
    }
    if (const auto difference = FindDirectionsDifference(first.plan(), second.plan())) {
      throw refuse(fmt::format("contestant[{}].directions", difference->planner),
                   EnumName(difference->first), EnumName(difference->second));
    }
  }

  /// All but its number of runs and whether it is finished.
  void MakeSession() {
    std::vector<const Part*> parts;
    for (const auto& [run_id, part] : parts_) parts.push_back(&part);
    std::stable_sort(parts.begin(), parts.end(), [](const Part* a, const Part* b) {
      return a->session().start_utime < b->session().start_utime;
    });
    session_ = parts.front()->session();
    session_.total_time_s = shares_.total_time_s();
    Texts texts;
    for (const Part* part : parts) {
      for (const SessionMessage& told : part->told) Add(told, &texts);
    }
    session_.host = Joined(texts.hosts, ", ");
    session_.cpu = Joined(texts.processors, ", ");
    const std::string command = JoinCommands(texts.commands);
    if (!command.empty()) session_.settings[kMergedCommands] = command;
    session_.settings[kMergedParts] = shares_.Text();
  }

  /// A problem is left out of the whole if it is of all parts that were to make trials of it: what
  /// one left out and another did not is to be made.
  void KeepProblems() {
    if (session_.left_out.empty()) return;
    std::set<std::string> kept;
    for (const Run& run : runs_) {
      if (!run.standing.was_asked) continue;
      kept.insert(LeftOutName(run.planned.trial.problem_set, run.planned.trial.problem_index));
    }
    for (const auto& [run_id, part] : parts_) kept.merge(part.Kept());
    std::erase_if(session_.left_out, [&](const auto& one) { return kept.contains(one.first); });
  }

  /// What is owed, by the plan of all parts; of parts without one the number of runs is known.
  void CountRuns() {
    SessionPlan plan;
    int num_missing = 0;
    std::vector<std::string> unknown_shards;
    bool is_known = true;
    bool finished = true;
    for (const auto& [run_id, part] : parts_) {
      for (const SessionPlan& told : part.plans) AddCalls(told, &plan);
      if (!part.IsWithoutPlan()) continue;
      num_missing += part.num_missing();
      finished = finished && part.finished();
      for (const SessionMessage& told : part.told) {
        if (const auto shard = Lookup(told.settings, kShardFlag)) unknown_shards.push_back(*shard);
      }
      is_known = is_known && part.finished() && part.num_missing() == 0;
    }
    const std::string shards = Joined(unknown_shards, ", ");
    is_known = is_known && shards.empty();
    const bool repeats_disturbed = RepeatsDisturbed(session_.settings);
    std::map<PlannedRun, bool> made;
    for (const Run& run : runs_) {
      made[run.planned] = run.suffices;
      finished = finished && run.standing.was_asked;
      num_to_repeat_ += repeats_disturbed && OwesRepeat(run.standing) ? 1 : 0;
    }
    const int num_owed = CountOwed(plan, made, session_.left_out);
    missing_shards_ = MissingShards(plan);
    if (!shards.empty()) {
      missing_shards_.emplace_back(kUnknownShards);
      session_.settings[kShardFlag] = shards;
    }
    session_.num_runs = static_cast<int>(runs_.size()) + num_missing + num_owed;
    session_.finished = finished && num_owed + num_to_repeat_ == 0 && missing_shards_.empty();
    session_.settings.erase(kPlanSetting);
    if (is_known) session_.settings[kPlanSetting] = PlanText(plan);
  }

  struct Texts {
    std::vector<std::string> hosts, processors, commands;
  };

  /// What one telling of a part adds to the session and its texts.
  void Add(const SessionMessage& told, Texts* texts) {
    AddTexts(told, told.host, ", ", &texts->hosts);
    AddTexts(told, told.cpu, ", ", &texts->processors);
    texts->commands.push_back(ReproducingCommand(told.settings));
    session_.left_out.insert(told.left_out.begin(), told.left_out.end());
    session_.conditions.problem_sets.insert(told.conditions.problem_sets.begin(),
                                            told.conditions.problem_sets.end());
    std::erase_if(session_.settings, [&](const auto& flag) {
      const auto other = Lookup(told.settings, flag.first);
      return !other || !IsSameSetting(*other, flag.second);
    });
    AddNew(told.conditions.contestants, &Contestant::planner, &session_.conditions.contestants);
    AddNew(told.nodes, &NodeStatusMessage::name, &session_.nodes);
    for (NodeStatusMessage& node : session_.nodes) {
      if (node.kind != NodeKind::kSceneServer) continue;
      for (const NodeStatusMessage& one : told.nodes) {
        for (const char* kind : {kProblemWarning, kPlannerWarning}) {
          TellWarnings(kind, ToldWarnings(kind, one.settings), &node.settings);
        }
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
  std::map<std::string, Part> parts_;       ///< By run id.
  std::map<std::string, Origins> origins_;  ///< By run id.
  std::vector<Run> runs_;
  std::size_t num_told_again_ = 0;
  int num_to_repeat_ = 0;                    ///< Since they were disturbed.
  std::vector<std::string> missing_shards_;  ///< In lines.
  SessionShares shares_;
  std::vector<std::string> without_bus_;  ///< Folders that do not tell.
  std::vector<std::string> passed_over_;  ///< RecordedSession's, of all logs.
  SessionMessage session_;
};

}  // namespace

std::string MergeSessions(const std::vector<std::string>& session_folders,
                          const fs::path& out) try {
  const fs::path logger = SiblingProgram("logger");
  if (fs::exists(out) && !fs::is_empty(out)) {
    throw InputError(out.string() + " exists already and is not empty");
  }
  Merge merge;
  for (const std::string& folder : session_folders) merge.Read(folder);
  merge.Unite();
  // The logger makes the folder of the messages, as it does of those of a bus.
  const fs::path place = (fs::absolute(out).lexically_normal() / "").parent_path();
  const ScratchFolder scratch(place.string() + ".merging-");
  const fs::path messages = scratch.path() / "messages.lcmlog";
  merge.Write(messages);
  const int code =
      std::system(fmt::format("{} --from {} --out {}", ShellQuoted(logger.string()),
                              ShellQuoted(messages.string()), ShellQuoted(out.string()))
                      .c_str());
  if (code != 0) throw InputError(out.string() + " could not be written");
  WriteBusJson(out / "run.json", merge.bus());
  return merge.Summary(out);
} catch (const InputError& error) {
  throw InputError(std::string("--merge: ") + error.what());
}

}  // namespace planbench
