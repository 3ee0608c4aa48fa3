#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "common/sqlite.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait_until.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

std::string Read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}
std::vector<std::string> Lines(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// scripts/planbench_slurm with stand-ins for sbatch, which runs the tasks at once, and for the
/// driver, which notes its arguments, begins a log and, unless it is told to die, says that it has
/// finished, and for report, which makes a session that holds the logs of its parts.
class SlurmTest : public testing::Test {
 protected:
  SlurmTest() {
    WriteProgram(
        "bin/sbatch",
        "for a in \"$@\"; do case $a in --array=*) tasks=$(echo ${a#--array=} | tr , ' ');; "
        "esac; script=$a; done\n"
        "echo \"$@\" >> $NOTES/sbatch\n"
        "if [ -n \"${tasks-}\" ]; then for t in $tasks; do SLURM_ARRAY_TASK_ID=$t bash "
        "$script || true; done; else bash $script || true; fi >> $NOTES/log 2>&1\necho 17\n");
    WriteProgram("programs/benchmark_driver",
                 "echo \"$@\" >> $NOTES/driver\n"
                 "while [ $# -gt 1 ]; do case $1 in --out | --resume) out=$2;; esac; shift; done\n"
                 "mkdir -p $out; echo $out > $out/log.lcmlog; case $out in */${DIES-none}) echo "
                 "'{\"finished\": false}' ;; *) echo "
                 "'{\"finished\": true}';; esac > $out/run.json\n");
    WriteProgram(
        "programs/report",
        "echo \"$@\" >> $NOTES/report\n"
        "[ \"$1 $3\" = '--merge --out' ] || exit 2\n"
        "[ ! -e $2 ] && [ ! -e $NOTES/refuses ] || exit 2\n"
        "mkdir $2; page=$4; out=$2; shift 4; parts=(\"$@\")\n"
        "cat \"${parts[@]/%//log.lcmlog}\" | sort -u > $out/log.lcmlog; echo page > $page\n");
  }

  void WriteProgram(const std::string& name, const std::string& body) {
    fs::permissions(folder_.Write(name, "#!/usr/bin/env bash\nset -eu\n" + body),
                    fs::perms::owner_all);
  }

  int Submit(std::vector<std::string> arguments, const std::string& dies = "none") {
    arguments.insert(arguments.begin(), PLANBENCH_SOURCE_DIR "/scripts/planbench_slurm");
    ChildProcess program(arguments, folder_ / "slurm",
                         {{"PATH", (folder_ / "bin").string() + ":" + std::getenv("PATH")},
                          {"PLANBENCH_PROGRAMS", (folder_ / "programs").string()},
                          {"NOTES", folder_.path().string()},
                          {"DIES", dies}});
    const int code = program.Wait().value_or(-1);
    output_ = program.Output();
    errors_ = program.Errors();
    return code;
  }

  TemporaryFolder folder_;
  const std::string out_ = (folder_ / "study").string();
  std::string output_, errors_;
};

TEST_F(SlurmTest, RunsEveryShardAndMergesThem) {
  fs::create_directories(out_ + "/shards/2");  // a task was killed when it had made its folder
  ASSERT_EQ(Submit({"--tasks", "3", "--out", out_, "--sbatch", "--partition=cpu --exclusive",
                    "--robot", "fetch", "--problems", "a folder"}),
            0)
      << errors_;
  EXPECT_THAT(output_, HasSubstr("submitted job 17: 3 of 3 shards"));
  const std::string flags = "--launch --robot fetch --problems a folder --shard ";
  EXPECT_THAT(Lines(folder_ / "driver"), ElementsAre(flags + "1/3 --out " + out_ + "/shards/1",
                                                     flags + "2/3 --out " + out_ + "/shards/2",
                                                     flags + "3/3 --out " + out_ + "/shards/3"))
      << Read(folder_ / "log");
  EXPECT_THAT(Lines(folder_ / "report"),
              ElementsAre("--merge merging/merged --out merging/report.html shards/1 shards/2 "
                          "shards/3"));
  EXPECT_EQ(Read(out_ + "/report.html"), "page\n");
  EXPECT_FALSE(fs::exists(out_ + "/merging"));
  const std::vector<std::string> submitted = Lines(folder_ / "sbatch");
  ASSERT_EQ(submitted.size(), 2u);
  EXPECT_THAT(submitted[0], HasSubstr("--array=1,2,3 --partition=cpu --exclusive"));
  EXPECT_THAT(submitted[1], HasSubstr("--dependency=afterany:17"));
}

TEST_F(SlurmTest, ItsFlagsMayBeGivenWithEqualsSigns) {
  ASSERT_EQ(Submit({"--tasks=1", "--out=" + out_, "--sbatch=--partition=cpu --exclusive",
                    "--container=env A=b", "--robot=fetch", "--problems", ""}),
            0)
      << errors_;
  EXPECT_THAT(
      Lines(folder_ / "driver"),
      ElementsAre("--launch --robot=fetch --problems  --shard 1/1 --out " + out_ + "/shards/1"))
      << Read(folder_ / "log");
  EXPECT_THAT(Lines(folder_ / "sbatch").front(),
              HasSubstr("--array=1 --partition=cpu --exclusive"));
  EXPECT_THAT(Read(out_ + "/job"), HasSubstr("exec env A=b "));
}

TEST_F(SlurmTest, WhatDiedIsResumedAndWhatIsFinishedIsLeft) {
  const std::vector<std::string> command = {"--tasks", "3", "--out", out_, "--seed", "7"};
  ASSERT_EQ(Submit(command, "2"), 0) << errors_;
  fs::remove(folder_ / "driver");
  ASSERT_EQ(Submit(command), 0) << errors_;
  EXPECT_THAT(output_, HasSubstr("1 of 3 shards"));
  const auto resumed = ElementsAre("--launch --seed 7 --shard 2/3 --resume " + out_ + "/shards/2");
  EXPECT_THAT(Lines(folder_ / "driver"), resumed);
  fs::remove(folder_ / "driver");
  // Killed before the logger had been told of the session.
  fs::rename(out_ + "/shards/2/run.json", out_ + "/shards/2/results.sqlite");
  ASSERT_EQ(Submit(command), 0) << errors_;
  EXPECT_THAT(Lines(folder_ / "driver"), resumed);
  fs::remove(folder_ / "driver");
  ASSERT_EQ(Submit(command), 0) << errors_;
  EXPECT_FALSE(fs::exists(folder_ / "driver"));
  EXPECT_EQ(Lines(folder_ / "report").size(), 4u);
}

TEST_F(SlurmTest, AShardWithoutALogIsNamedAndWhatWasMergedBeforeStays) {
  const std::vector<std::string> command = {"--tasks", "3", "--out", out_};
  ASSERT_EQ(Submit(command), 0) << errors_;
  // Killed when it had made its folder, and again when it is submitted again.
  WriteProgram("programs/benchmark_driver", "exit 1\n");
  fs::remove(folder_ / "report");
  fs::remove_all(out_ + "/merged");
  fs::remove_all(out_ + "/shards/3");
  fs::create_directories(out_ + "/shards/3/logs");
  ASSERT_EQ(Submit(command), 0) << errors_;
  const std::string merge = "--merge merging/merged --out merging/report.html ";
  EXPECT_THAT(Lines(folder_ / "report"), ElementsAre(merge + "shards/1 shards/2"));
  EXPECT_THAT(Read(folder_ / "log"), HasSubstr("shards/3 holds no event log and is left out"));
  // The last shard is made in what was merged, which is merged once more.
  std::ofstream(out_ + "/merged/log.lcmlog", std::ios::app) << "the third\n";
  ASSERT_EQ(Submit(command), 0) << errors_;
  EXPECT_EQ(Lines(folder_ / "report").back(), merge + "merged shards/1 shards/2");
  EXPECT_THAT(Read(out_ + "/merged/log.lcmlog"), HasSubstr("the third"));
  // A merge that fails, or was killed before it had put the new in the place of the old.
  const std::string refuses = folder_.Write("refuses", "");
  ASSERT_EQ(Submit(command), 0) << errors_;
  EXPECT_THAT(Read(out_ + "/merged/log.lcmlog"), HasSubstr("the third"));
  fs::rename(out_ + "/merged", out_ + "/merging/before");
  fs::remove(refuses);
  ASSERT_EQ(Submit(command), 0) << errors_;
  EXPECT_EQ(Lines(folder_ / "report").back(), merge + "merged shards/1 shards/2");
  EXPECT_THAT(Read(out_ + "/merged/log.lcmlog"), HasSubstr("the third"));
  EXPECT_FALSE(fs::exists(out_ + "/merging"));
  // What was merged and has lost its log stays.
  fs::rename(out_ + "/merged/log.lcmlog", folder_ / "log.lcmlog");
  fs::remove(folder_ / "report");
  ASSERT_EQ(Submit(command), 0) << errors_;
  EXPECT_FALSE(fs::exists(folder_ / "report"));
  EXPECT_TRUE(fs::exists(out_ + "/merged"));
  EXPECT_THAT(Read(folder_ / "log"), HasSubstr("merged holds no event log"));
  // Nothing to merge at all.
  fs::remove_all(out_ + "/merged");
  fs::remove_all(out_ + "/shards");
  ASSERT_EQ(Submit(command), 0) << errors_;
  EXPECT_FALSE(fs::exists(folder_ / "report"));
  EXPECT_THAT(Read(folder_ / "log"), HasSubstr("no shard holds an event log"));
}

TEST_F(SlurmTest, OfTwoMergesAtOnceOneWaitsForTheOther) {
  ASSERT_EQ(Submit({"--tasks", "2", "--out", out_}), 0) << errors_;
  WriteProgram("programs/report",
               "mkdir $NOTES/at_work; sleep 0.5; rmdir $NOTES/at_work\n"
               "mkdir $2; echo merged > $2/log.lcmlog; echo page > $4\n");
  const std::map<std::string, std::string> environment = {{"NOTES", folder_.path().string()}};
  ChildProcess first({"bash", out_ + "/merge"}, folder_ / "first", environment);
  ChildProcess second({"bash", out_ + "/merge"}, folder_ / "second", environment);
  for (ChildProcess* merge : {&first, &second}) {
    EXPECT_EQ(merge->Wait(), 0) << merge->Output() << merge->Errors();
  }
  EXPECT_EQ(Read(out_ + "/merged/log.lcmlog"), "merged\n");
}

TEST_F(SlurmTest, JobsAreSoundWithoutFlagsAndWithAnyFolder) {
  const fs::path out = folder_ / "50% %a \"b\" c";
  ASSERT_EQ(Submit({"--tasks", "2", "--out", out, "--dry-run"}), 0) << errors_;
  const std::string job = Read(out / "job");
  EXPECT_THAT(job, HasSubstr("/benchmark_driver --launch --shard "));
  // sbatch takes a word in quotes, in which a backslash stands before quotes, as a pattern.
  const std::string output =
      fmt::format("#SBATCH --output=\"{}/50%% %%a \\\"b\\\" c/logs/", folder_.path().string());
  EXPECT_THAT(job, HasSubstr(output + "%a\"\n"));
  EXPECT_THAT(Read(out / "merge"), HasSubstr(output + "merge\"\n"));
  ASSERT_EQ(Submit({"--tasks", "2", "--out", out, "--dry-run"}), 0) << errors_;
}

TEST_F(SlurmTest, RefusesBadUseInOneLine) {
  ASSERT_EQ(Submit({"--tasks", "2", "--out", out_, "--dry-run", "--seed", "1"}), 0) << errors_;
  EXPECT_THAT(output_, HasSubstr("2 of 2 shards to run"));
  EXPECT_FALSE(fs::exists(folder_ / "sbatch"));
  const struct {
    std::vector<std::string> arguments;
    std::string message;
  } cases[] = {
      {{"--tasks", "2", "--out", out_, "--seed", "2"},
       "holds another session: 2 shards of: --seed 1"},
      {{"--tasks", "0", "--out", out_}, "--tasks: a number of shards is needed, found '0'"},
      {{"--out", out_}, "--tasks: a number"},
      {{"--tasks", "2"}, "--out: a folder is needed"},
      {{"--tasks", "2", "--out", "a\\b"}, "a\\b': Slurm drops backslashes"},
      {{"--tasks", "2", "--out", out_, "--shard", "1/2"}, "--shard: that is this program's to say"},
      {{"--tasks", "2", "--out", out_, "--lcm-url=u"},
       "--lcm-url=u: that is this program's to say"},
      {{"--tasks"}, "--tasks: which?"},
  };
  for (const auto& [arguments, message] : cases) {
    EXPECT_EQ(Submit(arguments), 2);
    EXPECT_THAT(errors_, HasSubstr(message));
    EXPECT_EQ(std::count(errors_.begin(), errors_.end(), '\n'), 1) << errors_;
  }
}

// On whatever cluster the machine belongs to.
TEST(Slurm, MergedShardsAreTheSessionInOneButForTimes) {
  if (std::system("sinfo -h -o %t 2>/dev/null | grep -qE '^(idle|mix)'") != 0) {
    GTEST_SKIP() << "needs a Slurm cluster with an idle node: slurm-wlm and munge, running";
  }
  TemporaryFolder folder;
  const std::string source = PLANBENCH_SOURCE_DIR;
  const std::vector<std::string> flags = {"--robot",    source + "/robots/fetch",
                                          "--problems", source + "/problems/shelf_demo",
                                          "--planners", "rrtc",
                                          "--trials",   "2",
                                          "--time",     "30"};
  std::vector<std::string> command = {source + "/scripts/planbench_slurm", "--tasks", "3", "--out",
                                      folder / "study"};
  command.insert(command.end(), flags.begin(), flags.end());
  ChildProcess slurm(command, folder / "slurm", {{"PLANBENCH_PROGRAMS", PLANBENCH_BIN_DIR}});
  ASSERT_EQ(slurm.Wait(), 0) << slurm.Errors();
  ASSERT_TRUE(WaitUntil([&] { return fs::exists(folder / "study/report.html"); }))
      << Read(folder / "study/logs/merge") << Read(folder / "study/logs/1");

  command = {PLANBENCH_BIN_DIR "/benchmark_driver", "--launch", "--out", folder / "one"};
  command.insert(command.end(), flags.begin(), flags.end());
  ChildProcess driver(command, folder / "driver");
  ASSERT_EQ(driver.Wait(), 0) << driver.Errors();
  const auto rows = [&](const std::string& session) {
    SqliteConnection database(folder / (session + "/results.sqlite"),
                              SqliteConnection::Mode::kReadOnly);
    SqliteStatement statement = database.Prepare(
        "SELECT problem_set, problem_index, trial, seed, status, path_length FROM runs ORDER BY 1, "
        "2, 3");
    std::vector<std::vector<SqliteValue>> all;
    while (statement.Step()) {
      std::vector<SqliteValue>& row = all.emplace_back();
      for (int column = 0; column < 6; ++column) row.push_back(statement.Value(column));
    }
    return all;
  };
  EXPECT_EQ(rows("one").size(), 12u);
  EXPECT_EQ(rows("study/merged"), rows("one"));
}

TEST(PlotSessionTest, ContestantsMayBeCalledAnything) {
  if (std::system("command -v gnuplot sqlite3 >/dev/null") != 0) {
    GTEST_SKIP() << "needs sqlite3 and gnuplot-nox";
  }
  TemporaryFolder folder;
  const std::vector<std::string> names = {"RRT-Connect (w/o balance)", "Kuffner's", "A|B",
                                          "x_1^{2} \\ \"q\" $HOME"};
  {
    SqliteConnection database(folder / "results.sqlite", SqliteConnection::Mode::kReadWriteCreate);
    database.Execute(
        "CREATE TABLE plannerConfigs (id INTEGER PRIMARY KEY, name TEXT, settings TEXT DEFAULT "
        "'algorithm = A');"
        "CREATE TABLE runs (plannerid INTEGER, direction TEXT, time REAL, time_limit REAL, solved "
        "BOOLEAN, problem_set TEXT DEFAULT 'shelf')");
    SqliteStatement insert = database.Prepare("INSERT INTO plannerConfigs (name) VALUES (?)");
    for (const std::string& name : names) insert.BindAll(name).Run();
    database.Execute(
        "INSERT INTO plannerConfigs (name, settings) VALUES "
        "('Pupil', 'algorithm = A' || char(10) || 'learned_from = box, shelf' || char(10) || 'n = "
        "1'),"
        "('Heir', 'first_path_learned_from = shelf' || char(10)),"
        "('Other', 'learned_from = shelf_thin' || char(10))");
    database.Execute(
        "INSERT INTO runs (plannerid, direction, time, time_limit, solved) "
        "SELECT id, 'forward', 0.5, 10, 1 FROM plannerConfigs");
  }
  const std::string picture = folder / "its picture.svg";
  ChildProcess plot({PLANBENCH_SOURCE_DIR "/scripts/plot_session", folder.path().string(), picture},
                    folder / "plot");
  EXPECT_EQ(plot.Wait(), 0);
  EXPECT_EQ(plot.Errors(), "");
  for (const std::string& name : names) EXPECT_THAT(Read(picture), HasSubstr(name + " forward"));
  EXPECT_THAT(Read(picture), HasSubstr("Pupil (trained) forward"));
  EXPECT_THAT(Read(picture), HasSubstr("Heir (trained) forward"));
  EXPECT_THAT(Read(picture), HasSubstr("Other forward")) << "has learned from another set";

  const std::string nowhere = folder / "nowhere/picture.svg";
  ChildProcess refused(
      {PLANBENCH_SOURCE_DIR "/scripts/plot_session", folder.path().string(), nowhere},
      folder / "refused");
  EXPECT_EQ(refused.Wait(), 2);
  EXPECT_EQ(refused.Errors(), "plot_session: " + nowhere + ": cannot be written\n");
  EXPECT_EQ(refused.Output(), "");
}

}  // namespace
}  // namespace planbench
