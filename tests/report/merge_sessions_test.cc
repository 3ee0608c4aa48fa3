#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/read_text.h"
#include "messaging/record_log.h"
#include "planning/told_warnings.h"
#include "results/compared_sessions.h"
#include "results/comparison.h"
#include "tests/report/merge_fixture.h"

namespace planbench {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST_F(MergeSessionsTest, MissingShardsAreNamedAndTheSessionIsNotFinished) {
  for (const int shard : {1, 3}) {
    const SessionMessage part = PartOf(shard, 4);
    Write(part.run_id, part, {{.contestant = "A", .problem = shard}});
  }
  ASSERT_EQ(Merge({"part1", "part3"}), kExitOk) << errors_;
  EXPECT_THAT(output_ + errors_, HasSubstr("shards missing: 2/4, 4/4 of shelf 1-4 by planner"));
  const StoredSessions stored = ReadSessions(folder_ / "whole");
  ASSERT_EQ(stored.sessions.size(), 1u);
  EXPECT_FALSE(stored.sessions.front().finished);
}

TEST_F(MergeSessionsTest, ShardsOfDifferentWholesAreNotComplete) {
  Write("one", Planned(Session("one", 1000, 2), Call({1, 2, 3, 4}, {1, 2})),
        {{.contestant = "A", .problem = 1}, {.contestant = "A", .problem = 3}});
  Write("two", Planned(Session("two", 2000, 2), Call({3, 4, 5, 6}, {2, 2})),
        {{.contestant = "A", .problem = 4}, {.contestant = "A", .problem = 6}});
  ASSERT_EQ(Merge({"one", "two"}), kExitOk) << errors_;
  EXPECT_THAT(output_, HasSubstr("shards missing: 2/2 of shelf 1-4 by planner (forward, 1 trial); "
                                 "1/2 of shelf 3-6 by planner (forward, 1 trial)"));
  EXPECT_FALSE(ReadSessions(folder_ / "whole").sessions.front().finished);
}

TEST_F(MergeSessionsTest, OtherVectorInstructionsAreToldOf) {
  for (const int shard : {1, 2}) {
    SessionMessage part = PartOf(shard, 2);
    part.cpu = shard == 1 ? "Old CPU (Q, no T) [SSE4]" : "New CPU [AVX2]";
    Write(part.run_id, part, {{.contestant = "A", .problem = shard}});
  }
  ASSERT_EQ(Merge({"part1", "part2"}), kExitOk) << errors_;
  EXPECT_THAT(output_, HasSubstr("different vector instructions (AVX2, SSE4)"));
}

TEST_F(MergeSessionsTest, ShardsOfAnEarlierVersionMayNotBeAll) {
  for (const int shard : {1, 2}) {
    SessionMessage part = PartOf(shard, 2);
    part.settings.erase(kPlanSetting);
    Write(part.run_id, part, {{.contestant = "A", .problem = shard}});
  }
  ASSERT_EQ(Merge({"part1", "part2"}), kExitOk) << errors_;
  EXPECT_THAT(output_, HasSubstr("shards missing: not known"));
  const StoredSession whole = ReadSessions(folder_ / "whole").sessions.front();
  EXPECT_FALSE(whole.finished);
  EXPECT_FALSE(whole.flags.contains(kPlanSetting));
}

TEST_F(MergeSessionsTest, WhatOnePartLeftOutAndAnotherDidNotIsToBeMade) {
  // Of problem 3 each shard has a trial. The second was killed before it had made any.
  SessionMessage one = Planned(Session("one", 1000, 2), Call({1, 2, 3}, {1, 2}, 2));
  one.left_out["shelf 3"] = "is bad";
  SessionMessage two = Planned(Session("two", 2000, 3), Call({1, 2, 3}, {2, 2}, 2));
  two.finished = false;
  Write("one", one,
        {{.contestant = "A", .problem = 1}, {.contestant = "A", .problem = 2, .trial = 2}});
  Write("two", two, {});
  ASSERT_EQ(MergeTo("both", {"one", "two"}), kExitOk) << errors_;
  ASSERT_EQ(MergeTo("again", {"both", "one"}), kExitOk) << errors_;
  for (const char* whole : {"both", "again"}) {
    const StoredSession session = ReadSessions(folder_ / whole).sessions.front();
    EXPECT_FALSE(session.finished) << whole;
    EXPECT_EQ(session.num_runs, 6) << whole;
    EXPECT_TRUE(session.left_out.empty()) << whole;
  }
  two.left_out = one.left_out;
  two.num_runs = 2;
  Write("none", two, {});
  ASSERT_EQ(MergeTo("neither", {"one", "none"}), kExitOk) << errors_;
  const StoredSession neither = ReadSessions(folder_ / "neither").sessions.front();
  EXPECT_EQ(neither.num_runs, 4) << "but for problem 3";
  EXPECT_EQ(neither.left_out, one.left_out);
}

TEST_F(MergeSessionsTest, WhatIsOddAboutTheProblemsAndPlannersOfAnyPartIsTold) {
  for (const int index : {1, 2}) {
    SessionMessage part = PartOf(index, 2);
    NodeStatusMessage& server = part.nodes.emplace_back();
    server.kind = NodeKind::kSceneServer;
    server.name = "scene_server";
    TellWarnings(kRobotWarning, {"is odd"}, &server.settings);
    TellWarnings(kProblemWarning, {fmt::format("{} is odd", index)}, &server.settings);
    TellWarnings(kPlannerWarning, {fmt::format("{} has moved", index)}, &server.settings);
    Write(fmt::format("part{}", index), part, {{.contestant = "A", .problem = index}});
  }
  ASSERT_EQ(MergeTo("both", {"part1", "part2"}), kExitOk) << errors_;
  EXPECT_EQ(
      ReadSessions(folder_ / "both").sessions.front().warnings,
      (std::vector<std::string>{"is odd", "1 is odd", "2 is odd", "1 has moved", "2 has moved"}));
}

TEST_F(MergeSessionsTest, AWholeAndAPartOfItAreTheWhole) {
  // As when a merged session of one shard goes on without --shard.
  SessionMessage whole = Planned(Session("part1", 1000, 2), Call({1, 2}));
  whole.settings[kPlanSetting] = PlanText({Call({1, 2}, {1, 2}), Call({1, 2})});
  whole.settings["held_parts"] = R"({"part1": {"total_time_s": 1, "bus": ""}})";
  const std::vector<MadeRun> runs = {{.contestant = "A", .problem = 1},
                                     {.contestant = "A", .problem = 2}};
  Write("all", whole, runs);
  Write("part2", PartOf(2, 2), {runs[1]});
  ASSERT_EQ(Merge({"all", "part2"}), kExitOk) << errors_;
  EXPECT_THAT(output_, Not(HasSubstr("missing")));
  const StoredSession merged = ReadSessions(folder_ / "whole").sessions.front();
  EXPECT_TRUE(merged.finished);
  EXPECT_EQ(merged.num_runs, 2);
}

TEST_F(MergeSessionsTest, HalvesOfASessionThatAreTogetherCompleteAreFinished) {
  SessionMessage half = Planned(Session("same", 1000, 2), Call({1, 2}));
  half.finished = false;
  Write("one", half, {{.contestant = "A", .problem = 1}});
  half.total_time_s += 1;
  Write("two", half, {{.contestant = "A", .problem = 2}});
  ASSERT_EQ(Merge({"one", "two"}), kExitOk) << errors_;
  const StoredSession whole = ReadSessions(folder_ / "whole").sessions.front();
  EXPECT_TRUE(whole.finished);
  EXPECT_EQ(whole.num_runs, 2);
  ASSERT_EQ(MergeTo("half", {"one"}), kExitOk) << errors_;
  const StoredSession alone = ReadSessions(folder_ / "half").sessions.front();
  EXPECT_FALSE(alone.finished);
  EXPECT_EQ(alone.num_runs, 2);
}

TEST_F(MergeSessionsTest, AMergedSessionIsAPartLikeAnyOther) {
  for (const int shard : {1, 2, 3}) {
    SessionMessage part = PartOf(shard, 3);
    part.host = fmt::format("host{}", shard);
    Write(part.run_id, part, {{.contestant = "A", .problem = shard}});
  }
  ASSERT_EQ(MergeTo("of12", {"part1", "part2"}), kExitOk) << errors_;
  EXPECT_THAT(output_, HasSubstr("shards missing: 3/3"));
  ASSERT_EQ(MergeTo("of13", {"part3", "part1"}), kExitOk) << errors_;
  int number = 0;
  for (const std::vector<std::string>& folders : std::vector<std::vector<std::string>>{
           {"of12", "part3"}, {"part3", "of12"}, {"of12", "of13"}, {"part1", "of12", "of13"}}) {
    const std::string whole = fmt::format("whole{}", ++number);
    SCOPED_TRACE(whole);
    ASSERT_EQ(MergeTo(whole, folders), kExitOk) << errors_;
    EXPECT_THAT(output_, Not(HasSubstr("missing")));
    const StoredSession session = ReadSessions(folder_ / whole).sessions.front();
    EXPECT_TRUE(session.finished);
    EXPECT_EQ(session.runs.size(), 3u);
    EXPECT_EQ(session.num_runs, 3);
    EXPECT_EQ(ReadPlan(session.flags)->size(), 3u);
    const std::string& commands = session.flags.at("merged");
    for (const int shard : {1, 2, 3}) {
      EXPECT_THAT(session.host, HasSubstr(fmt::format("host{}", shard)));
      const std::string flag = fmt::format("--shard {}/3", shard);
      EXPECT_THAT(commands, HasSubstr(flag));
      EXPECT_EQ(commands.find(flag), commands.rfind(flag)) << commands;
    }
  }
  // Complete, merged once more.
  ASSERT_EQ(MergeTo("again", {"whole1", "part2"}), kExitOk) << errors_;
  EXPECT_THAT(output_, Not(HasSubstr("missing")));
  EXPECT_TRUE(ReadSessions(folder_ / "again").sessions.front().finished);
}

TEST_F(MergeSessionsTest, TheMergedSessionHasThePlanOfItsParts) {
  const PlannedCall call = Call({1, 2});
  PlannedCall others = call;
  others.planners = {{"rrtc", Directions::kBoth, 1}};
  const SessionMessage one = Planned(Session("one", 1000, 2), call);
  const SessionMessage two = Planned(Session("two", 2000, 4), others);
  Write("one", one, {{.contestant = "A", .problem = 1}, {.contestant = "A", .problem = 2}});
  Write("two", two, {});
  ASSERT_EQ(Merge({"one", "two", "one"}), kExitOk) << errors_;
  const StoredSession whole = ReadSessions(folder_ / "whole").sessions.front();
  EXPECT_EQ(ReadPlan(whole.flags), (SessionPlan{call, others}));
  EXPECT_EQ(whole.num_runs, 6);
  EXPECT_FALSE(whole.finished) << "whatever its parts say, four are not recorded";
}

TEST_F(MergeSessionsTest, DirectionsOfAPlannerAreAConditionOfParts) {
  Write("one", Planned(Session("one", 1000, 1), Call({1})), {{.contestant = "A", .problem = 1}});
  Write("two", Planned(Session("two", 2000, 1), Call({2}, {}, 1, Directions::kBoth)),
        {{.contestant = "A", .problem = 2}});
  ExpectRefused({"one", "two"}, "contestant[planner].directions is forward in ");
  SessionMessage broken = Session("broken", 3000, 1);
  broken.settings[kPlanSetting] = "{";
  Write("broken", broken, {});
  ExpectRefused({"one", "broken"}, "broken: the setting plan");
}

TEST_F(MergeSessionsTest, HowManyProblemsAProcessHadIsAConditionOfParts) {
  int number = 0;
  for (const char* problems : {"10", "10", "1", ""}) {
    ++number;
    SessionMessage part = Session(fmt::format("part{}", number), 1000 * number, 1);
    part.settings["problems-per-process"] = problems;
    Write(part.run_id, part, {{.contestant = "A", .problem = number}});
  }
  ExpectRefused({"part1", "part3"}, "setting[problems-per-process].value is \"10\" in ");
  ExpectRefused({"part1", "part4"}, "setting[problems-per-process].value is \"10\" in ");
  EXPECT_EQ(Merge({"part1", "part2"}), kExitOk) << errors_;
}

TEST_F(MergeSessionsTest, WhatTheFirstPartLacksIsComparedToo) {
  for (const int number : {1, 2, 3}) {
    SessionMessage part = Session(fmt::format("part{}", number), 1000 * number, 1);
    part.conditions.problem_sets["shelf"] = fmt::format("content{}", number);
    if (number == 1) part.conditions.problem_sets.erase("shelf");
    Write(part.run_id, part, {{.contestant = "A", .problem = number}});
  }
  ExpectRefused({"part1", "part2", "part3"}, "\"content2\" in ");
}

TEST_F(MergeSessionsTest, WhatOfALogCannotBeDecodedIsToldOf) {
  SessionMessage session = Session("part1", 1000, 1);
  Write("part1", session, {{.contestant = "A", .problem = 1}});
  session.total_time_s = -1;
  EventLog(FindEventLog(folder_ / "part1"), EventLog::Mode::kAppend)
      .Write({channel::kSession, Encode(session), 3});
  ASSERT_EQ(Merge({"part1"}), kExitOk) << errors_;
  EXPECT_THAT(output_,
              HasSubstr("part1.lcmlog: one message is passed over: SESSION: total_time_s"));
  EXPECT_TRUE(ReadSessions(folder_ / "whole").sessions.front().finished);
}

TEST_F(MergeSessionsTest, AnUnfinishedPartIsNotFinishedByMergingAgain) {
  SessionMessage part = Session("part1", 1000, 2);
  part.settings["shard"] = "1/2";
  part.finished = false;
  Write("part1", part, {{.contestant = "A", .problem = 1}});
  SessionMessage other = Session("part2", 2000, 1);
  other.settings["shard"] = "2/2";
  Write("part2", other, {{.contestant = "A", .problem = 2}});
  ASSERT_EQ(MergeTo("of1", {"part1"}), kExitOk) << errors_;
  ASSERT_EQ(Merge({"of1", "part2"}), kExitOk) << errors_;
  const StoredSession whole = ReadSessions(folder_ / "whole").sessions.front();
  EXPECT_FALSE(whole.finished);
  EXPECT_EQ(whole.num_runs, 3);
}

TEST_F(MergeSessionsTest, WhatWasLostOnTheBusIsAddedUp) {
  Write("one", Session("early", 1000, 1), {{.contestant = "A", .problem = 1}});
  Write("two", Session("later", 2000, 1), {{.contestant = "A", .problem = 2}});
  Write("three", Session("last", 3000, 1), {{.contestant = "A", .problem = 3}});
  folder_.Write("one/run.json",
                R"({"bus": {"malformed_packets": 1, "lost_messages": 20, "dropped_messages": 3,
                "contradictions": [{"sender": "a", "channel": "C", "count": 2, "first": "x"}]}})");
  folder_.Write("two/run.json",
                R"({"bus": {"malformed_packets": 0, "lost_messages": 5, "dropped_messages": 0,
                "contradictions": [{"sender": "b", "channel": "C", "count": 1, "first": "y"}]}})");
  ASSERT_EQ(MergeTo("of12", {"one", "two"}), kExitOk) << errors_;
  EXPECT_THAT(output_, Not(HasSubstr("not known")));
  ASSERT_EQ(Merge({"of12", "three"}), kExitOk) << errors_;
  EXPECT_THAT(output_, HasSubstr("lost on the bus is not known: " + (folder_ / "three").string()));
  const std::optional<BusRecord> bus = ReadSessions(folder_ / "whole").sessions.front().bus;
  ASSERT_TRUE(bus);
  EXPECT_EQ(bus->malformed, 1);
  EXPECT_EQ(bus->lost, 25);
  EXPECT_EQ(bus->dropped, 3);
  EXPECT_EQ(bus->contradictions, 3);
  folder_.Write("two/run.json", R"({"bus": {"lost_messages": "many"}})");
  EXPECT_EQ(MergeTo("none", {"one", "two"}), kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("two/run.json"));
}

