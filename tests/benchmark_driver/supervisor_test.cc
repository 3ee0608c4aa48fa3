#include "benchmark_driver/supervisor.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "tests/support/expect_input_error.h"
#include "tests/support/message_collector.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

/// True for a process that exists and has not ended (one that nobody has waited for yet has).
bool IsRunning(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  const std::size_t name_end = text.rfind(')');
  return name_end != std::string::npos && name_end + 2 < text.size() && text[name_end + 2] != 'Z' &&
         text[name_end + 2] != 'X';
}

class SupervisorTest : public testing::Test {
 protected:
  /// A child that runs a shell script, its log named after it; $OUT is a file of the test's.
  ChildSpec Script(const std::string& name, const std::string& script) const {
    return {name, {"/bin/sh", "-c", script}, {{"OUT", out_.string()}}, Log(name)};
  }
  std::filesystem::path Log(const std::string& name) const {
    return folder_.path() / (name + ".log");
  }
  static std::vector<std::string> Lines(const std::filesystem::path& file) {
    std::vector<std::string> lines;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
  }
  /// Lines of $OUT, once there are that many.
  std::vector<std::string> AwaitOutput(std::size_t count) const {
    EXPECT_TRUE(WaitUntil([&] { return Lines(out_).size() >= count; }));
    return Lines(out_);
  }
  static bool Hopeless(const Supervisor& supervisor) {
    try {
      supervisor.ThrowIfHopeless();
      return false;
    } catch (const std::runtime_error&) {
      return true;
    }
  }

  TemporaryFolder folder_;
  const std::filesystem::path out_ = folder_.path() / "out";
};

TEST_F(SupervisorTest, WhatIsStartedAgainIsToldSo) {
  ChildSpec child = Script("child", "echo \"$0\" >> $OUT; exit 3");
  child.when_again = {"again"};
  Supervisor supervisor;
  supervisor.Start(child);
  const std::vector<std::string> lines = AwaitOutput(3);
  EXPECT_EQ(lines[0], "/bin/sh");
  EXPECT_EQ(lines[1], "again");
  EXPECT_EQ(lines[2], "again");
}

TEST_F(SupervisorTest, GivesChildrenTheirEnvironmentAndLog) {
  folder_.Write("child.log", "of an earlier time\n");
  setenv("PLANBENCH_TEST_OURS", "ours", 1);
  setenv("PLANBENCH_TEST_BOTH", "ours", 1);
  ChildSpec child = Script("child",
                           "echo \"$PLANBENCH_TEST_OURS $PLANBENCH_TEST_BOTH\"\n"
                           "echo complaint >&2\n"
                           "read line || echo no input\n"
                           "echo done >> $OUT\n"
                           "exec sleep 1000");
  child.environment["PLANBENCH_TEST_BOTH"] = "its own";
  Supervisor supervisor;
  supervisor.Start(child);
  AwaitOutput(1);
  unsetenv("PLANBENCH_TEST_OURS");
  unsetenv("PLANBENCH_TEST_BOTH");
  EXPECT_EQ(Lines(Log("child")), (std::vector<std::string>{"of an earlier time", "ours its own",
                                                           "complaint", "no input"}));
}

TEST_F(SupervisorTest, ChildrenHoldNoneOfOurFiles) {
  const int held = open(folder_.Write("held", "").c_str(), O_RDONLY);
  ASSERT_GE(held, 0);
  Supervisor supervisor;
  supervisor.Start(Script("child", "ls -l /proc/$$/fd | grep -c /held >> $OUT; exec sleep 1000"));
  EXPECT_EQ(AwaitOutput(1).at(0), "0");
  close(held);
}

TEST_F(SupervisorTest, RestartsWhatDies) {
  Supervisor supervisor;
  supervisor.Start(Script("child",
                          "echo $$ >> $OUT\n"
                          "[ $(wc -l < $OUT) -ge 3 ] || exit 1\n"
                          "exec sleep 1000"));
  AwaitOutput(3);
  EXPECT_FALSE(Hopeless(supervisor));
}

