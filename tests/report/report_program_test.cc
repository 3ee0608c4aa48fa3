#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <iterator>
#include <map>
#include <utility>

#include "common/exit_codes.h"
#include "common/read_text.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/event_log.h"
#include "tests/report/example_session.h"
#include "tests/support/child_process.h"
#include "tests/support/planar_session.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using testing::HasSubstr;

class ReportProgramTest : public testing::Test {
 protected:
  int Run(std::vector<std::string> arguments, const std::string& program = "report") {
    arguments.insert(arguments.begin(), std::string(PLANBENCH_BIN_DIR) + "/" + program);
    ChildProcess process(arguments, folder_ / program);
    const int code = process.Wait().value_or(-1);
    errors_ = process.Errors();
    return code;
  }
  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  TemporaryFolder folder_;
  std::string errors_;
};

TEST_F(ReportProgramTest, WritesThePageAndTheTables) {
  WriteSession(folder_ / "example", ExampleRuns(), ExampleSession());
  ASSERT_EQ(Run({Path("example"), "--out", Path("page.html"), "--csv", Path("csv"), "--latex",
                 Path("latex")}),
            kExitOk)
      << errors_;
  const std::string page = ReadText(folder_ / "page.html");
  EXPECT_THAT(page, HasSubstr("\"made_by\":\"planbench "));
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(page.find(kTagName), std::string::npos);
  for (const char* table :
       {"sessions", "success", "times", "pairs", "quality", "phases", "failures", "conditions"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "csv" / (std::string(table) + ".csv"))) << table;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "latex" / (std::string(table) + ".tex")))
        << table;
  }
  EXPECT_THAT(ReadText(folder_ / "csv" / "success.csv"), HasSubstr(",12,24,24,24,100,"));
}

TEST_F(ReportProgramTest, ViewTakesCollisionModelsByName) {
  EXPECT_EQ(Run({"--problems", "set/1", "--robot", "r", "--collision-model", "3"}, "view"),
            kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("--collision-model: 3 is not spheres, voxels, meshes or "));
}

TEST_F(ReportProgramTest, AnEventLogThatLacksAFileIsNamed) {
  WriteSession(folder_ / "example", ExampleRuns(), ExampleSession());
  {
    EventLog log(folder_ / "example" / "example.lcmlog", EventLog::Mode::kNew, 1);
    for (int i = 0; i < 3; ++i) {
      log.Write({channel::kSession, Encode(ExampleSession()), i});
    }
  }
  std::filesystem::remove(folder_ / "example" / "example.lcmlog.01");
  ASSERT_EQ(Run({Path("example"), "--out", Path("page.html")}), kExitOk);
  EXPECT_THAT(errors_, HasSubstr("no 3D views: "));
  EXPECT_THAT(errors_, HasSubstr("example.lcmlog.01 is missing"));
  EXPECT_THAT(ReadText(folder_ / "page.html"), HasSubstr("example.lcmlog.01 is missing"));
}

TEST_F(ReportProgramTest, TablesOfAnEarlierReportAreReplaced) {
  SessionMessage later;
  later.start_utime = 60'000'000;
  WriteSession(folder_ / "old",
               {{.contestant = "A"},
                {.contestant = "A", .direction = Direction::kBackward},
                {.contestant = "B", .status = PlanStatus::kTimedOut}},
               later);
  WriteSession(folder_ / "older", {{.contestant = "A"}});
  WriteSession(folder_ / "new", {{.contestant = "A"}});
  const auto write = [&](std::vector<std::string> sessions) {
    for (const char* more : {"--out", "page.html", "--csv", "csv", "--latex", "latex"}) {
      sessions.push_back(*more == '-' ? more : Path(more));
    }
    EXPECT_EQ(Run(sessions), kExitOk) << errors_;
  };
  write({Path("old"), Path("older")});
  const std::vector<std::string> others = {"csv/mine.csv", "csv/pairs.tex", "csv/pairs.csv.bak",
                                           "latex/paper.tex", "latex/pairs/text"};
  for (const std::string& file : others) folder_.Write(file, "");
  const std::vector<std::string> gone = {"changes", "directions", "pairs", "failures"};
  for (const std::string& table : gone) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / ("csv/" + table + ".csv"))) << table;
    EXPECT_TRUE(std::filesystem::exists(folder_ / ("latex/" + table + ".tex"))) << table;
  }
  write({Path("new")});
  for (const std::string& table : gone) {
    EXPECT_FALSE(std::filesystem::exists(folder_ / ("csv/" + table + ".csv"))) << table;
    EXPECT_FALSE(std::filesystem::exists(folder_ / ("latex/" + table + ".tex"))) << table;
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "csv/times.csv"));
  for (const std::string& file : others) EXPECT_TRUE(std::filesystem::exists(folder_ / file));
}