TEST_F(MergeSessionsTest, ThatNothingWasLostOnTheBusIsToldIfAllPartsTellIt) {
  Write("one", Session("early", 1000, 1), {{.contestant = "A", .problem = 1}});
  Write("two", Session("later", 2000, 1), {{.contestant = "A", .problem = 2}});
  folder_.Write("one/run.json", "{}");
  ASSERT_EQ(MergeTo("half", {"one", "two"}), kExitOk) << errors_;
  EXPECT_THAT(output_, HasSubstr("lost on the bus is not known: " + (folder_ / "two").string()));
  EXPECT_FALSE(ReadSessions(folder_ / "half").sessions.front().bus);
  folder_.Write("two/run.json", "{}");
  ASSERT_EQ(MergeTo("all", {"two", "half", "one"}), kExitOk) << errors_;
  const std::optional<BusRecord> bus = ReadSessions(folder_ / "all").sessions.front().bus;
  ASSERT_TRUE(bus);
  EXPECT_EQ(bus->lost, 0);
}

TEST_F(MergeSessionsTest, PartsThatDoNotTellOfTheBusCountOnce) {
  for (const int number : {1, 2, 3}) {
    Write(fmt::format("part{}", number),
          Session(fmt::format("part{}", number), std::int64_t{1000} * number, 1),
          {{.contestant = "A", .problem = number}});
  }
  folder_.Write("part3/run.json", R"({"bus": {"logs_not_told_of": 0}})");
  ASSERT_EQ(MergeTo("untold", {"part1", "part2"}), kExitOk) << errors_;
  SessionMessage resumed = ReadRecords(FindEventLog(folder_ / "untold")).sessions.front();
  resumed.settings.erase("merged_parts");
  resumed.total_time_s += 7;
  EventLog(FindEventLog(folder_ / "untold"), EventLog::Mode::kAppend)
      .Write({channel::kSession, Encode(resumed), 3});
  const auto untold = [&](const std::string& whole, int lost) {
    std::string bus = R"({"bus": {"logs_not_told_of": 2)";
    if (lost > 0) bus += fmt::format(R"(, "lost_messages": {})", lost);
    folder_.Write("untold/run.json", bus + "}}");
    EXPECT_EQ(MergeTo(whole, {"untold", "part3"}), kExitOk) << errors_;
    return nlohmann::json::parse(ReadText(folder_ / whole / "run.json")).at("bus").dump();
  };
  EXPECT_EQ(untold("none", 0), R"({"logs_not_told_of":2})");
  EXPECT_THAT(output_, HasSubstr("not known: " + (folder_ / "untold").string()));
  EXPECT_THAT(output_, Not(HasSubstr((folder_ / "part3").string())));
  EXPECT_EQ(untold("some", 4), R"({"logs_not_told_of":2,"lost_messages":4})");
  for (const int number : {1, 2}) {
    folder_.Write(fmt::format("part{}/run.json", number), "{}");
  }
  ASSERT_EQ(Merge({"part1", "part2", "untold"}), kExitOk) << errors_;
  EXPECT_EQ(ReadSessions(folder_ / "whole").sessions.front().bus->lost, 4);
}

