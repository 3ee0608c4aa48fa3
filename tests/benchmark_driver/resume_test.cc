#include "benchmark_driver/resume.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <functional>
#include <set>
#include <type_traits>

#include "common/sqlite.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/event_log.h"
#include "messaging/message_fields.h"
#include "messaging/session_conditions.h"
#include "results/reproduce.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/session_database.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

/// The archive (messaging/fields.h) that changes one field of a value, whatever that holds.
class FieldChanger {
 public:
  static constexpr bool kReads = true;

  /// Changes the `which`-th field, from 0; a list gets an element more.
  explicit FieldChanger(int which) : which_(which) {}
  /// Name of what was changed; empty if there are not so many fields.
  const std::string& changed() const { return changed_; }

  void Utime(std::int64_t&) {}
  template <typename Value, typename Wire, typename Rule = rules::Anything>
  void Field(const char* name, Value& value, Wire& wire, Rule = {}) {
    if constexpr (HasFields<Value>) {
      Fields<Value>::List(*this, value, wire);
    } else if (Chosen(name)) {
      Change(value);
    }
  }
  template <typename Values, typename Wires, typename Rule = rules::Anything>
  void List(const char* name, Values& values, Wires&, std::int32_t&, Rule = {}) {
    if (!Chosen(name)) return;
    if constexpr (requires { typename Values::mapped_type; }) {
      values.emplace("another", typename Values::mapped_type());
    } else {
      values.emplace_back();
    }
  }
  template <typename Values, typename Wires, typename Rule = rules::Anything>
  void Beside(const char*, Values& values, Wires&, std::int32_t&, Rule = {}) {
    if (changed_ == "joint_name") values.emplace_back();  // as long as the list before
  }
  template <typename Values>
  void Rows(const char* name, Values& values, auto&, std::int32_t&, std::int32_t&) {
    if (next_ - 1 == which_) values.push_back({0});  // as wide as the list before is long
    if (Chosen(name)) values.emplace_back();
  }
  void Require(bool, const char*, const char*) {}

 private:
  bool Chosen(const char* name) {
    if (next_++ != which_) return false;
    changed_ = name;
    return true;
  }
  template <typename Value>
  static void Change(Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
      value = !value;
    } else if constexpr (std::is_enum_v<Value>) {
      value = static_cast<Value>((static_cast<int>(value) + 1) % kNumEnumValues<Value>);
    } else if constexpr (std::is_arithmetic_v<Value>) {
      value += 1;
    } else if constexpr (std::is_same_v<Value, std::string>) {
      value += "another";
    } else if (value) {
      Change(*value);
    } else {
      value.emplace();
      Change(*value);
    }
  }

  int which_;
  int next_ = 0;
  std::string changed_;
};

NodeStatusMessage Node(const std::string& name, NodeKind kind) {
  NodeStatusMessage node;
  node.name = name;
  node.kind = kind;
  node.settings = {{"key", "value"}};
  return node;
}

Contestant Contest(const std::string& planner, const std::string& command) {
  Contestant contestant;
  contestant.planner = planner;
  contestant.name = "the " + planner;
  contestant.command = command;
  return contestant;
}

SessionMessage Session() {
  SessionMessage session;
  session.run_id = "run";
  session.conditions.problem_sets = {{"box", "box-1"}, {"cage", "cage-1"}};
  session.conditions.contestants = {Contest("ara", ""), Contest("mine", "./mine")};
  session.nodes = {Node("ara", NodeKind::kPlanner), Node("mine", NodeKind::kPlanner),
                   Node("server", NodeKind::kSceneServer), Node("logger", NodeKind::kLogger)};
  return session;
}

/// Goes on with Session() after `change`.
void Resume(const std::function<void(SessionMessage&)>& change) {
  SessionMessage now = Session();
  change(now);
  RequireSameConditions(Session(), now);
}

/// What Resume throws names the field, before and now.
void ExpectRefused(const std::function<void(SessionMessage&)>& change,
                   std::vector<std::string> parts) {
  parts.emplace_back("--resume");
  ExpectInputError([&] { Resume(change); }, parts);
}

