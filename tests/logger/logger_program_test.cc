// The program itself, as a process. memq:// keeps it off the network.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "messaging/channels.h"
#include "messaging/event_log.h"
#include "sample_messages.h"
#include "session_files.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

using namespace std::chrono_literals;

class LoggerProgram {
 public:
  /// Starts it with its stderr in a file.
  LoggerProgram(std::vector<std::string> arguments, const std::filesystem::path& stderr_file) {
    arguments.insert(arguments.begin(), PLANBENCH_BIN_DIR "/logger");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      if (std::freopen(stderr_file.c_str(), "w", stderr) == nullptr) _exit(99);
      execv(argv[0], argv.data());
      _exit(98);
    }
  }
  ~LoggerProgram() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }

  void Send(int signal) const { kill(pid_, signal); }
  pid_t pid() const { return pid_; }

  /// Waits for its end; -1 if it was killed.
  int ExitCode() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
};

class LoggerProgramTest : public testing::Test {
 protected:
  std::vector<std::string> Arguments(const std::string& folder) const {
    return {"--out", (temporary_ / folder).string(), "--lcm-url", "memq://"};
  }
  std::string Stderr() const { return TextOf(temporary_ / "stderr"); }
  /// Waits until a live logger has said that it records.
  bool WaitUntilLive(const std::filesystem::path& stderr_file) const {
    for (int i = 0; i < 600; ++i) {
      if (TextOf(stderr_file).find("recording to") != std::string::npos) return true;
      std::this_thread::sleep_for(50ms);
    }
    return false;
  }

  TemporaryFolder temporary_;
};

TEST_F(LoggerProgramTest, EndsCleanlyOnSignals) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::string folder = fmt::format("s{}", signal);
    const std::filesystem::path said = temporary_ / (folder + ".stderr");
    LoggerProgram logger(Arguments(folder), said);
    ASSERT_TRUE(WaitUntilLive(said)) << TextOf(said);
    logger.Send(signal);
    EXPECT_EQ(logger.ExitCode(), 0) << TextOf(said);
    EXPECT_GT(std::filesystem::file_size(temporary_ / folder / (folder + ".lcmlog")), 0);
    EXPECT_NE(DumpDatabase(temporary_ / folder / "results.sqlite").find("NO_ANSWER"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(temporary_ / folder / "results.sqlite-wal"));
  }
}

TEST_F(LoggerProgramTest, ASecondOneOnTheFolderIsRefused) {
  LoggerProgram first(Arguments("s"), temporary_ / "first");
  ASSERT_TRUE(WaitUntilLive(temporary_ / "first"));
  LoggerProgram second(Arguments("s"), temporary_ / "stderr");
  EXPECT_EQ(second.ExitCode(), 2);
  EXPECT_EQ(Stderr(), "logger: session folder " + (temporary_ / "s").string() +
                          " is in use by the logger with pid " + std::to_string(first.pid()) +
                          "; choose another folder or stop that logger\n");
}

TEST_F(LoggerProgramTest, BadUseIsRefused) {
  EXPECT_EQ(LoggerProgram({"--lcm-url", "memq://"}, temporary_ / "stderr").ExitCode(), 2);
  EXPECT_NE(Stderr().find("--out"), std::string::npos) << Stderr();
  WriteText(temporary_ / "file", "x");
  EXPECT_EQ(LoggerProgram(Arguments("file"), temporary_ / "stderr").ExitCode(), 2);
  EXPECT_NE(Stderr().find("cannot create session folder"), std::string::npos) << Stderr();
}

