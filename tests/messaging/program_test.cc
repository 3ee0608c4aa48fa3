#include "messaging/program.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "common/command_line.h"
#include "common/error.h"
#include "common/standard_output.h"
#include "messaging/lcm_url.h"
#include "messaging/robot_flags.h"
#include "planning/plan_status.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class ProgramTest : public testing::Test {
 protected:
  // The program's log is made of the standard error of the moment, which is captured.
  ProgramTest() : before_(spdlog::default_logger()) {}
  ~ProgramTest() override {
    spdlog::drop("tester");
    spdlog::set_default_logger(before_);
  }

  int Run(std::vector<std::string> arguments, const std::function<int()>& work) {
    arguments.insert(arguments.begin(), "tester");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = program_.Run(static_cast<int>(argv.size()), argv.data(), work);
    out_ = testing::internal::GetCapturedStdout();
    err_ = testing::internal::GetCapturedStderr();
    return code;
  }

  Program program_{"tester", "Tests programs."};
  std::string out_;
  std::string err_;

 private:
  std::shared_ptr<spdlog::logger> before_;
};

int MustNotWork() {
  ADD_FAILURE() << "must not come to work";
  return 0;
}

TEST_F(ProgramTest, ReturnsWhatTheWorkReturns) {
  int number = 0;
  program_.app().add_option("--number", number);
  EXPECT_EQ(Run({"--number", "5"}, [&] { return number; }), 5);
  EXPECT_EQ(err_, "");
}

TEST_F(ProgramTest, BadInputEndsWith2AndOneLine) {
  EXPECT_EQ(Run({}, []() -> int { throw InputError("robot.yaml:3: no"); }), kExitBadInput);
  EXPECT_EQ(err_, "tester: robot.yaml:3: no\n");
}

TEST_F(ProgramTest, OtherFailuresEndWith1AndOneLine) {
  EXPECT_EQ(Run({}, []() -> int { throw std::runtime_error("disk full"); }), kExitFailed);
  EXPECT_EQ(err_, "tester: failed: disk full\n");
}

TEST_F(ProgramTest, BadFlagsEndWith2AndOneLine) {
  EXPECT_EQ(Run({"--nonsense"}, MustNotWork), kExitBadInput);
  EXPECT_THAT(err_, StartsWith("tester: "));
  EXPECT_THAT(err_, HasSubstr("--nonsense"));
  EXPECT_THAT(err_, EndsWith("(see tester --help)\n"));
}

TEST_F(ProgramTest, EmptyTextIsRefusedByTheNameOfItsFlag) {
  std::vector<std::string> words;
  std::string text;
  bool is_on = false;
  program_.app().add_option("words", words);
  program_.app().add_option("--text", text);
  program_.app().add_flag("--on", is_on);
  EXPECT_EQ(Run({"one", "--text", "two", "--on"}, [] { return 7; }), 7) << err_;
  const std::pair<std::vector<std::string>, std::string> kEmpty[] = {
      {{"--text", ""}, "--text"}, {{"--lcm-url", ""}, "--lcm-url"}, {{"one", ""}, "words"}};
  for (const auto& [arguments, named] : kEmpty) {
    spdlog::drop("tester");
    EXPECT_EQ(Run(arguments, MustNotWork), kExitBadInput);
    EXPECT_EQ(err_, "tester: " + named + ": the text given is empty\n");
  }
}

TEST_F(ProgramTest, MissingRequiredFlagIsNamed) {
  std::string robot;
  program_.app().add_option("--robot", robot)->required();
  EXPECT_EQ(Run({}, MustNotWork), kExitBadInput);
  EXPECT_THAT(err_, HasSubstr("--robot"));
}

TEST_F(ProgramTest, HelpNamesTheFlagsOfAllPrograms) {
  EXPECT_EQ(Run({"--help"}, MustNotWork), kExitOk);
  EXPECT_THAT(out_, HasSubstr("Tests programs."));
  for (const char* told : {"--help", "--version", "--lcm-url", "128 + N"}) {
    EXPECT_THAT(out_, HasSubstr(told));
  }
  EXPECT_EQ(err_, "");
}

TEST_F(ProgramTest, AFlagOfAnEnumTakesItsNamesAlone) {
  Direction direction = Direction::kForward;
  program_.app().add_option("--direction", direction)->transform(OneOf<Direction>());
  EXPECT_EQ(Run({"--direction", "backward"}, [&] { return static_cast<int>(direction); }), 1);
  spdlog::drop("tester");
  EXPECT_EQ(Run({"--direction", "1"}, MustNotWork), kExitBadInput);
  EXPECT_EQ(err_, "tester: --direction: 1 is not forward or backward (see tester --help)\n");
  spdlog::drop("tester");
  EXPECT_EQ(Run({"--help"}, MustNotWork), kExitOk);
  EXPECT_THAT(out_, HasSubstr("{forward,backward}"));
}

