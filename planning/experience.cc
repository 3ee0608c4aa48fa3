#include "planning/experience.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <set>

#include "common/content_hash.h"
#include "common/named_file.h"

namespace planbench {

Experience::Experience(const Robot& robot, const YamlNode& setting) {
  const NamedFile file = ReadNamedFile(setting, robot.folder);
  library_ = ReadPathLibrary(YamlNode::Parse(file.text, file.path.string()), robot.groups);
  ContentHash hash;
  hash.Add(file.text);
  id_ = hash.HexDigest();
  if (library_.scenes.empty()) {
    spdlog::warn(
        "{}: scenes: is missing, so that tables know by the names of problem sets alone what it "
        "has learned from; make the file anew with learn_paths",
        file.path.string());
  }
}

void Experience::Describe(std::map<std::string, std::string>* settings) const {
  (*settings)["experience_id"] = id_;
  (*settings)[kLearnedFrom] = fmt::format("{}", fmt::join(library_.learned_from, ", "));
  std::set<std::string> scenes;
  for (const std::string& scene : library_.scenes) scenes.insert(ShortSceneId(scene));
  if (!scenes.empty()) (*settings)[kLearnedScenes] = fmt::format("{}", fmt::join(scenes, " "));
}

int ReadRecall(const YamlNode& node, const std::string& experience) {
  const int recall = node.IntWithin(1, 1000);
  if (experience.empty()) node.Fail("there is nothing to recall without 'experience'");
  return recall;
}

}  // namespace planbench
