#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "common/read_text.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

/// ./run and ./test in a checkout with stand-ins for the programs: the driver notes its arguments,
/// adds to the file $RESULTS and ends with the code $CODE, ctest and the report note theirs.
class EntryScriptsTest : public testing::Test {
 protected:
  EntryScriptsTest() {
    for (const char* script : {"run", "test"}) {
      fs::create_directories(checkout_);
      fs::copy(fs::path(PLANBENCH_SOURCE_DIR) / script, checkout_ / script);
    }
    fs::copy(fs::path(PLANBENCH_SOURCE_DIR) / "scripts", checkout_ / "scripts");
    for (const char* robot : {"fetch", "panda"}) {
      folder_.Write(fmt::format("checkout/robots/{}/robot.yaml", robot), "");
    }
    const std::string note =
        fmt::format("echo \"$(basename $0) $*\" >> {}\n", (folder_ / "notes").string());
    WriteProgram("checkout/build/release/bin/benchmark_driver",
                 note + "echo >> ${RESULTS:-/dev/null}\nexit ${CODE-0}\n");
    WriteProgram("checkout/build/release/bin/report", note);
    WriteProgram("bin/ctest", note);
    for (const char* program : {"cmake", "ip", "sysctl"}) {
      WriteProgram(fmt::format("bin/{}", program), "");
    }
    WriteProgram("bin/sudo", "exec \"$@\"\n");  // else the machine would be changed
  }

  void WriteProgram(const std::string& name, const std::string& body) {
    fs::permissions(folder_.Write(name, "#!/usr/bin/env bash\n" + body), fs::perms::owner_all);
  }

  /// Calls a script from the folder `here`. Exit code; what the stand-ins have noted is in notes_.
  int Call(const std::string& script, const std::vector<std::string>& arguments,
           const std::string& code = "0", const std::string& results = "") {
    fs::create_directories(folder_ / "here");
    fs::remove(folder_ / "notes");
    std::vector<std::string> command = {"bash",
                                        "-c",
                                        "cd \"$1\" && shift && exec \"$@\"",
                                        "bash",
                                        folder_ / "here",
                                        checkout_ / script};
    command.insert(command.end(), arguments.begin(), arguments.end());
    ChildProcess process(
        command, folder_ / "process",
        {{"PATH", fmt::format("{}:{}", (folder_ / "bin").string(), std::getenv("PATH"))},
         {"PLANBENCH_SKIP_INSTALL", "1"},
         {"CODE", code},
         {"RESULTS", results}});
    const int ended_with = process.Wait().value_or(-1);
    output_ = process.Output();
    errors_ = process.Errors();
    notes_ = fs::exists(folder_ / "notes") ? ReadText(folder_ / "notes") : "";
    return ended_with;
  }

  TemporaryFolder folder_;
  const fs::path checkout_ = fs::canonical(folder_.path()) / "checkout";
  std::string output_, errors_, notes_;
};

TEST_F(EntryScriptsTest, RobotsThatShipAreHiddenByRobotsAloneAndTheDefaultOneByNothing) {
  const auto robot = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> arguments = {"--problems", "sets"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    EXPECT_EQ(Call("run", arguments), 0) << errors_;
    const std::string rest = notes_.substr(notes_.find("--robot ") + 8);
    return fs::path(rest.substr(0, rest.find(' ')));
  };
  folder_.Write("here/fetch/notes.txt", "");
  folder_.Write("here/panda/robot.yaml", "");
  EXPECT_EQ(robot({"--robot", "fetch"}), checkout_ / "robots/fetch");
  EXPECT_EQ(robot({"--robot", "panda"}), fs::canonical(folder_ / "here/panda"));
  folder_.Write("here/fetch/robot.yaml", "");
  EXPECT_EQ(robot({}), checkout_ / "robots/fetch");
  EXPECT_EQ(robot({"--robot=fetch"}), fs::canonical(folder_ / "here/fetch"));

  EXPECT_EQ(Call("run", {"--robot", "nonsuch"}), 2);
  EXPECT_THAT(errors_, HasSubstr("run: --robot nonsuch: there is no such folder"));
  EXPECT_THAT(errors_, HasSubstr("those are: fetch panda\n"));
  EXPECT_EQ(notes_, "");
}