TEST_F(SupervisorTest, RestartsWhatIsKilled) {
  Supervisor supervisor;
  supervisor.Start(Script("child", "echo $$ >> $OUT; exec sleep 1000"));
  const pid_t first = std::stoi(AwaitOutput(1).at(0));
  kill(first, SIGKILL);
  const pid_t second = std::stoi(AwaitOutput(2).at(1));
  EXPECT_NE(first, second);
}

TEST_F(SupervisorTest, WhatFallsSilentIsStartedAgainUnlessItWasNeverHeard) {
  Supervisor supervisor(milliseconds(100));
  const auto script = [&](const std::string& name) {
    return Script(name, "echo $$ >> $OUT; exec sleep 1000");
  };
  supervisor.Start(script("silent"));
  const pid_t silent = std::stoi(AwaitOutput(1).at(0));
  supervisor.Start(script("heard"));
  const pid_t heard = std::stoi(AwaitOutput(2).at(1));
  supervisor.Heard("heard", silent);
  supervisor.Heard("heard", heard);
  AwaitOutput(3);
  EXPECT_FALSE(IsRunning(heard));
  EXPECT_TRUE(IsRunning(silent));
}

TEST_F(SupervisorTest, WhileThisProcessDoesNotHearItselfNobodyIsSilent) {
  Supervisor supervisor(milliseconds(200));
  supervisor.HeardMyself();
  supervisor.Start(Script("child", "echo $$ >> $OUT; exec sleep 1000"));
  const pid_t pid = std::stoi(AwaitOutput(1).at(0));
  supervisor.Heard("child", pid);
  std::this_thread::sleep_for(milliseconds(600));
  EXPECT_TRUE(IsRunning(pid));
  EXPECT_TRUE(WaitUntil([&] {
    supervisor.HeardMyself();
    return !IsRunning(pid);
  }));
}

TEST_F(SupervisorTest, WhatIsHeardOfOneThatHasGoneTellsNothingOfTheNext) {
  Supervisor supervisor;
  supervisor.Start(Script("child", "echo $$ >> $OUT; exec sleep 1000"));
  const pid_t first = std::stoi(AwaitOutput(1).at(0));
  kill(first, SIGKILL);
  const pid_t second = std::stoi(AwaitOutput(2).at(1));
  supervisor.CameUp("child", first);
  kill(second, SIGKILL);
  const pid_t third = std::stoi(AwaitOutput(3).at(2));
  EXPECT_EQ(supervisor.NumFailuresAtWork("child"), 0);
  supervisor.CameUp("child", third);
  kill(third, SIGKILL);
  AwaitOutput(4);
  EXPECT_EQ(supervisor.NumFailuresAtWork("child"), 1);
}

TEST_F(SupervisorTest, WhatDiesOrFallsSilentHasFailedAtItsWork) {
  Supervisor supervisor(milliseconds(100));
  supervisor.Start(Script("child", "echo $$ >> $OUT; exec sleep 1000"));
  const pid_t pid = std::stoi(AwaitOutput(1).at(0));
  supervisor.CameUp("child");
  supervisor.Heard("child", pid);
  const pid_t next = std::stoi(AwaitOutput(2).at(1));
  EXPECT_EQ(supervisor.NumFailuresAtWork("child"), 1);
  supervisor.CameUp("child");
  kill(next, SIGKILL);
  AwaitOutput(3);
  EXPECT_EQ(supervisor.NumFailuresAtWork("child"), 2) << "killed by another";
}

TEST_F(SupervisorTest, WhatIsToBeStartedAgainHasNotFailed) {
  Supervisor supervisor;
  supervisor.Start(Script("child", "echo $$ >> $OUT; exec sleep 1000"));
  AwaitOutput(1);
  supervisor.CameUp("child");
  supervisor.StartAgain("child");
  AwaitOutput(2);
  EXPECT_EQ(supervisor.NumFailuresAtWork("child"), 0);
}