TEST_F(ReportProgramTest, AnEarlierReportStaysWhereThereIsNoRoomForANewOne) {
  WriteSession(folder_ / "example", {{.contestant = "A"},
                                     {.contestant = "A",
                                      .problem = 2,
                                      .status = PlanStatus::kTimedOut,
                                      .reason = std::string(200'000, 'x')}});
  folder_.Write("page.html", "the page before");
  folder_.Write("csv/success.csv", "the table before");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);  // in the process that is started, too
  rlimit full = before;
  full.rlim_cur = 100'000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  const auto expect_no_room = [&](const std::vector<std::string>& more, const char* reason) {
    std::vector<std::string> arguments = {Path("example"), "--out", Path("page.html")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(Run(arguments), kExitBadInput);
    EXPECT_THAT(errors_, HasSubstr(reason));
  };
  expect_no_room({}, "page.html: File too large");
  expect_no_room({"--csv", Path("csv")}, "failures.csv: File too large");
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(ReadText(folder_ / "page.html"), "the page before");
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    EXPECT_NE(entry.path().extension(), ".part");
  }
  EXPECT_EQ(ReadText(folder_ / "csv/success.csv"), "the table before");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "csv"), {}), 1);
}

TEST_F(ReportProgramTest, TablesThatCannotBePutInTheirPlaceCostNoEarlierOne) {
  WriteSession(folder_ / "example", {{.contestant = "A"}});
  folder_.Write("csv/changes.csv", "a table that the new report does not have");
  folder_.Write("csv/times.csv/a folder's file", "");
  EXPECT_EQ(Run({Path("example"), "--out", Path("page.html"), "--csv", Path("csv")}),
            kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("cannot write " + Path("csv/times.csv")));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "csv/changes.csv"));
}

TEST_F(ReportProgramTest, BadInputEndsWithOneLine) {
  folder_.Write("empty/results.sqlite", "");
  WriteSession(folder_ / "example", {{.contestant = "A"}});
  const auto expect_refused = [&](const std::vector<std::string>& arguments, const char* reason) {
    EXPECT_EQ(Run(arguments), kExitBadInput);
    EXPECT_THAT(errors_, HasSubstr(reason));
    EXPECT_EQ(std::count(errors_.begin(), errors_.end(), '\n'), 1) << errors_;
  };
  expect_refused({}, "session is required");
  expect_refused({Path("nowhere")}, "does not exist");
  expect_refused({Path("empty")}, "is no results database");
  expect_refused({Path("example"), "--out", Path("no/such/folder/page.html")},
                 "page.html: No such file or directory");
  expect_refused({Path("example"), "--csv", Path("empty/results.sqlite")}, "results.sqlite");
  expect_refused({Path("example"), "--csv", Path("csv"), "--package-path", "hands"}, "NAME=DIR");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "csv")) << "written before all flags were read";
}