TEST(RequireSameConditionsTest, EveryConditionCounts) {
  std::set<std::string> names;
  for (int which = 0;; ++which) {
    FieldChanger changer(which);
    const auto change = [&](SessionMessage& session) {
      Fields<SessionConditions>::Wire wire{};
      Fields<SessionConditions>::List(changer, session.conditions, wire);
    };
    SessionMessage changed = Session();
    change(changed);
    const std::string name = changer.changed();
    if (name.empty()) break;
    names.insert(name);
    ASSERT_NE(changed.conditions, Session().conditions) << name;
    if (name == "problem_set" || name == "contestant") {
      EXPECT_NO_THROW(RequireSameConditions(Session(), changed)) << name;  // One more.
    } else {
      ExpectInputError([&] { RequireSameConditions(Session(), changed); }, {"--resume", name});
    }
  }
  EXPECT_GT(names.size(), 15u);
}

TEST(RequireSameConditionsTest, EverythingThatAPlannerOrServerSaysOfItselfCounts) {
  for (const int node : {0, 2}) {
    for (int which = 0;; ++which) {
      FieldChanger changer(which);
      SessionMessage changed = Session();
      Fields<NodeStatusMessage>::Wire wire{};
      Fields<NodeStatusMessage>::List(changer, changed.nodes[static_cast<std::size_t>(node)], wire);
      const std::string name = changer.changed();
      if (name.empty()) break;
      std::set<std::string> free = {"utime", "start_utime", "state", "request_id", "host", "pid"};
      free.insert({"name", "instance", "trouble", "unusable_model"});
      // Of a contestant's models the one that counts is a condition of its own.
      free.insert(node == 2 ? "setting" : "collision_model");
      if (name == "kind") continue;  // another node
      if (free.contains(name)) {
        EXPECT_NO_THROW(RequireSameConditions(Session(), changed)) << name;
      } else {
        ExpectInputError([&] { RequireSameConditions(Session(), changed); }, {"--resume", name});
      }
    }
  }
}

TEST(RequireSameConditionsTest, NamesWhatDiffersBeforeAndNow) {
  ExpectRefused([](auto& s) { s.conditions.request.time_limit_s = 10; },
                {"conditions.request.time_limit_s was 60", "is 10 now"});
  ExpectRefused([](auto& s) { s.conditions.problem_sets["cage"] = "cage-2"; },
                {"conditions.problem_set[cage].value was \"cage-1\"", "is \"cage-2\" now"});
  ExpectRefused([](auto& s) { s.conditions.contestants[1].command = "./mine -x"; },
                {"contestant[mine].command", "\"./mine\"", "\"./mine -x\""});
  ExpectRefused(
      [](auto& s) {
        s.nodes[1].settings = {{"key", "value"}, {"more", "x"}};
      },
      {"node[mine].setting[more]", "was nothing", "\"x\""});
  ExpectRefused([](auto& s) { s.version = "2"; }, {"version was \"\"", "\"2\""});
}

TEST(RequireSameConditionsTest, OfWhoIsNoContestantTheModelsCount) {
  ExpectRefused(
      [](auto& s) {
        s.conditions.contestants.erase(s.conditions.contestants.begin());
        s.nodes[0].collision_models = {"voxels"};
      },
      {"node[ara]", "collision_model"});
}

TEST(RequireSameConditionsTest, WhatIsRunMayChangeAndWhenAndWhere) {
  EXPECT_NO_THROW(Resume([](auto& s) { s.conditions.problem_sets.erase("cage"); }));
  EXPECT_NO_THROW(Resume([](auto& s) {
    s.nodes.erase(s.nodes.begin());
    s.conditions.contestants.erase(s.conditions.contestants.begin());
  }));
  EXPECT_NO_THROW(Resume([](auto& s) { std::swap(s.nodes[0], s.nodes[3]); }));
  EXPECT_NO_THROW(Resume([](auto& s) { s.nodes.emplace_back(s.nodes[1]).host = "another"; }));
  EXPECT_NO_THROW(Resume([](auto& s) { s.settings["trials"] = "3"; }));
  EXPECT_NO_THROW(Resume([](auto& s) {
    s.conditions.contestants[0].about = s.conditions.contestants[0].published = "more";
  }));
  EXPECT_NO_THROW(Resume([](auto& s) {
    s.start_utime = 5;
    s.finished = true;
    s.total_time_s = 7;
    s.num_runs = 9;
    s.host = s.cpu = "another";
    s.left_out["cage 3"] = "is odd";
  }));
}