TEST_F(MergeSessionsTest, WhatAPartTookAndLostCountsOnce) {
  for (const int shard : {1, 2, 3}) {
    SessionMessage part = Session(fmt::format("part{}", shard), std::int64_t{1000} * shard, 1);
    part.settings["shard"] = fmt::format("{}/3", shard);
    part.total_time_s = 0.1 * shard;
    Write(part.run_id, part, {{.contestant = "A", .problem = shard}});
    folder_.Write(
        part.run_id + "/run.json",
        fmt::format(R"({{"bus": {{"malformed_packets": 0, "lost_messages": {}, "contradictions":
                              [{{"sender": "s", "channel": "C", "count": {}, "first": "x"}}]}}}})",
                    shard == 1 ? 5 : 10 * shard, shard));
  }
  ASSERT_EQ(MergeTo("of12", {"part1", "part2"}), kExitOk) << errors_;
  ASSERT_EQ(MergeTo("of13", {"part3", "part1"}), kExitOk) << errors_;
  ASSERT_EQ(MergeTo("of123", {"of12", "of13"}), kExitOk) << errors_;
  const auto expect_told = [&](const std::string& whole, double total_time_s, int lost,
                               int contradictions) {
    SCOPED_TRACE(whole);
    const StoredSession session = ReadSessions(folder_ / whole).sessions.front();
    EXPECT_NEAR(session.total_time_s, total_time_s, 1e-9);
    EXPECT_EQ(session.bus->lost, lost);
    EXPECT_EQ(session.bus->contradictions, contradictions);
  };
  expect_told("of12", 0.3, 25, 3);
  expect_told("of123", 0.6, 55, 6);
  int number = 0;
  for (const std::vector<std::string>& folders :
       std::vector<std::vector<std::string>>{{"part1", "part2", "part3", "part1"},
                                             {"of12", "part2", "part3"},
                                             {"part1", "of12", "of13"},
                                             {"of123", "part1", "of13", "of123"}}) {
    const std::string whole = fmt::format("whole{}", ++number);
    ASSERT_EQ(MergeTo(whole, folders), kExitOk) << errors_;
    expect_told(whole, 0.6, 55, 6);
  }

  // A merged session that went on has that beside its parts.
  SessionMessage resumed = ReadRecords(FindEventLog(folder_ / "of12")).sessions.front();
  resumed.settings.erase("merged");
  resumed.settings.erase("merged_parts");
  resumed.total_time_s += 7;
  EventLog(FindEventLog(folder_ / "of12"), EventLog::Mode::kAppend)
      .Write({channel::kSession, Encode(resumed), 3});
  folder_.Write("of12/run.json",
                R"({"bus": {"malformed_packets": 0, "lost_messages": 26, "contradictions": [
                {"sender": "s", "channel": "C", "count": 1, "first": "x"},
                {"sender": "s", "channel": "C", "count": 2, "first": "x"},
                {"sender": "s", "channel": "C", "count": 50, "first": "x"}]}})");
  ASSERT_EQ(MergeTo("on", {"part2", "of12", "of123"}), kExitOk) << errors_;
  expect_told("on", 7.6, 56, 56);
  ASSERT_EQ(MergeTo("again", {"of12", "on", "of12"}), kExitOk) << errors_;
  expect_told("again", 7.6, 56, 56);
}