TEST_F(ReportProgramTest, ASessionIsNotComparedWithItself) {
  WriteSession(folder_ / "example", {{.contestant = "A"}});
  std::filesystem::copy(folder_ / "example", folder_ / "copy");
  for (const char* again : {"example", "copy"}) {
    EXPECT_EQ(Run({Path("example"), Path(again), "--out", Path("page.html")}), kExitBadInput);
    EXPECT_THAT(errors_, HasSubstr(Path(again) + " hold the same session, example, which"));
    EXPECT_EQ(std::count(errors_.begin(), errors_.end(), '\n'), 1) << errors_;
  }
  // Nor with one that was merged of it and of an earlier one, by whose run id it goes.
  SessionMessage merged;
  merged.run_id = "early";
  merged.settings["merged_parts"] = R"({"early": {"total_time_s": 1, "bus": ""}, )"
                                    R"("example": {"total_time_s": 2, "bus": ""}})";
  WriteSession(folder_ / "merged", {{.contestant = "A"}}, merged);
  EXPECT_EQ(Run({Path("merged"), "--out", Path("page.html")}), kExitOk) << errors_;
  for (const auto& [first, second] : std::map<std::string, std::string>{
           {Path("example"), Path("merged")}, {Path("merged"), Path("example")}}) {
    EXPECT_EQ(Run({first, second, "--out", Path("page.html")}), kExitBadInput);
    EXPECT_THAT(errors_, HasSubstr(first + " and " + second + " hold the same session, example,"));
  }
  // Or that went on after it had been merged.
  merged.settings["held_parts"] = std::exchange(merged.settings["merged_parts"], "{}");
  WriteSession(folder_ / "resumed", {{.contestant = "A"}}, merged);
  EXPECT_EQ(Run({Path("example"), Path("resumed"), "--out", Path("page.html")}), kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr(" hold the same session, example,"));
  merged.settings["merged_parts"] = "both";
  WriteSession(folder_ / "odd", {{.contestant = "A"}}, merged);
  EXPECT_EQ(Run({Path("odd"), "--out", Path("page.html")}), kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("odd/results.sqlite: the setting merged_parts is none"));
  EXPECT_EQ(std::count(errors_.begin(), errors_.end(), '\n'), 1) << errors_;
}

TEST_F(ReportProgramTest, ResultsFromElsewhereStandBesideTheSessions) {
  WriteSession(folder_ / "example", {{.contestant = "A"}, {.contestant = "A", .problem = 2}});
  folder_.Write("other.csv", "problem_set,problem_index,solved,time_s\nshelf,1,1,4\nshelf,9,1,4\n");
  ASSERT_EQ(Run({Path("example"), "--import", Path("other.csv"), "--as", "elsewhere", "--out",
                 Path("page.html"), "--csv", Path("csv"), "--ompl-log", Path("all.log")}),
            kExitOk)
      << errors_;
  // Of the problems, the common one alone.
  EXPECT_THAT(errors_, HasSubstr("other.csv:3: problem 9 of 'shelf' is none of the session's; "));
  const std::string times = ReadText(folder_ / "csv" / "times.csv");
  EXPECT_THAT(times, HasSubstr("\nshelf,elsewhere,1,4000,"));
  EXPECT_THAT(times, HasSubstr("\nshelf,A,2,1000,"));
  EXPECT_THAT(ReadText(folder_ / "page.html"), HasSubstr("1 runs from elsewhere"));
  EXPECT_THAT(ReadText(folder_ / "all-1-shelf.log"), HasSubstr("Experiment shelf\n"));
  EXPECT_THAT(ReadText(folder_ / "all-2-shelf.log"), HasSubstr("\nelsewhere\n"));
  // Alone; and what cannot be.
  EXPECT_EQ(Run({"--import", Path("all-1-shelf.log"), "--as", "B", "--out", Path("page.html")}),
            kExitOk);
  EXPECT_EQ(Run({Path("example"), "--import", Path("other.csv")}), kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("needs its --as NAME"));
  EXPECT_EQ(Run({Path("example"), "--import", Path("other.csv"), "--as", ""}), kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("--as: the text given is empty"));
  folder_.Write("none.csv", "problem_set,problem_index,solved,time_s\nbox,1,1,4\n");
  EXPECT_EQ(Run({Path("example"), "--import", Path("none.csv"), "--as", "x"}), kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("sets here: box; there: shelf"));
}

