#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "messaging/messages.h"
#include "tests/messaging/message_examples.h"

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

/// The constants of an lcmt_ type whose names begin with `prefix`, as NAME -> value.
std::map<std::string, int> Constants(const std::string& type, const std::string& prefix) {
  const std::string text = Read("lcmtypes/" + type + ".lcm");
  std::map<std::string, int> constants;
  for (const std::string& list : FindAll(text, "const int8_t ([^;]*);")) {
    const std::regex regex("([A-Z_]+) = (\\d+)");
    for (std::sregex_iterator it(list.begin(), list.end(), regex), end; it != end; ++it) {
      const std::string name = (*it)[1];
      if (name.starts_with(prefix)) {
        constants[name.substr(prefix.size())] = std::stoi((*it)[2]);
      }
    }
  }
  return constants;
}

std::string InCapitals(std::string name) {
  for (char& c : name) c = c == ' ' || c == '-' ? '_' : static_cast<char>(std::toupper(c));
  return name;
}

/// The names of an enum as NAME_OF_VALUE -> value.
template <typename Enum>
std::map<std::string, int> Names() {
  std::map<std::string, int> names;
  for (const Enum value : EnumValues<Enum>()) {
    names[InCapitals(std::string(EnumName(value)))] = static_cast<int>(value);
  }
  return names;
}

TEST(MessageDocumentation, ConstantsAreTheEnums) {
  EXPECT_EQ(Constants("lcmt_plan_result", ""), Names<PlanStatus>());
  EXPECT_EQ(Constants("lcmt_plan_request", ""), Names<Direction>());
  EXPECT_EQ(Constants("lcmt_plan_ack", ""), Names<PlanAckVerdict>());
  EXPECT_EQ(Constants("lcmt_node_status", "KIND_"), Names<NodeKind>());
}

TEST(MessageDocumentation, ConstantsAreTheShapes) {
  std::map<std::string, int> shapes;
  for (const SceneObject& object : ExampleScene().objects) {
    for (const PlacedShape& placed : object.shapes) {
      shapes[InCapitals(ShapeTypeName(placed.shape))] = static_cast<int>(placed.shape.index());
    }
  }
  EXPECT_EQ(Constants("lcmt_shape", ""), shapes);
}

}  // namespace
}  // namespace planbench
