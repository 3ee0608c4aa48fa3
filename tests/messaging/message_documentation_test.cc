#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace planbench {
namespace {

namespace fs = std::filesystem;

std::string Read(const std::string& file) {
  std::ifstream stream(fs::path(PLANBENCH_SOURCE_DIR) / file);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// First groups of all matches.
std::set<std::string> FindAll(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) {
    found.insert((*it)[1]);
  }
  return found;
}

TEST(MessageDocumentation, TableHasEveryChannelAndNoOther) {
  const std::string header = Read("messaging/channels.h");
  std::set<std::string> channels = FindAll(header, "= \"([A-Z_]+)\"");
  channels.merge(FindAll(header, "///< ([A-Z_]+_<PLANNER>)"));
  EXPECT_GT(channels.size(), 15);
  EXPECT_EQ(FindAll(Read("lcmtypes/README.md"), "\n\\| `([A-Z_]+(<PLANNER>)?)` \\| `lcmt_"),
            channels);
}

TEST(MessageDocumentation, EveryTypeIsMentioned) {
  const std::set<std::string> mentioned = FindAll(Read("lcmtypes/README.md"), "`(lcmt_[a-z_]+)`");
  std::set<std::string> types;
  for (const auto& entry : fs::directory_iterator(fs::path(PLANBENCH_SOURCE_DIR) / "lcmtypes")) {
    if (entry.path().extension() == ".lcm") types.insert(entry.path().stem());
  }
  EXPECT_EQ(mentioned, types);
}

}  // namespace
}  // namespace planbench