TEST(DescribeInstructionDifferenceTest, OfWhatProcessorsTell) {
  const auto difference = [](const std::vector<std::string>& cpus, const std::string& cpu) {
    std::vector<SessionMessage> sessions;
    for (const std::string& of_session : cpus) sessions.emplace_back().cpu = of_session;
    return DescribeInstructionDifference(sessions, cpu).value_or("");
  };
  EXPECT_EQ(difference({}, ""), "");
  EXPECT_EQ(difference({"Intel(R) Xeon(R) [AVX2]"}, "of an earlier version"), "");
  EXPECT_EQ(difference({"one [AVX2]", "another [AVX2], a third [AVX2]"}, "["), "");
  EXPECT_THAT(difference({"one [AVX2]"}, "one [AVX-512]"), testing::HasSubstr("(AVX-512, AVX2)"));
  EXPECT_THAT(difference({"one [SSE4], one [AVX2]"}, ""), testing::HasSubstr("(AVX2, SSE4)"));
}

TEST(RequireSameConditionsTest, FlagsThatChangeWhatRunsCountForMayNotChange) {
  for (const char* flag :
       {"directions", "max-disturbance", "problems-per-process", "repeat-disturbed"}) {
    SessionMessage before;
    SessionMessage now;
    before.settings[flag] = "a";
    EXPECT_NO_THROW(RequireSameConditions(before, now)) << "it is not told";
    now.settings[flag] = "b";
    ExpectInputError([&] { RequireSameConditions(before, now); },
                     {"--resume", fmt::format("setting[{}].value was \"a\"", flag), "\"b\" now"});
  }
}

TEST(RequireSameConditionsTest, AnotherShardIsRefusedUnlessTheSessionWasMerged) {
  const auto resume_with = [](const std::string& before, const std::string& now) {
    SessionMessage first, second;
    first.settings["shard"] = before;
    second.settings["shard"] = now;
    RequireSameConditions(first, second);
    RequireSameConditions(SessionMessage(), second);  // it is not told
  };
  EXPECT_NO_THROW(resume_with("1/3", "1/3"));
  EXPECT_NO_THROW(resume_with("", ""));
  ExpectInputError([&] { resume_with("1/3", "2/3"); }, {"--resume", "--shard 1/3", "--shard 2/3"});
  ExpectInputError([&] { resume_with("1/3", ""); }, {"--resume", "--shard 1/3", "no --shard"});
  ExpectInputError([&] { resume_with("", "1/2"); }, {"--resume", "no --shard", "--shard 1/2"});
  SessionMessage before, now;
  now.settings["shard"] = "2/3";
  // Merged, be it of one part, or merged and gone on with.
  for (const char* parts : {kMergedParts, kHeldParts}) {
    before.settings = {{"shard", "1/3"}, {parts, "{}"}};
    EXPECT_NO_THROW(RequireSameConditions(before, now));
  }
  // Made in several ways, as a shard that is resumed with other planners.
  before.settings = {{"shard", "1/3"}, {kMergedCommands, "a && b"}};
  ExpectInputError([&] { RequireSameConditions(before, now); }, {"--shard 1/3", "--shard 2/3"});
}

TEST(RequireSameConditionsTest, PinnedPlannersStayPinnedNoMatterWhere) {
  const auto resume_with = [](const std::string& before, const std::string& now) {
    SessionMessage first, second;
    first.settings["pin"] = before;
    second.settings["pin"] = now;
    RequireSameConditions(first, second);
    RequireSameConditions(SessionMessage(), second);  // it is not told
    first.settings[kMergedParts] = "{}";
    RequireSameConditions(first, second);
  };
  EXPECT_NO_THROW(resume_with("", ""));
  EXPECT_NO_THROW(resume_with("2-3", "0"));
  ExpectInputError([&] { resume_with("2-3", ""); }, {"--resume", "--pin 2-3", "no --pin"});
  ExpectInputError([&] { resume_with("", "1"); }, {"--resume", "no --pin", "--pin 1"});
}

