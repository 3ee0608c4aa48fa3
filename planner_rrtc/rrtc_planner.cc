#include "planner_rrtc/rrtc_planner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <optional>
#include <utility>

#include "common/content_hash.h"
#include "common/error.h"
#include "common/read_text.h"
#include "planner_rrtc/ompl_planner.h"
#include "planner_rrtc/rrt_connect.h"
#include "planner_rrtc/rrtc_settings.h"
#include "planning/path_library.h"

namespace planbench {
namespace {

class RrtConnectPlanner final : public Planner {
 public:
  RrtConnectPlanner(const Robot& robot, RrtcSettings settings)
      : Planner(robot), settings_(std::move(settings)) {
    if (!settings_.experience.empty()) LoadExperience(robot.folder / settings_.experience);
    for (const PlanningGroup& group : robot.groups) {
      searches_.try_emplace(&group.space, group.space);
    }
  }

  PlannerDescription Describe() const override {
    PlannerDescription description;
    description.algorithm = settings_.VariantName();
    description.planner_class = PlannerClass::kSamplingGuided;
    description.bidirectional = true;
    description.collision_models = EnumValues<CollisionModel>();
    description.settings = DescribeSettings(settings_);
    if (experience_) {
      description.settings["experience_id"] = experience_id_;
      description.settings[kLearnedFrom] =
          fmt::format("{}", fmt::join(experience_->learned_from, ", "));
    }
    return description;
  }

 protected:
  SearchResult Search(SearchQuery& query) override {
    const bool knows = experience_ && experience_->Fits(query.space());
    return searches_.at(&query.space())
        .Search(SettingsOfRequest(settings_, query.parameters()), knows ? &*experience_ : nullptr,
                query);
  }

 private:
  void LoadExperience(const std::filesystem::path& file) {
    experience_ = ReadPathLibrary(file);
    ContentHash hash;
    hash.Add(ReadText(file));
    experience_id_ = hash.HexDigest();
    for (const PlanningGroup& group : robot().groups) {
      if (experience_->Fits(group.space)) return;
    }
    throw InputError(fmt::format("{}: its joints are not those of a group of robot '{}'",
                                 file.string(), robot().model.name()));
  }

  RrtcSettings settings_;
  std::optional<PathLibrary> experience_;
  std::string experience_id_;  ///< The file may change while its name stays.
  /// Their memory is kept from one request to the next.
  std::map<const JointSpace*, RrtConnect> searches_;
};

}  // namespace

std::unique_ptr<Planner> MakeRrtcPlanner(const Robot& robot, const YamlNode& node) {
  RrtcSettings settings = ReadRrtcSettings(node, RrtcSettings{});
  if (settings.ompl_algorithm != nullptr) {
    return std::make_unique<OmplPlanner>(robot, std::move(settings), node.Where());
  }
  return std::make_unique<RrtConnectPlanner>(robot, std::move(settings));
}

}  // namespace planbench