TEST_F(ReportProgramTest, FilesImportedUnderOneNameAreOneRow) {
  WriteSession(folder_ / "example", {{.contestant = "A"}, {.contestant = "A", .problem = 2}});
  const std::string header = "problem_set,problem_index,solved,time_s\n";
  folder_.Write("one.csv", header + "shelf,1,1,4\n");
  folder_.Write("two.csv", header + "shelf,2,1,40\n");
  ASSERT_EQ(Run({Path("example"), "--import", Path("one.csv"), "--as", "Y", "--import",
                 Path("two.csv"), "--as", "Y", "--out", Path("page.html"), "--csv", Path("csv")}),
            kExitOk);
  EXPECT_THAT(ReadText(folder_ / "csv" / "success.csv"), HasSubstr("\nshelf,Y,2,2,2,1,"));
  EXPECT_THAT(errors_, HasSubstr("two.csv: 1 solved run took longer than its time limit"));
  EXPECT_THAT(ReadText(folder_ / "page.html"), HasSubstr("one.csv, two.csv: 2 runs"));
  EXPECT_EQ(Run({Path("example"), "--import", Path("one.csv"), "--as", "A"}), kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("one.csv: a contestant is called 'A', too"));
  EXPECT_EQ(Run({Path("example"), "--import", Path("one.csv"), "--as", "Y", "--import",
                 Path("one.csv"), "--as", "Y"}),
            kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("from another file"));
}

TEST_F(ReportProgramTest, FiguresAreWrittenForEverySet) {
  if (std::system("command -v node >/dev/null") != 0) {
    GTEST_SKIP() << "no node here: apt-get install nodejs";
  }
  WriteSession(folder_ / "example", ExampleRuns(), ExampleSession());
  // Of an earlier report on other sets, and what is none of a report's.
  for (const char* file : {"success-old_set.svg", "bound-old-2.pdf", "path_length-old_set.pdf"}) {
    folder_.Write("figures/" + std::string(file), "");
  }
  const std::vector<std::string> others = {"success.svg", "success-old set.svg", "draft-shelf.svg",
                                           "times-old.txt", "figures.js"};
  for (const std::string& file : others) folder_.Write("figures/" + file, "mine");
  ASSERT_EQ(Run({Path("example"), "--out", Path("page.html"), "--figures", Path("figures")}),
            kExitOk)
      << errors_;
  for (const std::string& file : others) {
    EXPECT_EQ(ReadText(folder_ / "figures" / file), "mine") << file;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "figures" / "draft-shelf.pdf"));
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "figures")) {
    EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr("old_set")));
    EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr("bound-old")));
  }
  // Names of sets become names of files.
  for (const char* figure : {"success-shelf", "times-a_i_set_i_", "survival-all_sets",
                             "profile-all_sets", "phases-shelf", "path_length-shelf"}) {
    const std::string svg = ReadText(folder_ / "figures" / (std::string(figure) + ".svg"));
    EXPECT_TRUE(svg.starts_with("<svg")) << figure;
    EXPECT_EQ(svg.find("<b "), std::string::npos) << figure;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "figures" / "figures.json"));
  // A cross for each failed run on the set.
  const std::string times = ReadText(folder_ / "figures" / "times-shelf.svg");
  const std::size_t failed = times.find("failed-runs");
  ASSERT_NE(failed, std::string::npos);
  const std::string crosses = times.substr(failed, times.find("</g>", failed) - failed);
  std::size_t count = 0;
  for (std::size_t at = 0; (at = crosses.find("<path", at)) != std::string::npos; ++at) ++count;
  EXPECT_EQ(count, 2u) << crosses;
}

