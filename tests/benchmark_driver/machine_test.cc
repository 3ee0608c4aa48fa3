#include "benchmark_driver/machine.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "collision/collision_checker.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

class MachineTest : public testing::Test {
 protected:
  KernelFolders Kernel() const { return {folder_ / "proc", folder_ / "sys"}; }
  /// ns that two threads of process 7 waited, and ticks that were stolen.
  void Write(long first_ns, long second_ns, long ticks) {
    folder_.Write("proc/7/task/7/schedstat", fmt::format("5 {} 1\n", first_ns));
    folder_.Write("proc/7/task/8/schedstat", fmt::format("9 {} 3\n", second_ns));
    folder_.Write("proc/stat", fmt::format("cpu  1 2 3 4 5 6 7 {} 9 9\ncpu0 1\n", ticks));
  }

  TemporaryFolder folder_;
};

TEST_F(MachineTest, IsDescribedAsFarAsItTells) {
  folder_.Write("proc/cpuinfo", "processor\t: 0\nmodel name\t: Fast CPU\n");
  folder_.Write("proc/loadavg", "0.50 1.00 2.00 1/99 7\n");
  folder_.Write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave\n");
  folder_.Write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance\n");
  const auto machine = DescribeMachine(Kernel());
  EXPECT_EQ(machine.at("cpu"), fmt::format("Fast CPU [{}]", VectorInstructions()));
  EXPECT_EQ(machine.at("load"), "0.50 1.00 2.00");
  EXPECT_EQ(machine.at("governor"), "performance, powersave");
  EXPECT_GE(std::stoi(machine.at("processors")), 1);

  const auto silent = DescribeMachine({folder_ / "none", folder_ / "none"});
  EXPECT_EQ(silent.at("cpu"), fmt::format("unknown [{}]", VectorInstructions()));
  EXPECT_FALSE(silent.contains("load"));
  EXPECT_FALSE(silent.contains("governor"));
}

TEST_F(MachineTest, ProcessorsWithoutANameHaveNumbers) {
  std::string cores;
  for (const char* part : {"0xd40", "0xd05", "0xd40"}) {
    cores += fmt::format("processor\t: 0\nCPU implementer\t: 0x41\nCPU part\t: {}\n\n", part);
  }
  folder_.Write("proc/cpuinfo", cores);
  EXPECT_EQ(DescribeMachine(Kernel()).at("cpu"),
            fmt::format("ARM implementer 0x41 part 0xd05, ARM implementer 0x41 part 0xd40 [{}]",
                        VectorInstructions()));
}

TEST_F(MachineTest, AMeterTellsWhatHappenedSinceItBegan) {
  folder_.Write("proc/loadavg", "0.50 1.00 2.00 1/99 7\n");
  Write(1'000'000'000, 2'000'000'000, 300);
  const DisturbanceMeter meter({7}, Kernel());
  Write(1'250'000'000, 2'500'000'000, 300 + sysconf(_SC_CLK_TCK) * sysconf(_SC_NPROCESSORS_ONLN));
  folder_.Write("proc/7/task/9/schedstat", "0 125000000 1\n");  // came meanwhile
  folder_.Write("proc/loadavg", "3.00 1.00 2.00 1/99 7\n");
  // What a planner says of it counts for nothing.
  std::map<std::string, double> counters = {
      {"states", 3}, {"waiting_time", 9}, {"disturbed", 1}, {"repeats", 2}};
  meter.Read(1, &counters);
  EXPECT_EQ(counters,
            (std::map<std::string, double>{
                {"load_before", 0.5}, {"states", 3}, {"steal_time", 1}, {"waiting_time", 0.875}}));
}

TEST_F(MachineTest, AWaitThatBeganBeforeTheRunIsNoLongerThanTheRun) {
  Write(0, 0, 0);
  const DisturbanceMeter meter({7}, Kernel());
  Write(9'000'000'000, 250'000'000, 0);
  std::map<std::string, double> counters;
  meter.Read(0.5, &counters);
  EXPECT_EQ(counters.at("waiting_time"), 0.75);
}

TEST_F(MachineTest, OfAnotherMachineNothingIsKnown) {
  Write(1, 2, 3);
  std::map<std::string, double> counters;
  DisturbanceMeter({}, Kernel()).Read(1, &counters);
  EXPECT_EQ(counters, (std::map<std::string, double>{{"steal_time", 0}}));
  counters.clear();
  DisturbanceMeter({7}, {folder_ / "none", folder_ / "none"}).Read(1, &counters);
  EXPECT_TRUE(counters.empty());
}

TEST_F(MachineTest, TheKernelTellsOfThisProcess) {
  std::map<std::string, double> counters;
  DisturbanceMeter({getpid()}, {}).Read(1, &counters);
  EXPECT_GE(counters.at("load_before"), 0);
  EXPECT_GE(counters.at("waiting_time"), 0);
  EXPECT_GE(counters.at("steal_time"), 0);
}

TEST_F(MachineTest, DisturbedIsWhatCouldNotWorkForLong) {
  EXPECT_FALSE(IsDisturbed({}, 1, 0.1));
  EXPECT_FALSE(IsDisturbed({{"waiting_time", 0.04}, {"steal_time", 0.05}}, 1, 0.1));
  EXPECT_TRUE(IsDisturbed({{"waiting_time", 0.06}, {"steal_time", 0.05}}, 1, 0.1));
  // A thread that is woken waits a little, however short the run.
  EXPECT_FALSE(IsDisturbed({{"waiting_time", 0.0009}}, 0.001, 0.1));
  EXPECT_TRUE(IsDisturbed({{"waiting_time", 0.0011}}, 0.001, 0.1));
}

TEST_F(MachineTest, AThreadCanBeKeptToProcessors) {
  const std::vector<int> all = UsableProcessors();
  ASSERT_FALSE(all.empty());
  ASSERT_TRUE(UseProcessors({all.back()}));
  EXPECT_EQ(UsableProcessors(), std::vector<int>{all.back()});
  ASSERT_TRUE(UseProcessors(all));
  EXPECT_EQ(UsableProcessors(), all);
  EXPECT_FALSE(UseProcessors({}));
}

}  // namespace
}  // namespace planbench
