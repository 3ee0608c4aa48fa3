#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

// The rules that keep the rooms apart (docs/architecture.md), checked on what the sources include.
namespace planbench {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kProcesses = {"scene_server", "planner_ara", "planner_rrtc",
                                             "benchmark_driver", "logger"};

/// What a room may include besides itself.
const std::map<std::string, std::set<std::string>>& MayInclude() {
  static const std::map<std::string, std::set<std::string>> rules = [] {
    std::map<std::string, std::set<std::string>> rooms;
    rooms["common"] = {};
    rooms["geometry"] = {"common"};
    rooms["results"] = {"common"};
    rooms["robot_model"] = {"common", "geometry"};
    rooms["scene"] = {"common", "geometry"};
    rooms["collision"] = {"common", "geometry", "robot_model", "scene"};
    rooms["planning"] = rooms["collision"];
    rooms["planning"].insert("collision");
    rooms["problem_generator"] = rooms["planning"];
    rooms["messaging"] = rooms["planning"];
    rooms["messaging"].insert("planning");
    for (const std::string& process : kProcesses) {
      rooms[process] = rooms["messaging"];
      rooms[process].insert("messaging");
    }
    rooms["benchmark_driver"].insert("results");
    return rooms;
  }();
  return rules;
}

struct Source {
  fs::path path;  // below the checkout
  std::string room;
  std::string text;
};

std::vector<Source> Sources() {
  std::vector<Source> sources;
  for (const auto& [room, allowed] : MayInclude()) {
    const fs::path root = fs::path(PLANBENCH_SOURCE_DIR) / room;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cc") continue;
      std::ifstream file(entry.path());
      sources.push_back({fs::relative(entry.path(), PLANBENCH_SOURCE_DIR), room,
                         std::string(std::istreambuf_iterator<char>(file), {})});
    }
  }
  return sources;
}

std::vector<std::string> Includes(const Source& source) {
  static const std::regex include(R"(#include\s*[<"]([^>"]+)[>"])");
  std::vector<std::string> includes;
  for (std::sregex_iterator it(source.text.begin(), source.text.end(), include), end; it != end;
       ++it) {
    includes.push_back((*it)[1]);
  }
  return includes;
}

TEST(Structure, RoomsIncludeOnlyWhatIsBelowThem) {
  int checked = 0;
  for (const Source& source : Sources()) {
    for (const std::string& include : Includes(source)) {
      const std::string room = include.substr(0, include.find('/'));
      if (room == source.room || MayInclude().count(room) == 0) continue;
      ++checked;
      EXPECT_TRUE(MayInclude().at(source.room).count(room))
          << source.path << " includes " << include;
    }
  }
  EXPECT_GT(checked, 100);
}

TEST(Structure, LcmStaysInMessagingAndLogger) {
  for (const Source& source : Sources()) {
    if (source.room == "messaging" || source.room == "logger") continue;
    for (const std::string& include : Includes(source)) {
      EXPECT_NE(include.rfind("lcm/", 0), 0U) << source.path << " includes " << include;
      EXPECT_EQ(include.find("lcmt_"), std::string::npos) << source.path << " includes " << include;
    }
    EXPECT_FALSE(std::regex_search(source.text, std::regex(R"(\blcmt_\w+\s+\w+[;({])")))
        << source.path << " uses a wire type";
  }
}

TEST(Structure, OmplStaysInPlannerRrtc) {
  for (const Source& source : Sources()) {
    if (source.room == "planner_rrtc") continue;
    for (const std::string& include : Includes(source)) {
      EXPECT_NE(include.rfind("ompl/", 0), 0U) << source.path << " includes " << include;
    }
  }
}

TEST(Structure, HeavyLibrariesStayOutOfHeaders) {
  for (const Source& source : Sources()) {
    if (source.path.extension() != ".h" || source.room == "planner_rrtc") continue;
    for (const std::string& include : Includes(source)) {
      EXPECT_NE(include.rfind("fcl/", 0), 0U) << source.path << " includes " << include;
      EXPECT_NE(include.rfind("ompl/", 0), 0U) << source.path << " includes " << include;
    }
  }
}

}  // namespace
}  // namespace planbench