TEST_F(SupervisorTest, WhatIsRenewedIsToldToEndAndHasNotFailed) {
  testing::internal::CaptureStdout();  // Where messages go.
  Supervisor supervisor;
  supervisor.Start(Script("child",
                          "trap 'echo told >> $OUT; exit 3' TERM; echo up >> $OUT\n"
                          "while :; do sleep 0.01; done"));
  constexpr std::size_t kRenewals = Supervisor::kMaxQuickDeaths + 1;
  for (std::size_t time = 1; time <= kRenewals; ++time) {
    AwaitOutput(2 * time - 1);
    if (time == kRenewals) supervisor.CameUp("child");
    supervisor.Renew("child");
  }
  const std::vector<std::string> lines = AwaitOutput(2 * kRenewals + 1);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "told"), static_cast<std::ptrdiff_t>(kRenewals));
  EXPECT_FALSE(Hopeless(supervisor));
  EXPECT_EQ(supervisor.NumFailuresAtWork("child"), 0);
}

TEST_F(SupervisorTest, WhatStaysThoughItIsToBeRenewedIsKilled) {
  Supervisor supervisor;
  supervisor.Start(Script("child", "trap '' TERM; echo $$ >> $OUT; while :; do sleep 0.05; done"));
  const pid_t first = std::stoi(AwaitOutput(1).at(0));
  supervisor.Renew("child", milliseconds(50));
  const pid_t second = std::stoi(AwaitOutput(2).at(1));
  EXPECT_FALSE(IsRunning(first));
  supervisor.Renew("child");
  supervisor.StopAll({}, milliseconds(50));
  EXPECT_FALSE(IsRunning(second));
  EXPECT_EQ(Lines(out_).size(), 2u) << "what is stopped is not started anew";
}

TEST_F(SupervisorTest, WhileThisProcessIsStoppedNoTimeToEndRunsOut) {
  const std::filesystem::path told = folder_ / "told", seen = folder_ / "seen";
  const pid_t supervising = fork();
  ASSERT_GE(supervising, 0);
  if (supervising == 0) {
    Supervisor supervisor;
    supervisor.Start(
        Script("child", "trap '' TERM; echo $$ >> $OUT; while :; do sleep 0.05; done"));
    WaitUntil([&] { return !Lines(out_).empty(); });
    supervisor.Renew("child", milliseconds(1000));
    std::ofstream(told) << "";
    WaitUntil([&] { return std::filesystem::exists(seen); });
    supervisor.StopAll({}, milliseconds(50));
    _exit(0);
  }
  EXPECT_TRUE(WaitUntil([&] { return std::filesystem::exists(told); }));
  kill(supervising, SIGSTOP);
  std::this_thread::sleep_for(milliseconds(1100));
  kill(supervising, SIGCONT);
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_TRUE(IsRunning(std::stoi(AwaitOutput(1).at(0))));
  folder_.Write("seen", "");
  waitpid(supervising, nullptr, 0);
}

TEST_F(SupervisorTest, WhatADeadChildHasStartedEndsWithIt) {
  Supervisor supervisor;
  supervisor.Start(Script("child", "sleep 1000 & echo \"$$ $!\" >> $OUT; wait"));
  std::istringstream ids(AwaitOutput(1).at(0));
  pid_t child = 0;
  pid_t grandchild = 0;
  ids >> child >> grandchild;
  EXPECT_TRUE(IsRunning(grandchild));
  kill(child, SIGKILL);
  EXPECT_TRUE(WaitUntil([&] { return !IsRunning(grandchild); }));
  AwaitOutput(2);
}

TEST_F(SupervisorTest, BadInputIsNotTriedAgain) {
  Supervisor supervisor;
  supervisor.Start(Script("child",
                          "echo run >> $OUT; echo starting; echo 'child: robot.yaml:3: no' >&2\n"
                          "exit 2"));
  ASSERT_TRUE(WaitUntil([&] { return Hopeless(supervisor); }));
  ExpectInputError([&] { supervisor.ThrowIfHopeless(); }, {"child: robot.yaml:3: no"});
  EXPECT_EQ(Lines(out_).size(), 1u);
}

