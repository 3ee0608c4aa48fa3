#include "benchmark_driver/session_folder.h"

#include <gtest/gtest.h>

#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

TEST(EventLogOfTest, IsTheOnlyLogOfTheFolder) {
  const TemporaryFolder folder;
  folder.Write("results.sqlite", "");
  folder.Write("logs/other.lcmlog", "");
  const std::filesystem::path log = folder.Write("session.lcmlog", "");
  EXPECT_EQ(EventLogOf(folder.path()), log);
}

TEST(EventLogOfTest, MissingFolderLogOrChoiceIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  ExpectInputError([&] { EventLogOf(path + "/missing"); }, {"--resume", path + "/missing"});
  ExpectInputError([&] { EventLogOf(path); }, {"--resume", path, "no .lcmlog"});
  folder.Write("a.lcmlog", "");
  folder.Write("b.lcmlog", "");
  ExpectInputError([&] { EventLogOf(path); }, {"--resume", path, "several"});
}

TEST(RequireSameConditionsTest, OnlyWhatIsRunMayChange) {
  SessionMessage earlier;
  earlier.settings = {{"time_limit_s", "60"}, {"seed", "1"}, {"trials", "1"}, {"planners", "a"}};
  auto settings = earlier.settings;
  EXPECT_NO_THROW(RequireSameConditions(earlier, settings));
  settings["trials"] = "3";
  settings["planners"] = "a,b";
  settings["problems_range"] = "1-5";
  EXPECT_NO_THROW(RequireSameConditions(earlier, settings));
  settings["time_limit_s"] = "10";
  ExpectInputError([&] { RequireSameConditions(earlier, settings); },
                   {"--resume", "time_limit_s", "'60'", "'10'"});
  settings = earlier.settings;
  settings["collision_model"] = "meshes";
  ExpectInputError([&] { RequireSameConditions(earlier, settings); },
                   {"collision_model", "''", "'meshes'"});
}

}  // namespace
}  // namespace planbench
