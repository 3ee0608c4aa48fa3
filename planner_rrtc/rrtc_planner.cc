#include "planner_rrtc/rrtc_planner.h"

#include <map>
#include <optional>
#include <utility>

#include "planner_rrtc/ompl_planner.h"
#include "planner_rrtc/rrt_connect.h"
#include "planner_rrtc/rrtc_settings.h"
#include "planning/experience.h"

namespace planbench {
namespace {

class RrtConnectPlanner final : public Planner {
 public:
  /// `node`: what `settings` were read from.
  RrtConnectPlanner(const Robot& robot, RrtcSettings settings, const YamlNode& node)
      : Planner(robot), settings_(std::move(settings)) {
    if (!settings_.experience.empty()) experience_.emplace(robot, node.At("experience"));
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
    if (experience_) experience_->Describe(&description.settings);
    return description;
  }

 protected:
  SearchResult Search(SearchQuery& query) override {
    return searches_.at(&query.space())
        .Search(SettingsOfRequest(settings_, query.parameters()),
                experience_ ? experience_->For(query.space()) : nullptr, query);
  }

 private:
  RrtcSettings settings_;
  std::optional<Experience> experience_;
  /// Their memory is kept from one request to the next.
  std::map<const JointSpace*, RrtConnect> searches_;
};

}  // namespace

std::unique_ptr<Planner> MakeRrtcPlanner(const Robot& robot, const YamlNode& node) {
  RrtcSettings settings = ReadRrtcSettings(node, RrtcSettings{});
  if (settings.ompl_algorithm != nullptr) {
    return std::make_unique<OmplPlanner>(robot, std::move(settings), node.Where());
  }
  return std::make_unique<RrtConnectPlanner>(robot, std::move(settings), node);
}

}  // namespace planbench