TEST_F(SupervisorTest, WordsOfAnEarlierTimeAreNoReason) {
  folder_.Write("child.log", "recorded 326 messages\n");
  Supervisor supervisor;
  supervisor.Start(Script("child", "exit 2"));
  ASSERT_TRUE(WaitUntil([&] { return Hopeless(supervisor); }));
  ExpectInputError([&] { supervisor.ThrowIfHopeless(); }, {"(it said nothing)"});
}

TEST_F(SupervisorTest, WithoutALogItRunsAllTheSameAndSaysNothingHere) {
  ChildSpec child = Script("child", "readlink /proc/$$/fd/2 >> $OUT; exec sleep 1000");
  child.log = folder_ / "no/such/folder/child.log";
  Supervisor supervisor;
  supervisor.Start(child);
  EXPECT_EQ(AwaitOutput(1).at(0), "/dev/null");
}

TEST_F(SupervisorTest, ProgramThatCannotBeStartedIsBadInput) {
  Supervisor supervisor;
  supervisor.Start({"child", {"/no/such/program"}, {}, Log("child")});
  ASSERT_TRUE(WaitUntil([&] { return Hopeless(supervisor); }));
  ExpectInputError([&] { supervisor.ThrowIfHopeless(); },
                   {"/no/such/program", "cannot be started"});
}

TEST_F(SupervisorTest, WhatDiesAgainAndAgainIsHopeless) {
  Supervisor supervisor;
  testing::internal::CaptureStdout();  // Where messages go.
  supervisor.Start(Script("child", "echo run >> $OUT; echo 'out of luck'; exit 3"));
  const bool is_hopeless = WaitUntil([&] { return Hopeless(supervisor); });
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::ContainsRegex("ended with exit code 3; starting it again; its last words in "
                                     ".*: out of luck"));
  ASSERT_TRUE(is_hopeless);
  try {
    supervisor.ThrowIfHopeless();
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("child ended with exit code 3"));
    EXPECT_THAT(error.what(), HasSubstr("out of luck"));
    EXPECT_THAT(error.what(), HasSubstr(Log("child").string()));
  }
  EXPECT_EQ(Lines(out_).size(), static_cast<std::size_t>(Supervisor::kMaxQuickDeaths));
}

TEST_F(SupervisorTest, HowAChildEndedFirstSinceATimeIsKnown) {
  const auto begin = std::chrono::steady_clock::now();
  Supervisor supervisor;
  supervisor.Start(Script("child",
                          "echo run >> $OUT\n"
                          "case $(wc -l < $OUT) in 1) kill -SEGV $$;; 2) exit 3;; esac\n"
                          "exec sleep 1000"));
  supervisor.Start(
      {"other", {"/bin/sh", "-c", "sh -c 'kill -KILL $$'; exit $?"}, {}, Log("other")});
  AwaitOutput(3);
  EXPECT_EQ(supervisor.HowEnded("child", begin), "by signal 11 (Segmentation fault)");
  EXPECT_EQ(supervisor.HowEnded("child", std::chrono::steady_clock::now()), "");
  ASSERT_TRUE(WaitUntil([&] { return !supervisor.HowEnded("other", begin).empty(); }));
  EXPECT_EQ(supervisor.HowEnded("other", begin), "with exit code 137, as by signal 9 (Killed)");
}

TEST_F(SupervisorTest, LastWordsAreShortAndPrintableHoweverMuchWasSaid) {
  Supervisor supervisor;
  supervisor.Start(Script("child",
                          "yes early | head -n 10000; printf 'late \\033[2J'\n"
                          "printf ' word%.0s' $(seq 500); exit 3"));
  ASSERT_TRUE(WaitUntil([&] { return Hopeless(supervisor); }));
  const std::string why = supervisor.Hopeless().at("child");
  EXPECT_THAT(why, HasSubstr("child.log: late \\x1b[2J word word"));
  EXPECT_THAT(why, testing::EndsWith(" bytes more)"));
  EXPECT_LT(why.size(), Log("child").string().size() + 400);
}