TEST_F(ReportProgramTest, FiguresTellOverHowManyOfTheProblemsTheyAre) {
  if (std::system("command -v node >/dev/null") != 0) {
    GTEST_SKIP() << "no node here: apt-get install nodejs";
  }
  WriteSession(folder_ / "example",
               {{.contestant = "A"},
                {.contestant = "A", .problem = 2},
                {.contestant = "A", .problem = 3},
                {.contestant = "A", .set = "other"},
                {.contestant = "A", .set = "other", .problem = 2, .status = PlanStatus::kTimedOut},
                {.contestant = "B"},
                {.contestant = "B", .problem = 2},
                {.contestant = "B", .set = "other"},
                {.contestant = "B", .set = "other", .problem = 2},
                {.contestant = "A", .set = "single"},
                {.contestant = "B", .set = "single"}});
  ASSERT_EQ(Run({Path("example"), "--out", Path("page.html"), "--figures", Path("figures")}),
            kExitOk)
      << errors_;
  const std::map<std::string, std::string> told = {
      {"profile-shelf", ">2 of 3 problems, "},
      {"survival-shelf", ">2 to 3 of 3 problems, "},
      {"path_length-shelf", ">2 to 3 of 3 problems, "},
      {"profile-other", ">2 problems, "},
      {"times-other", ">2 problems, "},
      {"path_length-other", ">1 to 2 of 2 problems, "},
      {"phases-other", ">1 to 2 of 2 problems, "},
      {"path_length-single", ">1 problem, "},
      {"phases-single", ">1 problem, "},
      {"profile-all_sets", ">5 of 6 problems, "},
      {"survival-all_sets", ">5 to 6 of 6 problems, "}};
  for (const auto& [figure, problems] : told) {
    EXPECT_THAT(ReadText(folder_ / "figures" / (figure + ".svg")), HasSubstr(problems)) << figure;
  }
}

TEST_F(ReportProgramTest, MeasuresOfSimplifiedPathsAloneAreDrawnToo) {
  if (std::system("command -v node >/dev/null") != 0) {
    GTEST_SKIP() << "no node here: apt-get install nodejs";
  }
  folder_.Write("other.csv",
                "problem_set,problem_index,solved,time_s,path_length_simplified\nshelf,1,1,4,2\n");
  ASSERT_EQ(Run({"--import", Path("other.csv"), "--as", "A", "--out", Path("page.html"),
                 "--figures", Path("figures")}),
            kExitOk)
      << errors_;
  EXPECT_THAT(ReadText(folder_ / "figures" / "path_length-shelf.svg"), HasSubstr(">1 problem<"));
}

TEST_F(ReportProgramTest, FiguresAndTablesMarkWhoHasLearned) {
  if (std::system("command -v node >/dev/null") != 0) {
    GTEST_SKIP() << "no node here: apt-get install nodejs";
  }
  WriteSession(folder_ / "example",
               {{.contestant = "A", .settings = {{"learned_from", "shelf"}}},
                {.contestant = "A", .set = "other", .settings = {{"learned_from", "shelf"}}},
                {.contestant = "B"},
                {.contestant = "B", .set = "other"}});
  ASSERT_EQ(Run({Path("example"), "--out", Path("page.html"), "--figures", Path("figures"), "--csv",
                 Path("csv"), "--latex", Path("latex")}),
            kExitOk)
      << errors_;
  for (const char* kind : {"success", "times", "survival", "profile", "phases", "path_length"}) {
    EXPECT_THAT(ReadText(folder_ / "figures" / (std::string(kind) + "-shelf.svg")),
                HasSubstr("(trained)<"))
        << kind;
    EXPECT_THAT(ReadText(folder_ / "figures" / (std::string(kind) + "-other.svg")),
                testing::Not(HasSubstr("trained")))
        << kind;
  }
  for (const char* table : {"success", "times", "pairs", "quality", "phases"}) {
    EXPECT_THAT(ReadText(folder_ / "csv" / (std::string(table) + ".csv")), HasSubstr(",(trained),"))
        << table;
    EXPECT_THAT(ReadText(folder_ / "latex" / (std::string(table) + ".tex")),
                HasSubstr(" & (trained) & "))
        << table;
  }
}

TEST_F(ReportProgramTest, ViewShowsAProblemOfASet) {
  const std::string source = PLANBENCH_SOURCE_DIR;
  ASSERT_EQ(Run({"--problems", source + "/problems/shelf_demo/3", "--robot",
                 source + "/robots/fetch", "--out", Path("view.html")},
                "view"),
            kExitOk)
      << errors_;
  const std::string page = ReadText(folder_ / "view.html");
  EXPECT_THAT(page, HasSubstr("\"title\":\"shelf_demo 3\""));
  EXPECT_THAT(page, HasSubstr("\"name\":\"torso_lift_link\""));
}