TEST(RequireSameConditionsTest, NumbersOfFlagsAndSettingsAreComparedAsNumbers) {
  const auto resume_with = [](const std::string& before, const std::string& now) {
    SessionMessage first, second;
    first.settings["max-disturbance"] = before;
    second.settings["max-disturbance"] = now;
    RequireSameConditions(first, second);
    first = second = Session();
    first.nodes[1].settings = {{"step", before}};
    second.nodes[1].settings = {{"step", now}};
    RequireSameConditions(first, second);
  };
  for (const char* other : {"0.10", ".1", "1e-1", "+0.1"}) {
    EXPECT_NO_THROW(resume_with("0.1", other)) << other;
  }
  EXPECT_NO_THROW(resume_with("10", "10.0"));
  ExpectInputError([&] { resume_with("0.1", "0.11"); }, {"was \"0.1\"", "is \"0.11\" now"});
  ExpectInputError([&] { resume_with("9007199254740992", "9007199254740993"); }, {"--resume"});
  ExpectInputError([&] { resume_with("0.1", "0.1 m"); }, {"--resume"});
  ExpectInputError([&] { resume_with("nan", "NaN"); }, {"--resume"});
  SessionMessage first, second;  // versions are no numbers
  first.version = "0.1";
  second.version = "0.10";
  ExpectInputError([&] { RequireSameConditions(first, second); }, {"version"});
}

TEST(ReadEarlierSessionTest, MissingFolderLogOrChoiceIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  ExpectInputError([&] { ReadEarlierSession(path + "/missing"); }, {"--resume", path + "/missing"});
  ExpectInputError([&] { ReadEarlierSession(path); }, {"--resume", path, "no .lcmlog"});
  folder.Write("a.lcmlog", "");
  folder.Write("b.lcmlog", "");
  ExpectInputError([&] { ReadEarlierSession(path); }, {"--resume", path, "several"});
}

TEST(ReadEarlierSessionTest, ASessionKilledAtOnceHoldsNothing) {
  const TemporaryFolder folder;
  folder.Write("logs/other.lcmlog", "");
  EXPECT_TRUE(ReadEarlierSession(folder.path()).sessions.empty());
  folder.Write("a.lcmlog", "");
  EXPECT_TRUE(ReadEarlierSession(folder.path()).sessions.empty());
}

std::size_t NumRuns(const EarlierSession& session) {
  std::size_t number = 0;
  session.each_run([&](const RunRecordMessage&) { ++number; });
  return number;
}

/// A session folder "s" whose database and event log hold different things, if the test says so.
class LoggedSessionTest : public testing::Test {
 protected:
  LoggedSessionTest() {
    folder_.Write("s/logs/logger.log", "");
    WriteSession(path_, runs_);
  }

  /// The log of the session's beginning and of runs, by their places in `runs_`.
  void WriteLog(const std::vector<std::size_t>& runs, bool with_session = true) {
    EventLog log(path_ / "s.lcmlog", EventLog::Mode::kNew);
    SessionMessage session;
    session.run_id = "s";
    if (with_session) log.Write({channel::kSession, Encode(session), 1});
    for (const std::size_t run : runs) {
      const RunRecordMessage record = MakeRecord(runs_[run], "s", static_cast<int>(run) + 1);
      log.Write({channel::kRunRecord, Encode(record), 2});
    }
  }

  void ExpectNotResumed(std::vector<std::string> parts) const {
    parts.insert(parts.end(), {"--resume: results.sqlite in " + path_.string()});
    ExpectInputError([&] { ReadEarlierSession(path_); }, parts);
  }

  const std::vector<MadeRun> runs_ = {{.contestant = "A", .problem = 1},
                                      {.contestant = "A", .problem = 2},
                                      {.contestant = "A", .problem = 3}};
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "s";
};

TEST_F(LoggedSessionTest, WhatTheLogLacksOfTheDatabaseIsNotMadeAgain) {
  WriteLog({2});  // the middle of the log is damaged, or its end is cut off
  ExpectNotResumed(
      {"2 runs, the first of them s-1",
       "logger --from " + (path_ / "s.lcmlog").string() + " --out " + path_.string() + "-rebuilt"});
  std::filesystem::remove(path_ / "s.lcmlog");
  WriteLog({0, 2});
  ExpectNotResumed({"1 run, s-2"});
  std::filesystem::remove(path_ / "s.lcmlog");
  WriteLog({}, false);  // nothing is left of it
  ExpectNotResumed({"3 runs"});
}