TEST_F(SupervisorTest, ACommandThatLeavesItsPlannerIsToldToStay) {
  Supervisor supervisor;
  supervisor.Start(Script("mine", "sleep 1000 &"));
  ASSERT_TRUE(WaitUntil([&] { return Hopeless(supervisor); }));
  EXPECT_THAT(supervisor.Hopeless().at("mine"),
              HasSubstr("mine ended with exit code 0 again and again: a command must run as long "
                        "as its planner, which ends with it; its last words"));
}

TEST_F(SupervisorTest, WhatCameUpHasNotDiedOfItsStart) {
  Supervisor supervisor;
  supervisor.Start(Script("child", "echo run >> $OUT; exit 3"));
  for (std::size_t i = 1; i <= 2 * Supervisor::kMaxQuickDeaths; ++i) {
    AwaitOutput(i);
    supervisor.CameUp("child");
  }
  EXPECT_FALSE(Hopeless(supervisor));
  ASSERT_TRUE(WaitUntil([&] { return Hopeless(supervisor); })) << "of late it does not come up";
}

TEST_F(SupervisorTest, DeathsAtStartAreNoneAtWork) {
  Supervisor supervisor;
  supervisor.Start(Script("child",
                          "echo $$ >> $OUT\n"
                          "[ $(wc -l < $OUT) -le 2 ] || exit 3\n"
                          "exec sleep 1000"));
  for (int time = 1; time <= 2; ++time) {
    const pid_t pid = std::stoi(AwaitOutput(static_cast<std::size_t>(time)).back());
    supervisor.CameUp("child");
    kill(pid, SIGKILL);
    ASSERT_TRUE(WaitUntil([&] { return supervisor.NumFailuresAtWork("child") == time; }));
  }
  ASSERT_TRUE(WaitUntil([&] { return Hopeless(supervisor); }));
  EXPECT_EQ(supervisor.NumFailuresAtWork("child"), 2);
}

TEST_F(SupervisorTest, WhatIsToldToEndHasNotDiedOfItsWork) {
  Supervisor supervisor;
  supervisor.Start(Script("child",
                          "echo $$ >> $OUT\n"
                          "[ $(wc -l < $OUT) != 1 ] || exec sleep 1000\n"
                          "trap 'exit 0' TERM; echo ready >> $OUT; while :; do sleep 0.01; done"));
  const auto end = [&](const std::string& pid) {
    supervisor.CameUp("child");
    kill(std::stoi(pid), SIGTERM);
  };
  end(AwaitOutput(1).at(0));
  end(AwaitOutput(3).at(1));
  AwaitOutput(5);
  EXPECT_EQ(supervisor.NumFailuresAtWork("child"), 0);
}

TEST_F(SupervisorTest, TheHopelessCanBeSpared) {
  Supervisor supervisor;
  supervisor.Start(Script("bad", "echo 'no robot'; exit 2"));
  supervisor.Start(Script("good", "exec sleep 1000"));
  ASSERT_TRUE(WaitUntil([&] { return Hopeless(supervisor); }));
  supervisor.ThrowIfHopeless({"bad"});
  EXPECT_EQ(supervisor.Hopeless(), (std::map<std::string, std::string>{{"bad", "bad: no robot"}}));
  EXPECT_THROW(supervisor.ThrowIfHopeless({"good"}), InputError);
}

TEST_F(SupervisorTest, StopsInTheOrderAskedTheRestLastStartedFirst) {
  const std::string script =
      "trap 'echo $0 stopped >> $OUT; exit 0' TERM\n"
      "echo $0 ready >> $OUT\n"
      "while :; do sleep 0.01; done";
  Supervisor supervisor;
  for (const char* name : {"a", "b", "c", "d"}) {
    ChildSpec child = Script(name, script);
    child.arguments.push_back(name);  // $0
    supervisor.Start(child);
  }
  AwaitOutput(4);
  supervisor.StopAll({"c", "a"});
  std::vector<std::string> lines = Lines(out_);
  lines.erase(lines.begin(), lines.begin() + 4);
  EXPECT_EQ(lines, (std::vector<std::string>{"c stopped", "a stopped", "d stopped", "b stopped"}));
}