TEST_F(ReportProgramTest, ViewFindsMeshesAndSpheresOfAProblemWhereItIsTold) {
  const std::string robot = std::string(PLANBENCH_SOURCE_DIR) + "/tests/data/planar3";
  folder_.Write("set/scene0001.yaml",
                "world: {collision_objects: [{id: sail, meshes: ['package://boat/sail.obj'], "
                "mesh_poses: [{position: [1, 1, 0], orientation: [0, 0, 0, 1]}]}]}\n");
  folder_.Write("set/request0001.yaml", kPlanarRequest);
  folder_.Write("elsewhere/sail.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0.125\nf 1 2 3\n");
  folder_.Write("one.yaml", "links: {hand: [{center: [0.0625, 0, 0], radius: 0.25}]}\n");
  std::vector<std::string> view = {"--problems", Path("set/1"), "--robot",
                                   robot,        "--out",       Path("view.html")};
  EXPECT_EQ(Run(view, "view"), kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("give it by --package-path boat=DIR"));
  view.insert(view.end(),
              {"--package-path", "boat=" + Path("elsewhere"), "--spheres", Path("one.yaml")});
  ASSERT_EQ(Run(view, "view"), kExitOk) << errors_;
  const std::string page = ReadText(folder_ / "view.html");
  EXPECT_THAT(page, HasSubstr("\"low\":[0.0,0.0,0.0],\"size\":[1.0,1.0,0.125],"
                              "\"vertices\":\"AAAAAAAA//8AAAAAAAD/////\""));
  EXPECT_THAT(page, HasSubstr("\"spheres\":[[0.0625,0.0,0.0,0.25]]"));
  EXPECT_THAT(errors_, HasSubstr("one.yaml: no spheres for column, upper_arm, forearm"));
  EXPECT_THAT(page, HasSubstr("Neither checked nor shown, as they have no spheres: column, "
                              "upper_arm, forearm."));
}

TEST_F(ReportProgramTest, ASessionByHandIsShownWithItsSceneServersRobot) {
  PlanarSession by_hand;
  NodeStatusMessage server;
  server.kind = NodeKind::kSceneServer;
  server.name = "scene_server";
  server.instance = std::string(16, 'a');
  const auto write = [&](const std::string& name, const std::string& flag,
                         const std::string& of_server) {
    by_hand.session.settings["robot"] = flag;
    server.settings["robot"] = of_server;
    by_hand.session.nodes = {server};
    std::filesystem::create_directories(folder_ / name);
    EventLog log(folder_ / name / (name + ".lcmlog"), EventLog::Mode::kNew);
    log.Write(PlanarSession::Received(channel::kSession, by_hand.session));
    log.Write(PlanarSession::Received(channel::kScene, by_hand.scene));
    log.Write(PlanarSession::Received(channel::kRunRecord, by_hand.record));
    ResultsDatabase database(folder_ / name / "results.sqlite");
    database.Store(by_hand.session);
    database.Store(by_hand.record);
  };
  const std::string robot = std::string(PLANBENCH_SOURCE_DIR) + "/tests/data/planar3";
  // Nor is a flag that holds from another folder alone in the way.
  write("by_hand", "", robot);
  write("moved", "no/such/folder", robot);
  for (const char* name : {"by_hand", "moved"}) {
    EXPECT_EQ(Run({"--session", Path(name), "--run", "1", "--out", Path("view.html")}, "view"),
              kExitOk)
        << errors_;
    EXPECT_EQ(
        Run({"--log", Path(name) + "/" + name + ".lcmlog", "--out", Path("view.html")}, "view"),
        kExitOk)
        << errors_;
    EXPECT_EQ(Run({Path(name), "--out", Path("page.html")}), kExitOk) << errors_;
    EXPECT_THAT(ReadText(folder_ / "page.html"), testing::Not(HasSubstr("3D views of 0 of 1")));
  }
  // What the robot's files leave open is told.
  by_hand.session.settings["spheres"] =
      folder_.Write("one.yaml", "links: {hand: [{center: [0, 0, 0], radius: 0.25}]}\n").string();
  write("bare", robot, "");
  by_hand.session.settings.erase("spheres");
  for (const std::vector<std::string>& of :
       {std::vector<std::string>{"--session", Path("bare"), "--run", "1"},
        std::vector<std::string>{"--log", Path("bare/bare.lcmlog")}}) {
    std::vector<std::string> view = of;
    view.insert(view.end(), {"--out", Path("view.html")});
    EXPECT_EQ(Run(view, "view"), kExitOk) << errors_;
    EXPECT_THAT(errors_, HasSubstr("one.yaml: no spheres for column, upper_arm, forearm"));
  }
  // A log that has lost the session's message: the database has the flags.
  write("torn", robot, "");
  std::filesystem::remove(folder_ / "torn/torn.lcmlog");
  {
    EventLog log(folder_ / "torn/torn.lcmlog", EventLog::Mode::kNew);
    log.Write(PlanarSession::Received(channel::kScene, by_hand.scene));
    log.Write(PlanarSession::Received(channel::kRunRecord, by_hand.record));
  }
  EXPECT_EQ(Run({"--session", Path("torn"), "--run", "1", "--out", Path("view.html")}, "view"),
            kExitOk)
      << errors_;
  write("lost", "", "/no/such/robot");
  EXPECT_EQ(Run({Path("lost"), "--out", Path("page.html")}), kExitOk) << errors_;
  EXPECT_THAT(ReadText(folder_ / "page.html"),
              HasSubstr("view --session FOLDER --run RUN --robot DIR shows any"));
  std::vector<std::string> view = {"--session", Path("lost"), "--run",
                                   "1",         "--out",      Path("view.html")};
  EXPECT_EQ(Run(view, "view"), kExitBadInput);
  EXPECT_THAT(errors_, HasSubstr("/no/such/robot, is not here: give it with --robot DIR"));
  EXPECT_EQ(std::count(errors_.begin(), errors_.end(), '\n'), 1) << errors_;
  view.insert(view.end(), {"--robot", robot});
  EXPECT_EQ(Run(view, "view"), kExitOk) << errors_;
}