TEST_F(MergeSessionsTest, RunsThatOnlyTheDatabaseHoldsAreNotLost) {
  for (const int shard : {1, 2}) {
    SessionMessage part = Session(fmt::format("part{}", shard), std::int64_t{1000} * shard, 2);
    Write(part.run_id, part,
          {{.contestant = "A", .problem = shard}, {.contestant = "B", .problem = shard}});
  }
  ASSERT_EQ(MergeTo("of1", {"part1"}), kExitOk) << errors_;
  ASSERT_EQ(MergeTo("of12", {"of1", "part2"}), kExitOk) << errors_;
  const auto log = FindEventLog(folder_ / "of1");
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 5);
  ExpectRefused({"of1", "part2"}, (folder_ / "of1").string() +
                                      ": its results.sqlite holds what of1.lcmlog lacks and what "
                                      "would be lost: 1 run, part1/B/1");
  // What is no database cannot be compared.
  folder_.Write("of1/results.sqlite", "damaged");
  ASSERT_EQ(Merge({"of1", "part2"}), kExitOk) << errors_;
  EXPECT_THAT(output_, HasSubstr("not compared with the event log: "));
  EXPECT_THAT(output_, HasSubstr("of1.lcmlog: "));
  EXPECT_THAT(output_, HasSubstr("after the last whole event are not read"));
  EXPECT_EQ(ReadSessions(folder_ / "whole").sessions.front().runs.size(), 3u);
}