TEST_F(EntryScriptsTest, OtherFlagsChangeWhatQuickAndStudySayInWhicheverOrder) {
  const auto flags = [&](const std::vector<std::string>& arguments) {
    EXPECT_EQ(Call("run", arguments), 0) << errors_;
    return notes_.substr(notes_.find(" --lineup"));
  };
  const auto both_orders = [&](const std::string& preset, const std::vector<std::string>& others) {
    std::vector<std::string> before = {preset}, behind = others;
    before.insert(before.end(), others.begin(), others.end());
    behind.push_back(preset);
    const std::string told = flags(before);
    EXPECT_EQ(flags(behind), told);
    return told;
  };
  const std::string line_ups = (checkout_ / "lineups").string();
  EXPECT_EQ(
      both_orders("--quick", {"--trials", "5", "--problems", "sets"}),
      fmt::format(" --lineup {}/default.yaml --time 1 --trials 5 --problems sets\n", line_ups));
  EXPECT_EQ(
      both_orders("--study", {"--time", "10", "--problems", "sets"}),
      fmt::format(" --lineup {}/study.yaml --trials 1 --time 10 --problems sets\n", line_ups));
}

TEST_F(EntryScriptsTest, TheUsageSaysThatRobotsThatShipAreTakenByName) {
  EXPECT_EQ(Call("run", {"--help"}), 0) << errors_;
  for (const char* flag : {"--robot panda", "--referee-robot ROBOT"}) {
    const std::size_t at = output_.find(fmt::format("  ./run {} ", flag));
    ASSERT_NE(at, std::string::npos) << flag;
    EXPECT_THAT(output_.substr(at, output_.find("\n  ./run", at) - at), HasSubstr("that ships by"));
  }
  EXPECT_EQ(Call("run", {"--problems", "sets", "--referee-robot", "panda"}), 0) << errors_;
  EXPECT_THAT(notes_, HasSubstr(" --referee-robot panda\n")) << "the driver finds it";
}

TEST_F(EntryScriptsTest, WhatTheDriverMadeIsReportedHoweverItEndedAndNothingElse) {
  folder_.Write("here/old/results.sqlite", "");
  fs::create_directories(folder_ / "here/new");
  for (const char* code : {"0", "1", "2"}) {
    EXPECT_EQ(Call("run", {"--problems", "sets", "--out", "old"}, code), std::stoi(code));
    EXPECT_THAT(notes_, testing::Not(HasSubstr("report"))) << "refused to replace it";
    for (const char* folder : {"old", "new"}) {
      const std::string results = fmt::format("{}/results.sqlite", folder);
      EXPECT_EQ(Call("run", {"--problems", "sets", "--out", folder}, code, results),
                std::stoi(code));
      EXPECT_THAT(notes_, HasSubstr(fmt::format("report {0} --out {0}/report.html\n", folder)));
    }
    fs::remove(folder_ / "here/new/results.sqlite");
  }
}

TEST_F(EntryScriptsTest, AMisspeltPresetIsRefused) {
  EXPECT_EQ(Call("test", {"relase"}), 2);
  EXPECT_THAT(errors_, StartsWith("test: relase: no preset of that name"));
  EXPECT_EQ(notes_, "");
  EXPECT_EQ(Call("test", {"asan", "-R", "scene"}), 0) << errors_;
  EXPECT_THAT(notes_, StartsWith("ctest --preset asan -j "));
  EXPECT_EQ(Call("test", {"-R", "scene"}), 0) << errors_;
  EXPECT_THAT(notes_, StartsWith("ctest --preset release -j "));
  EXPECT_THAT(notes_, HasSubstr(" -R scene\n"));
}

/// What functions of scripts/setup.sh print to stdout and stderr, `before` having been said.
std::string Prepared(const std::string& before, const std::string& function) {
  const TemporaryFolder folder;
  ChildProcess bash({"bash", "-c",
                     "set -euo pipefail; . '" PLANBENCH_SOURCE_DIR "/scripts/setup.sh'; " + before +
                         "; " + function + " 2>&1; echo went on"},
                    folder / "bash");
  EXPECT_EQ(bash.Wait(), 0) << bash.Errors();
  return bash.Output();
}

TEST(SetUpScript, GoesOnWithoutWhatItCannotHave) {
  const std::string nothing_is_installed = "command() { return 1; }";
  const std::string buffer =
      Prepared(nothing_is_installed + "; cat() { echo 212992; }; id() { echo 1000; }",
               "ensure_receive_buffer");
  EXPECT_THAT(buffer, HasSubstr("needs root for: sysctl"));
  EXPECT_THAT(buffer, HasSubstr("could not raise it"));
  EXPECT_THAT(buffer, HasSubstr("went on"));
  const std::string multicast = Prepared(nothing_is_installed, "ensure_multicast");
  EXPECT_THAT(multicast, HasSubstr("no program ip"));
  EXPECT_THAT(multicast, HasSubstr("went on"));
}

}  // namespace
}  // namespace planbench
