#include "scene_server/checker_cache.h"

#include "collision/rigid_bodies.h"

namespace planbench {

CollisionChecker& CheckerCache::Get(const PlanningGroup& group, CollisionModel model,
                                    const std::string& scene_id,
                                    const std::shared_ptr<const Scene>& scene,
                                    std::vector<double> base_positions) {
  Entry& entry = entries_[{group.name, model}];
  if (!entry.checker) entry.checker = MakeReferenceChecker(*robot_, group, model);

  // Where the group's own joints stand does not matter to the checker and must not cost a set-up.
  base_positions = HeldPositions(robot_->model, group, base_positions);
  if (entry.scene_id != scene_id || entry.base_positions != base_positions) {
    entry.scene_id.clear();  // stays so if the checker refuses the scene
    entry.checker->SetScene(*scene, base_positions);
    entry.scene_id = scene_id;
    entry.scene = scene;
    entry.base_positions = std::move(base_positions);
  }
  return *entry.checker;
}

}  // namespace planbench