TEST_F(MergeSessionsTest, OtherFilesBesideTheMergedSessionStay) {
  Write("one", Session("early", 1000, 1), {{.contestant = "A"}});
  folder_.Write("whole.merging", "somebody's");
  ASSERT_EQ(Merge({"one"}), kExitOk) << errors_;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "whole.merging"));
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path().string().find("merging-"), std::string::npos) << entry.path();
  }
}

TEST_F(MergeSessionsTest, PartsMakeTheSessionThatTheyAreOf) {
  const std::vector<MadeRun> first = {{.contestant = "A", .problem = 1, .time_s = 1},
                                      {.contestant = "A", .problem = 2, .time_s = 2}};
  const std::vector<MadeRun> second = {
      {.contestant = "A", .problem = 3, .status = PlanStatus::kTimedOut, .time_s = 10},
      {.contestant = "B", .problem = 1, .time_s = 4}};
  SessionMessage later = Session("later", 2'000'000, 5);  // one was never recorded
  later.host = "another";
  later.settings["problems-range"] = "3-5";
  Write("one", Session("early", 1'000'000, 2), first);
  Write("two", later, second);
  ASSERT_EQ(Merge({"two", "one"}), kExitOk) << errors_;
  EXPECT_THAT(output_, HasSubstr("4 runs of 2 sessions, 0 of them"));

  const StoredSessions stored = ReadSessions(folder_ / "whole");
  ASSERT_EQ(stored.sessions.size(), 1u);
  const StoredSession& whole = stored.sessions.front();
  EXPECT_EQ(whole.run_id, "early");
  EXPECT_TRUE(whole.finished);
  EXPECT_EQ(whole.total_time_s, 20);
  EXPECT_EQ(whole.num_runs, 7);  // 2 and 5
  EXPECT_EQ(whole.host, "host, another");
  EXPECT_EQ(whole.flags.at("merged"),
            "benchmark_driver --launch --time 10 --trials 2 && "
            "benchmark_driver --launch --problems-range 3-5 --time 10 --trials 2");

  // As if all had been one session.
  std::vector<MadeRun> all = first;
  all.insert(all.end(), second.begin(), second.end());
  WriteSession(folder_ / "oracle", all);
  const ComparedSessions merged(stored.sessions);
  const ComparedSessions oracle(ReadSessions(folder_ / "oracle").sessions);
  for (const char* contestant : {"A", "B"}) {
    EXPECT_EQ(SummarizeSuccess(merged.pooled().at(contestant)).share,
              SummarizeSuccess(oracle.pooled().at(contestant)).share);
    EXPECT_EQ(SummarizeTimes(merged.pooled().at(contestant)).penalised_mean_s,
              SummarizeTimes(oracle.pooled().at(contestant)).penalised_mean_s);
  }

  // What goes on with a session, or shows it, reads the log.
  const auto log = FindEventLog(folder_ / "whole");
  const RecordedSession recorded = ReadRecords(log);
  ASSERT_EQ(recorded.sessions.size(), 1u);
  ASSERT_EQ(recorded.runs.size(), 4u);
  for (const RecordedRun& recorded_run : recorded.runs) {
    const RunRecordMessage run = ReadRecord(recorded_run.place);
    EXPECT_EQ(run.run_id, "early");
    EXPECT_TRUE(run.request_id.starts_with("early/")) << run.request_id;
    EXPECT_EQ(run.request.request_id, run.request_id);
  }
  std::vector<std::string> passed_over;
  EXPECT_EQ(ReadScenes(log, &passed_over).size(), 1u);
}