TEST_F(SupervisorTest, KillsWhatDoesNotEnd) {
  Supervisor supervisor;
  supervisor.Start(Script("child", "trap '' TERM; echo $$ >> $OUT; while :; do sleep 0.05; done"));
  const pid_t pid = std::stoi(AwaitOutput(1).at(0));
  supervisor.StopAll({}, milliseconds(50));
  EXPECT_FALSE(IsRunning(pid));
}

TEST_F(SupervisorTest, WhatIsHeldThoughItWasKilledIsNamedAndLeftBehind) {
  const std::filesystem::path held = folder_ / "held", words = folder_ / "words";
  // So that this process, which holds the child, is above it: Yama lets no other do that.
  const pid_t parent = fork();
  ASSERT_GE(parent, 0);
  if (parent == 0) {
    dup2(open(words.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);  // Where messages go.
    Supervisor supervisor;
    supervisor.death_patience = milliseconds(200);
    supervisor.Start(Script("child", "echo $$ >> $OUT; exec sleep 1000"));
    WaitUntil([&] { return std::filesystem::exists(held); });
    supervisor.StopAll({}, milliseconds(50));
    fflush(stdout);
    _exit(0);
  }
  const pid_t pid = std::stoi(AwaitOutput(1).at(0));
  const bool holds = ptrace(PTRACE_SEIZE, pid, nullptr, nullptr) == 0;
  folder_.Write("held", "");
  waitpid(parent, nullptr, 0);
  if (!holds) GTEST_SKIP() << "no process may be traced here";
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, __WALL);
  const std::vector<std::string> lines = Lines(words);
  ASSERT_FALSE(lines.empty());
  EXPECT_THAT(lines.back(),
              HasSubstr(fmt::format("child (pid {}) was killed and has not ended", pid)));
}

TEST_F(SupervisorTest, LeavesNothingBehind) {
  std::vector<pid_t> ids;
  {
    Supervisor supervisor;
    for (int i = 0; i < 5; ++i) {
      supervisor.Start(Script("child" + std::to_string(i),
                              "sleep 1000 & printf '%s\\n%s\\n' $$ $! >> $OUT; wait"));
    }
    for (const std::string& line : AwaitOutput(10)) ids.push_back(std::stoi(line));
  }
  for (const pid_t pid : ids) {
    EXPECT_TRUE(WaitUntil([&] { return !IsRunning(pid); })) << pid;
  }
}

TEST_F(SupervisorTest, StopsWhatHasHardlyBegun) {
  // A child asked to end before it runs its own program ends too: none has to be killed, which
  // would take ten seconds.
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 20; ++i) {
    Supervisor supervisor;
    supervisor.Start(Script("child", "exec sleep 1000"));
    if (i % 2 == 0) {
      WaitUntil([&] { return std::filesystem::exists(Log("child")); });
    }
    supervisor.StopAll({}, std::chrono::seconds(60));
    std::filesystem::remove(Log("child"));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
}

TEST_F(SupervisorTest, ChildrenEndWithTheirParent) {
  const pid_t parent = fork();
  ASSERT_GE(parent, 0);
  if (parent == 0) {
    Supervisor supervisor;
    supervisor.Start(Script("child", "echo $$ >> $OUT; exec sleep 1000"));
    pause();
    _exit(1);
  }
  const pid_t child = std::stoi(AwaitOutput(1).at(0));
  EXPECT_TRUE(IsRunning(child));
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  EXPECT_TRUE(WaitUntil([&] { return !IsRunning(child); }));
}

}  // namespace
}  // namespace planbench
