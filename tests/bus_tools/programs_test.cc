#include <gmock/gmock.h>

#include "messaging/bus.h"
#include "messaging/channels.h"
#include "tests/support/child_process.h"
#include "tests/support/private_bus.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait_until.h"

namespace planbench {
namespace {

using testing::HasSubstr;
using testing::Not;

class BusEchoTest : public testing::Test {
 protected:
  BusEchoTest() : bus_(url_) { bus_.Start(); }

  ChildProcess Echo(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {PLANBENCH_BIN_DIR "/bus_echo", "--lcm-url", url_});
    return ChildProcess(arguments, folder_.path() / "echo");
  }
  /// Says things until the program has ended.
  std::optional<int> SpeakTo(ChildProcess* echo) {
    WaitUntil([&] {
      bus_.Publish(channel::kDiscover, DiscoverMessage{.sender = "me"});
      bus_.Publish(channel::kProblemSets, ProblemSetsMessage{});
      return !echo->Running();
    });
    return echo->Wait(std::chrono::seconds(0));
  }

  const std::string url_ = PrivateUdpUrl();
  TemporaryFolder folder_;
  Bus bus_;
};

TEST_F(BusEchoTest, PrintsMessagesOfTheChannelsAskedFor) {
  ChildProcess echo = Echo({"DISC.*", "--count", "2"});
  EXPECT_EQ(SpeakTo(&echo), 0) << echo.Errors();
  EXPECT_THAT(echo.Output(), HasSubstr("DISCOVER  lcmt_discover, "));
  EXPECT_THAT(echo.Output(), HasSubstr("sender: \"me\""));
  EXPECT_THAT(echo.Output(), Not(HasSubstr("PROBLEM_SETS")));
}

TEST_F(BusEchoTest, TellsRates) {
  ChildProcess echo = Echo({"--rates", "--count", "1"});
  EXPECT_EQ(SpeakTo(&echo), 0) << echo.Errors();
  EXPECT_THAT(echo.Output(), HasSubstr("messages/s"));
  EXPECT_THAT(echo.Output(), HasSubstr("\nPROBLEM_SETS"));
  EXPECT_THAT(echo.Output(), HasSubstr("lost: "));
}

TEST_F(BusEchoTest, EndsAtSigterm) {
  ChildProcess echo = Echo({});
  ASSERT_TRUE(WaitUntil([&] {
    bus_.Publish(channel::kDiscover, DiscoverMessage{.sender = "me"});
    return !echo.Output().empty();
  }));
  echo.Signal(SIGTERM);
  EXPECT_EQ(echo.Wait(), 0);
}

TEST_F(BusEchoTest, RefusesABadPattern) {
  ChildProcess echo = Echo({"[A"});
  EXPECT_EQ(echo.Wait(), 2);
  EXPECT_THAT(echo.Errors(), HasSubstr("'[A' is no regular expression"));
}

TEST_F(BusEchoTest, RefusesACountThatIsNone) {
  ChildProcess echo = Echo({"--count", "0"});
  EXPECT_EQ(echo.Wait(), 2);
  EXPECT_THAT(echo.Errors(), HasSubstr("--count: Value 0 not in range 1 to 2147483647 (see"));
}

TEST(BusDoctorTest, SaysWhatIsGoodAndEndsWithZero) {
  TemporaryFolder folder;
  ChildProcess doctor({PLANBENCH_BIN_DIR "/bus_doctor", "--lcm-url", PrivateUdpUrl()},
                      folder.path() / "doctor");
  const std::optional<int> code = doctor.Wait();
  const bool healthy = doctor.Output().find("FAULT") == std::string::npos;
  EXPECT_EQ(code, healthy ? 0 : 1) << doctor.Errors();
  EXPECT_THAT(doctor.Output(), HasSubstr("good   route: "));
  EXPECT_THAT(doctor.Output(), HasSubstr("messages of 1 kB"));
}

}  // namespace
}  // namespace planbench