TEST_F(MergeSessionsTest, ScenesThatCannotBeDecodedArePassedOver) {
  Write("one", Session("one", 1'000'000, 1), {{.contestant = "A", .problem = 1}});
  Write("two", Session("two", 2'000'000, 1), {{.contestant = "A", .problem = 2}});
  EventLog(folder_ / "two/two.lcmlog", EventLog::Mode::kAppend).Write({channel::kScene, {1, 2}, 3});
  ASSERT_EQ(Merge({"one", "two"}), kExitOk) << errors_;
  EXPECT_THAT(output_, HasSubstr("two.lcmlog: one message is passed over: SCENE"));
  std::vector<std::string> passed_over;
  EXPECT_EQ(ReadScenes(FindEventLog(folder_ / "whole"), &passed_over).size(), 1u);
  EXPECT_TRUE(passed_over.empty());
}

TEST_F(MergeSessionsTest, ARunThatTwoTellOfCountsOnce) {
  const MadeRun run = {.contestant = "A", .problem = 1};
  Write("one", Session("same", 1'000'000, 2), {run});
  SessionMessage resumed = Session("same", 2'000'000, 2);
  Write("two", resumed, {run, {.contestant = "A", .problem = 2}});
  ASSERT_EQ(Merge({"one", "two"}), kExitOk) << errors_;
  EXPECT_THAT(output_, HasSubstr("2 runs of 1 session, 1 of them"));
  const StoredSession whole = ReadSessions(folder_ / "whole").sessions.front();
  EXPECT_EQ(whole.runs.size(), 2u);
  EXPECT_EQ(whole.num_runs, 2);
}