TEST_F(LoggedSessionTest, ARepeatThatTheLogLacksIsNotMadeAgain) {
  WriteLog({0, 1, 2});
  const auto attempt = [](int repeats) {
    MadeRun run = {.contestant = "A", .problem = 4, .counters = {{"disturbed", 1}}};
    if (repeats > 0) run.counters["repeats"] = repeats;
    return MakeRecord(run, "s", 4);
  };
  const auto log = [&](int repeats) {
    EventLog(path_ / "s.lcmlog", EventLog::Mode::kAppend)
        .Write({channel::kRunRecord, Encode(attempt(repeats)), 3});
  };
  {
    ResultsDatabase database(path_ / "results.sqlite");
    for (const int repeats : {0, 1}) database.Store(attempt(repeats));
  }
  log(0);
  ExpectNotResumed({"1 run, s-4 (repeat 1)"});
  log(2);  // the database is behind
  EXPECT_EQ(NumRuns(ReadEarlierSession(path_)), 4u);
}

TEST_F(LoggedSessionTest, RunsAreReadFromTheLogWhenTheyAreVisited) {
  WriteLog({0, 1, 2});
  const EarlierSession earlier = ReadEarlierSession(path_);
  std::size_t number = 0;
  earlier.each_run([&](const RunRecordMessage& record) {
    EXPECT_EQ(record, MakeRecord(runs_[number], "s", static_cast<int>(number) + 1));
    ++number;
  });
  EXPECT_EQ(number, 3u);
  std::filesystem::resize_file(path_ / "s.lcmlog", 10);
  ExpectInputError([&] { NumRuns(earlier); }, {"s.lcmlog", "was shortened"});
}

TEST_F(LoggedSessionTest, TheFolderBesideIsNamedAlsoOfOneThatIsHere) {
  WriteLog({2});
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(path_);
  ExpectInputError(
      [] { ReadEarlierSession("."); },
      {"logger --from " + (path_ / "s.lcmlog").string() + " --out " + path_.string() + "-rebuilt"});
  std::filesystem::current_path(before);
}

TEST_F(LoggedSessionTest, ADatabaseMayBeBehindItsLogOrLost) {
  WriteLog({0, 1, 2});
  EXPECT_EQ(NumRuns(ReadEarlierSession(path_)), 3u);
  {
    SqliteConnection database(path_ / "results.sqlite", SqliteConnection::Mode::kReadWriteCreate);
    database.Execute("DELETE FROM runs WHERE problem_index = 1");
    // As other programs append it.
    database.Execute("UPDATE runs SET run_id = NULL, request_id = 'x' WHERE problem_index = 2");
  }
  EXPECT_EQ(NumRuns(ReadEarlierSession(path_)), 3u);
  folder_.Write("s/results.sqlite", "");  // of a logger that was killed at once
  EXPECT_EQ(NumRuns(ReadEarlierSession(path_)), 3u);
  std::filesystem::remove(path_ / "results.sqlite");
  EXPECT_EQ(NumRuns(ReadEarlierSession(path_)), 3u);
}

TEST_F(LoggedSessionTest, NoSecondSessionBeginsWhereTheLogIsGone) {
  ExpectNotResumed({"3 runs, the first of them s-1", "no event log (.lcmlog)"});
  SqliteConnection(path_ / "results.sqlite", SqliteConnection::Mode::kReadWriteCreate)
      .Execute("DELETE FROM runs");
  ExpectNotResumed({"the session s", "no event log"});
  WriteLog({}, false);
  ExpectNotResumed({"the session s"});
}

TEST_F(LoggedSessionTest, ADatabaseThatIsNoneIsNamed) {
  WriteLog({0});
  folder_.Write("s/results.sqlite", std::string(4096, 'x'));
  ExpectInputError([&] { ReadEarlierSession(path_); },
                   {"--resume: " + (path_ / "results.sqlite").string()});
}

TEST(AwaitLoggersEndTest, NamesTheOneThatDoesNotEnd) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(AwaitLoggersEnd(folder.path(), std::chrono::milliseconds(0)));
  const auto file = folder.Write("logger.lock", "4711");
  EXPECT_NO_THROW(AwaitLoggersEnd(folder.path(), std::chrono::milliseconds(0)));
  const int lock = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(lock, LOCK_EX | LOCK_NB), 0);
  ExpectInputError([&] { AwaitLoggersEnd(folder.path(), std::chrono::milliseconds(0)); },
                   {"--resume", folder.path().string(), "pid 4711"});
  close(lock);
}

}  // namespace
}  // namespace planbench
