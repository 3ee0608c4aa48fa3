#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "messaging/lcm_url.h"
#include "tests/pipeline/pipeline_fixture.h"
#include "tests/support/own_network.h"

namespace planbench {
namespace {

/// Two hosts on a wire: network namespaces, each with a name and, if the test wants, clocks of its
/// own.
class TwoHosts : public PipelineTest {
 protected:
  TwoHosts()
      : PipelineTest(
            fmt::format("udpm://239.255.76.67:{}?ttl=1&recv_buf_size=4194304", FreeUdpPort())) {}
  ~TwoHosts() override {
    for (const char* host : kHosts) RunsInShell("ip netns del " + Namespace(host));
  }

  void SetUp() override {
    std::string commands;
    for (const char* host : kHosts) commands += fmt::format("ip netns add {} && ", Namespace(host));
    commands += fmt::format("ip -n {0} link add wire type veth peer name wire netns {1}",
                            Namespace(kHosts[0]), Namespace(kHosts[1]));
    for (const char* host : kHosts) {
      commands += fmt::format(
          " && ip -n {0} link set lo up && ip -n {0} link set wire up && ip -n {0} address add "
          "10.9.8.{1}/24 dev wire && ip -n {0} route add 224.0.0.0/4 dev wire",
          Namespace(host), host == kHosts[0] ? 1 : 2);
    }
    if (!RunsInShell(commands)) GTEST_SKIP() << "needs root and network namespaces";
  }

  ChildProcess* StartOn(const std::string& host, const std::vector<std::string>& arguments,
                        const std::vector<std::string>& clock = {}) {
    std::vector<std::string> command = {"ip", "netns", "exec", Namespace(host), "unshare", "--uts"};
    command.insert(command.end(), clock.begin(), clock.end());
    command.insert(command.end(),
                   {"sh", "-c", "echo $0 >/proc/sys/kernel/hostname; exec \"$@\"", host});
    command.insert(command.end(), arguments.begin(), arguments.end());
    return Start(command);
  }

  static std::vector<std::string> SceneServer() {
    return {Program("scene_server"), "--robot", RobotFolder(), "--problems", ProblemFolder()};
  }
  /// In a process's environment: the time of day of a clock of its own.
  static std::string AnotherTime() {
    const bool is_sanitized = !std::string(PLANBENCH_SANITIZED).empty();
    return std::string("LD_PRELOAD=") + (is_sanitized ? "" : PLANBENCH_ANOTHER_TIME);
  }

  static constexpr std::array kHosts = {"office", "robot"};

  static std::string Namespace(const std::string& host) {
    return fmt::format("{}-{}", host, getpid());
  }
};

TEST_F(TwoHosts, ASessionRunsOverBothAndMixesNoClocks) {
  // Steady clocks eleven days apart, the time of day one hour.
  const std::vector<std::string> another_clock = {"--time", "--fork", "--kill-child",
                                                  "--monotonic=1000000"};
  const auto session = folder() / "session";
  for (const std::string kind : {"ara", "rrtc"}) {
    StartOn("robot", {"env", AnotherTime(), Program("planner_" + kind), "--robot", RobotFolder()},
            another_clock);
  }
  StartOn("office", SceneServer());
  StartOn("office", {Program("logger"), "--out", session.string()});
  ASSERT_TRUE(WaitUntil([&] { return Query(session, "SELECT count(*) FROM runs") == 0; }));
  ChildProcess* driver = StartOn("office", {Program("benchmark_driver"), "--discovery-timeout",
                                            "60", "--problems-range", "1-2", "--time", "30"});
  ASSERT_EQ(driver->Wait(), 0) << driver->Errors();
  for (const int pid : LeftRunning()) kill(pid, SIGINT);
  EXPECT_TRUE(WaitUntil([&] { return LeftRunning().empty(); }));

  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs WHERE solved AND referee_valid"), 4);
  EXPECT_EQ(Query(session,
                  "SELECT count(*) FROM runs WHERE time BETWEEN 0 AND roundtrip_time AND "
                  "roundtrip_time < 30"),
            4);
  // What a process on the other host waits for cannot be seen from here.
  EXPECT_EQ(Query(session, "SELECT count(*) FROM runs WHERE waiting_time IS NOT NULL"), 0);
  std::map<std::string, std::string> hosts;
  const auto info = nlohmann::json::parse(std::ifstream(session / "run.json"));
  for (const auto& node : info.at("sessions").at(0).at("nodes"))
    hosts[node.at("name")] = node.at("host");
  EXPECT_EQ(hosts["ara"], "robot");
  EXPECT_EQ(hosts["rrtc"], "robot");
  EXPECT_EQ(hosts["scene_server"], "office");
}

TEST_F(TwoHosts, ASecondDriverIsRefusedWhateverItsClock) {
  const std::vector<std::string> driver = {Program("benchmark_driver"), "--discovery-timeout", "60",
                                           "--planners", "rrtc"};
  std::vector<std::string> later = driver;
  later.insert(later.begin(), {"env", AnotherTime()});
  ChildProcess* first = StartOn("office", driver);
  ASSERT_TRUE(WaitUntil([&] { return first->Errors().find("waiting for") != std::string::npos; }));
  ChildProcess* second = StartOn("robot", later);
  EXPECT_EQ(second->Wait(), 2);
  EXPECT_NE(second->Errors().find("the driver 'driver' is live already (host office"),
            std::string::npos)
      << second->Errors();
  first->Signal(SIGINT);
  first->Wait();
}

TEST_F(TwoHosts, AnotherRobotOnOneOfThemIsRefused) {
  StartOn("robot", {Program("planner_rrtc"), "--robot",
                    std::string(PLANBENCH_SOURCE_DIR) + "/robots/panda"});
  StartOn("office", SceneServer());
  ExpectBadInput(StartOn("office", {Program("benchmark_driver"), "--discovery-timeout", "60",
                                    "--planners", "rrtc"}),
                 "another robot than the scene server");
}

TEST_F(TwoHosts, TheDoctorOnOneTellsWhatReachesIt) {
  StartOn("office", SceneServer());
  const auto doctor = [&](const std::string& bus) {
    ChildProcess* process = StartOn("robot", {Program("bus_doctor"), "--lcm-url", bus});
    process->Wait();
    return process->Output() + process->Errors();
  };
  std::string said;
  EXPECT_TRUE(WaitUntil([&] {
    said = doctor(url());
    return said.find("1 of them on other machines") != std::string::npos;
  })) << said;
  EXPECT_THAT(said, testing::HasSubstr("messages leave this machine by 'wire' (MTU 1500 bytes)"));
  std::string staying = url();
  staying.replace(staying.find("ttl=1"), 5, "ttl=0");
  EXPECT_THAT(doctor(staying),
              testing::AllOf(testing::HasSubstr("does not hear this process"),
                             testing::HasSubstr("FAULT  reach: scene_server (10.9.8.1:")));
  ASSERT_TRUE(
      RunsInShell(fmt::format("ip -n {0} link set lo multicast on && "
                              "ip -n {0} route replace 224.0.0.0/4 dev lo",
                              Namespace("robot"))));
  EXPECT_THAT(doctor(url()),
              testing::AllOf(testing::HasSubstr("FAULT  reach: ttl=1, but the multicast route goes "
                                                "by 'lo'"),
                             testing::HasSubstr("ip route replace 224.0.0.0/4 dev wire")));
}

}  // namespace
}  // namespace planbench