TEST_F(MergeSessionsTest, ARunThatWasNotAskedGivesWayToOneThatWas) {
  const MadeRun made = {.contestant = "A", .problem = 1};
  MadeRun not_asked = made;
  not_asked.status = PlanStatus::kNoAnswer;
  not_asked.asked = false;
  Write("one", Session("same", 1'000'000, 1), {not_asked});
  Write("two", Session("same", 2'000'000, 1), {made});
  int number = 0;
  for (const std::vector<std::string>& folders :
       std::vector<std::vector<std::string>>{{"one", "two"}, {"two", "one"}}) {
    const std::string whole = fmt::format("whole{}", ++number);
    ASSERT_EQ(MergeTo(whole, folders), kExitOk) << errors_;
    const StoredSession session = ReadSessions(folder_ / whole).sessions.front();
    ASSERT_EQ(session.runs.size(), 1u);
    EXPECT_TRUE(session.runs.front().confirmed());
  }
  ASSERT_EQ(MergeTo("alone", {"one"}), kExitOk) << errors_;
  EXPECT_FALSE(ReadSessions(folder_ / "alone").sessions.front().finished) << "it is to be made";
}

TEST_F(MergeSessionsTest, WithoutAReportThereIsNoMergedSession) {
  Write("one", Session("early", 1'000'000, 1), {{.contestant = "A"}});
  const std::string header = "problem_set,problem_index,solved,time_s\n";
  const std::vector<std::string> flags = {"--import", (folder_ / "own.csv").string(), "--as", "D"};
  folder_.Write("own.csv", header + "shelf,1,1,-1\n");
  EXPECT_EQ(MergeTo("whole", {"one"}, flags), kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("own.csv:2: time_s"));
  EXPECT_THAT(output_, Not(HasSubstr("runs of")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "whole"));
  // An empty folder stays one.
  std::filesystem::create_directory(folder_ / "whole");
  EXPECT_EQ(MergeTo("whole", {"one"}, flags), kExitBadInput);
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "whole"));
  folder_.Write("own.csv", header + "shelf,1,1,1\n");
  EXPECT_EQ(MergeTo("whole", {"one"}, flags), kExitOk) << errors_;
  EXPECT_EQ(ReadSessions(folder_ / "whole").sessions.front().runs.size(), 1u);
}

TEST_F(MergeSessionsTest, WhatIsNoPartOfOneSessionIsRefused) {
  Write("one", Session("early", 1'000'000, 1), {{.contestant = "A"}});
  Write("again", Session("later", 2'000'000, 1), {{.contestant = "A", .time_s = 2}});
  SessionMessage other = Session("other", 3'000'000, 1);
  other.conditions.request.seed = 8;
  Write("seed", other, {{.contestant = "B"}});
  std::filesystem::create_directory(folder_ / "empty");
  ExpectRefused({"one", "again"}, "tell differently of A, shelf 1, forward, trial 1");
  ExpectRefused({"one", "seed"}, "conditions.request.seed is 7 in ");
  ExpectRefused({"one", "empty"}, "holds no .lcmlog");
  folder_.Write("file", "");
  EXPECT_EQ(MergeTo("file/whole", {"one"}), kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("--merge: cannot make a folder " + (folder_ / "file").string()));
}

}  // namespace
}  // namespace planbench
