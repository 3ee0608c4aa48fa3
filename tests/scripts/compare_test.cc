#include <gmock/gmock.h>

#include <filesystem>
#include <regex>

#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// benchmarks/compare with stand-ins for planner_benchmark, whose first three problems take `ms` 1,
/// 2 and 3 times; of the others one is not solved, and the path of one the referee rejects.
class CompareTest : public testing::Test {
 protected:
  CompareTest() {
    for (const char* set : {"box", "cage"}) {
      folder_.Write(std::string("sets/") + set + "/scene0001.yaml", "");
    }
    WriteBuild("a", 2, 100);
    WriteBuild("b", 1, 300);
  }

  void WriteBuild(const std::string& name, double ms, int configurations) {
    const fs::path program = folder_.Write(
        name + "/benchmarks/planner_benchmark",
        "#!/usr/bin/env bash\nset -eu\n"
        "while [ $# -gt 1 ]; do case $1 in --csv) csv=$2 ;; --problems) set=$(basename $2) ;; "
        "esac; "
        "shift; done\n"
        "{ echo set,direction,problem,status,referee_valid,planning_ms,counters\n"
        "for i in 1 2 3; do echo $set,forward,$i,SOLVED,1,$(awk \"BEGIN {print $i * " +
            std::to_string(ms) +
            "}\"),edges_checked=5 configurations_checked=" + std::to_string(configurations) +
            "; done\necho $set,forward,4,TIMED_OUT,0,99,configurations_checked=1\n"
            "echo $set,forward,5,SOLVED,0,0.1,configurations_checked=1; } > $csv\n");
    fs::permissions(program, fs::perms::owner_all);
  }

  int Compare(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), PLANBENCH_SOURCE_DIR "/benchmarks/compare");
    ChildProcess program(arguments, folder_ / "compare");
    const int code = program.Wait().value_or(-1);
    output_ = std::regex_replace(program.Output(), std::regex(" +"), " ");
    errors_ = program.Errors();
    return code;
  }

  TemporaryFolder folder_;
  std::string output_, errors_;
};

TEST_F(CompareTest, TellsTimesAndRatios) {
  ASSERT_EQ(Compare({folder_ / "a", folder_ / "b", "--rounds", "2", "--planners", "rrtc",
                     folder_ / "sets"}),
            0)
      << errors_;
  for (const char* set : {"box", "cage"}) {
    EXPECT_THAT(output_, HasSubstr(std::string("rrtc ") + set +
                                   " 3 3 4.000 4.000 6.00 0.50 0.50 0.50 3.00\n"));
  }
  EXPECT_THAT(output_, HasSubstr("rrtc all 6 6 4.000 4.000 6.00 0.50 0.50 0.50 3.00\n"));
}

TEST_F(CompareTest, SetsMayHaveOneNameAndCommas) {
  for (const char* set : {"mine/box", "theirs/box", "c,d"}) {
    folder_.Write(std::string(set) + "/scene0001.yaml", "");
  }
  ASSERT_EQ(Compare({folder_ / "a", folder_ / "b", "--rounds", "1", "--planners", "rrtc",
                     folder_ / "mine", folder_ / "theirs/box", folder_ / "c,d"}),
            0)
      << errors_;
  const std::string figures = " 3 3 4.000 4.000 6.00 0.50 0.50 0.50 3.00\n";
  EXPECT_THAT(output_, HasSubstr("mine/box" + figures));
  EXPECT_THAT(output_, HasSubstr("theirs/box" + figures));
  EXPECT_THAT(output_, HasSubstr("rrtc c,d" + figures));
  EXPECT_THAT(output_, HasSubstr("rrtc all 9 9 "));
}

TEST_F(CompareTest, RefusesBadUseInOneLine) {
  const std::string a = folder_ / "a";
  EXPECT_EQ(Compare({a, a}), 2);
  EXPECT_THAT(errors_, HasSubstr("two build folders and a problem set are needed"));
  EXPECT_EQ(Compare({a, folder_ / "nowhere", folder_ / "sets"}), 2);
  EXPECT_THAT(errors_, HasSubstr("nowhere: no benchmarks/planner_benchmark"));
  EXPECT_EQ(Compare({a, a, folder_ / "a"}), 2);
  EXPECT_THAT(errors_, HasSubstr("no problem set"));
  EXPECT_EQ(Compare({a, a, "--rounds", "x", folder_ / "sets"}), 2);
  EXPECT_THAT(errors_, HasSubstr("--rounds"));
}

}  // namespace
}  // namespace planbench