TEST_F(ProgramTest, VersionIsTold) {
  EXPECT_EQ(Run({"--version"}, MustNotWork), kExitOk);
  EXPECT_THAT(out_, StartsWith("tester "));
}

TEST_F(ProgramTest, LcmUrlIsTheFlagsIfGiven) {
  EXPECT_EQ(Run({"--lcm-url", "memq://"},
                [&] {
                  EXPECT_EQ(program_.lcm_url(), "memq://");
                  EXPECT_TRUE(program_.lcm_url_given());
                  return 0;
                }),
            0);
}

TEST_F(ProgramTest, LcmUrlIsTheDefaultIfNot) {
  Run({}, [&] {
    EXPECT_EQ(program_.lcm_url(), ResolveLcmUrl(""));
    EXPECT_FALSE(program_.lcm_url_given());
    return 0;
  });
}

TEST_F(ProgramTest, TerminationIsARequestToStop) {
  Run({}, [] {
    const auto stop = AwaitStopSignals();
    EXPECT_FALSE(stop());
    raise(SIGTERM);
    EXPECT_TRUE(stop());
    return 0;
  });
}

TEST_F(ProgramTest, AClosedTerminalIsARequestToStopUnlessThatIsIgnored) {
  const auto hang_up = [] {
    signal(SIGHUP, SIG_DFL);
    const auto stop = AwaitStopSignals();
    raise(SIGHUP);
    _exit(stop() ? 0 : 1);
  };
  EXPECT_EXIT(hang_up(), testing::ExitedWithCode(0), "");
  const auto ignore = [] {
    signal(SIGHUP, SIG_IGN);
    AwaitStopSignals();
    _exit(signal(SIGHUP, SIG_IGN) == SIG_IGN ? 0 : 1);
  };
  EXPECT_EXIT(ignore(), testing::ExitedWithCode(0), "");
}

TEST_F(ProgramTest, TerminationEndsWhatIsNotYetReady) {
  char name[] = "loading";
  char* arguments[] = {name};
  const auto run = [&] {
    signal(SIGTERM, SIG_DFL);  // Other tests in this process await it.
    Program(name, "").Run(1, arguments, [] { return raise(SIGTERM); });
  };
  EXPECT_EXIT(run(), testing::KilledBySignal(SIGTERM), "");
}

TEST_F(ProgramTest, OutputThatIsLostIsAFailureButNotForAReaderWhoHasEnough) {
  const auto run = [](int standard_output, const std::string& text) {
    std::fflush(stdout);
    dup2(standard_output, STDOUT_FILENO);
    char name[] = "writer";
    char* arguments[] = {name};
    std::exit(Program(name, "").Run(1, arguments, [&] {
      WriteOut(text);
      std::cout << text;
      return kExitOk;
    }));
  };
  const std::string long_text(1'000'000, 'x');  // more than is kept before it is written
  const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
  ASSERT_GE(full, 0);
  EXPECT_EXIT(run(full, "x"), testing::ExitedWithCode(kExitFailed),
              "^writer: failed: standard output could not be written: No space left on device\n$");
  EXPECT_EXIT(run(full, long_text), testing::ExitedWithCode(kExitFailed),
              "writer: failed: standard output could not be written");
  close(full);
  std::array<int, 2> ends = {};
  ASSERT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
  close(ends[0]);
  EXPECT_EXIT(run(ends[1], "x"), testing::ExitedWithCode(kExitOk), "^$");
  EXPECT_EXIT(run(ends[1], long_text), testing::ExitedWithCode(kExitOk), "^$");
  close(ends[1]);
}

TEST_F(ProgramTest, PackagePathsMayBeGivenSeveralTimes) {
  RobotFlags flags;
  flags.AddTo(&program_.app());
  const std::vector<std::string> arguments = {
      "--robot",        "r",        "--spheres",      "s.yaml",
      "--package-path", "fetch=/a", "--package-path", "other=/b/c"};
  Run(arguments, [&] {
    EXPECT_EQ(flags.spheres, "s.yaml");
    EXPECT_EQ(flags.Arguments(), arguments) << "handed on as they are";
    EXPECT_EQ(flags.package_paths.size(), 2u);
    return 0;
  });
  flags.package_paths = {"fetch"};
  ExpectInputError([&] { flags.Packages(); }, {"fetch"});
}

}  // namespace
}  // namespace planbench