TEST_F(ReportProgramTest, ViewRefusesWhatItCannotShow) {
  const auto expect_refused = [&](const std::vector<std::string>& arguments, const char* reason) {
    EXPECT_EQ(Run(arguments, "view"), kExitBadInput);
    EXPECT_THAT(errors_, HasSubstr(reason));
    EXPECT_EQ(std::count(errors_.begin(), errors_.end(), '\n'), 1) << errors_;
  };
  const std::string set = std::string(PLANBENCH_SOURCE_DIR) + "/problems/shelf_demo";
  const std::string robot = std::string(PLANBENCH_SOURCE_DIR) + "/robots/fetch";
  WriteSession(folder_ / "example", {{.contestant = "A"}});
  expect_refused({}, "--session");
  expect_refused({"--problem", set + "/99", "--robot", robot}, "no problem 99");
  expect_refused({"--problem", set, "--robot", robot}, "SET/3");
  expect_refused({"--session", Path("example"), "--run", "7"}, "no run 7");
  expect_refused({"--session", Path("example"), "--run", "1"}, "holds no .lcmlog");
  folder_.Write("empty.lcmlog", "");
  expect_refused({"--session", Path("example")}, "example: give --run ID");
  expect_refused({"--session", Path("example"), "--run", "0"}, "no run 0");
  expect_refused({"--problem", set + "/3", "--robot", robot, "--run", "1"},
                 "--problems shows no run");
  expect_refused({"--log", Path("empty.lcmlog")}, "no run is recorded");
  for (const auto& [flag, value] : std::map<std::string, std::string>{
           {"--spheres", "spheres.yaml"}, {"--collision-model", "meshes"}}) {
    expect_refused({"--log", Path("empty.lcmlog"), flag, value}, "--problems");
  }
  const std::string log = Path("one.lcmlog");
  const std::vector<std::uint8_t> record = Encode(MakeRecord({.contestant = "A"}, "one", 1));
  EventLog(log, EventLog::Mode::kNew).Write({channel::kRunRecord, record, 1});
  for (const char* number : {"0", "2"}) {
    expect_refused({"--log", log, "--run", number}, "--run takes 1 to 1");
  }
}

}  // namespace
}  // namespace planbench
