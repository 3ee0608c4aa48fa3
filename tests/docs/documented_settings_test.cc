#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include "common/error.h"
#include "planner_ara/ara_planner.h"
#include "planner_rrtc/rrtc_planner.h"
#include "planner_trajopt/trajopt_planner.h"
#include "planning/planner_settings.h"
#include "tests/support/planning_problems.h"

// Every --set that the documentation shows, and every NAME.KEY=VALUE, is one that its planner
// takes.
namespace planbench {
namespace {

namespace fs = std::filesystem;

using Factory = std::unique_ptr<Planner> (*)(const Robot&, const YamlNode&);
const std::map<std::string, Factory> kFactories = {
    {"ara", MakeAraPlanner}, {"rrtc", MakeRrtcPlanner}, {"trajopt", MakeTrajoptPlanner}};

struct ShownSetting {
  fs::path document;
  std::string algorithm;  ///< Of the --algorithm before it; empty: none.
  std::string key;        ///< As the planner takes it, or the driver.
  std::string value;

  /// Whether the reader is to put something in place of the value.
  bool HasPlaceholder() const {
    return value.starts_with('$') || std::none_of(value.begin(), value.end(), [](unsigned char c) {
             return std::islower(c) || std::isdigit(c);
           });
  }
};

std::vector<ShownSetting> SettingsOf(const fs::path& document) {
  std::ifstream file(document);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  static const std::regex kFlag(R"((?:--algorithm (\w+) )?(?:--set\s+|NAME\.)([\w.]+)=([^\s`]+))");
  static const std::regex kForm("key|KEY|NAME\\.KEY");
  std::vector<ShownSetting> shown;
  for (std::sregex_iterator it(text.begin(), text.end(), kFlag), end; it != end; ++it) {
    if (std::regex_match((*it)[2].str(), kForm)) continue;
    shown.push_back({document, (*it)[1], (*it)[2], (*it)[3]});
  }
  return shown;
}

std::vector<ShownSetting> AllSettings() {
  const fs::path root = PLANBENCH_SOURCE_DIR;
  std::vector<fs::path> documents = {root / "README.md", root / "CONTRIBUTING.md"};
  for (const auto& entry : fs::directory_iterator(root / "docs")) {
    if (entry.path().extension() == ".md") documents.push_back(entry.path());
  }
  std::vector<ShownSetting> all;
  for (const fs::path& document : documents) {
    const std::vector<ShownSetting> shown = SettingsOf(document);
    all.insert(all.end(), shown.begin(), shown.end());
  }
  return all;
}

/// The planner whose setting it is: the one that the key begins with, as the driver has it, which
/// is taken off; else the one with OMPL's settings, or the one that the document is about.
std::string TakePlanner(ShownSetting* shown) {
  const std::size_t dot = shown->key.find('.');
  const std::string first = shown->key.substr(0, dot);
  if (dot != std::string::npos && kFactories.contains(first)) {
    shown->key = shown->key.substr(dot + 1);
    return first;
  }
  return first == "ompl" ? "rrtc" : shown->document.stem().string();
}

TEST(DocumentedSettings, AreTaken) {
  const Robot robot = LoadPlanarRobot();
  int of_ompl = 0;
  for (ShownSetting shown : AllSettings()) {
    SCOPED_TRACE(shown.document.string() + ": --set " + shown.key + "=" + shown.value);
    const std::string planner = TakePlanner(&shown);
    ASSERT_TRUE(kFactories.contains(planner)) << "which planner's?";
    std::vector<std::string> overrides = {shown.key + "=" + shown.value};
    if (shown.key.starts_with("ompl.")) {
      ++of_ompl;
      if (shown.algorithm.empty()) shown.algorithm = "RRT";  // Of a NAME that runs one of OMPL's.
    }
    if (!shown.algorithm.empty()) overrides.push_back("algorithm=" + shown.algorithm);
    try {
      kFactories.at(planner)(robot, LoadPlannerSettings(robot, planner, "", overrides));
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_TRUE(shown.HasPlaceholder()) << message;
      EXPECT_EQ(message.find("unknown key"), std::string::npos) << message;
    }
  }
  EXPECT_GE(of_ompl, 3) << "docs/rrtc.md, docs/lineups.md and CONTRIBUTING.md show one each";
}

}  // namespace
}  // namespace planbench