TEST_F(LoggerProgramTest, WhatALogThatWasCutOffLacksIsTold) {
  const std::filesystem::path log = temporary_ / "cut.lcmlog";
  {
    EventLog events(log, EventLog::Mode::kNew);
    events.Write(Received(channel::kSession, SampleSession()));
    events.Write(Received(channel::kRunRecord, SampleRecord()));
    events.Write(Received(channel::kRunRecord, UnansweredRecord()));
  }
  const auto rebuild = [&](const std::string& folder) {
    std::vector<std::string> arguments = Arguments(folder);
    arguments.insert(arguments.end(), {"--from", log.string()});
    return LoggerProgram(arguments, temporary_ / "stderr").ExitCode();
  };
  EXPECT_EQ(rebuild("whole"), 0);
  EXPECT_EQ(Stderr().find("whole event"), std::string::npos) << Stderr();
  EXPECT_NE(Stderr().find("session session-1 has not finished and was to have 12 runs, of which 2 "
                          "are recorded here"),
            std::string::npos)
      << Stderr();
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 5);
  EXPECT_EQ(rebuild("cut"), 0);
  EXPECT_NE(Stderr().find(log.string() + ": "), std::string::npos) << Stderr();
  EXPECT_NE(Stderr().find("bytes after the last whole event are not read"), std::string::npos)
      << Stderr();
  EXPECT_NE(Stderr().find("12 runs, of which 1 are recorded here"), std::string::npos) << Stderr();
}

TEST_F(LoggerProgramTest, AFileThatIsNoLogIsRefusedInALine) {
  std::vector<std::string> arguments = Arguments("s");
  arguments.insert(arguments.end(), {"--from", (temporary_ / "file").string()});
  for (const char* text : {"", "no log\n"}) {
    WriteText(temporary_ / "file", text);
    EXPECT_EQ(LoggerProgram(arguments, temporary_ / "stderr").ExitCode(), 2);
    EXPECT_EQ(Stderr(), "logger: " + (temporary_ / "file").string() +
                            ": there is no event of an LCM event log in it\n");
    EXPECT_FALSE(std::filesystem::exists(temporary_ / "s"));
  }
}

TEST_F(LoggerProgramTest, AResumedOneTellsOfDamageAndKeepsWhatFollowsIt) {
  const std::filesystem::path log = temporary_ / "s" / "s.lcmlog";
  std::filesystem::create_directories(log.parent_path());
  {
    EventLog events(log, EventLog::Mode::kNew);
    events.Write(Received(channel::kSession, SampleSession()));
    events.Write(Received(channel::kRunRecord, SampleRecord()));
  }
  std::fstream(log, std::ios::binary | std::ios::in | std::ios::out).put(0);
  const auto size = std::filesystem::file_size(log);
  std::vector<std::string> arguments = Arguments("s");
  arguments.push_back("--resume");
  LoggerProgram resumed(arguments, temporary_ / "stderr");
  ASSERT_TRUE(WaitUntilLive(temporary_ / "stderr")) << Stderr();
  resumed.Send(SIGTERM);
  EXPECT_EQ(resumed.ExitCode(), 0);
  EXPECT_GE(std::filesystem::file_size(log), size);
  EXPECT_NE(Stderr().find(log.string() + ": "), std::string::npos) << Stderr();
  EXPECT_NE(Stderr().find("from byte 0 on are passed over"), std::string::npos) << Stderr();
  EXPECT_NE(Stderr().find("lacked 1 run records of the event log"), std::string::npos) << Stderr();
}

TEST_F(LoggerProgramTest, AKilledOneCanBeResumed) {
  LoggerProgram killed(Arguments("s"), temporary_ / "stderr");
  ASSERT_TRUE(WaitUntilLive(temporary_ / "stderr"));
  killed.Send(SIGKILL);
  EXPECT_EQ(killed.ExitCode(), -1);
  EXPECT_EQ(LoggerProgram(Arguments("s"), temporary_ / "stderr").ExitCode(), 2);
  EXPECT_NE(Stderr().find("--resume"), std::string::npos) << Stderr();
  std::vector<std::string> arguments = Arguments("s");
  arguments.push_back("--resume");
  LoggerProgram resumed(arguments, temporary_ / "resumed");
  ASSERT_TRUE(WaitUntilLive(temporary_ / "resumed")) << TextOf(temporary_ / "resumed");
  resumed.Send(SIGTERM);
  EXPECT_EQ(resumed.ExitCode(), 0);
}

}  // namespace
}  // namespace planbench
