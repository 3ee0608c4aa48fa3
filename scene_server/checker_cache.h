#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "collision/collision_checker.h"
#include "robot_model/robot_folder.h"
#include "scene/scene.h"

namespace planbench {

/// Collision checkers of one robot, by group and model, made when first asked for and given a scene
/// only when it or the joints held outside the group have changed. Not thread-safe. Holds a
/// reference to the robot.
class CheckerCache {
 public:
  explicit CheckerCache(const Robot& robot) : robot_(&robot) {}

  /// The checker, in that scene, with the joints outside the group at `base_positions` (full
  /// positions). Valid until the next call. Throws InputError as MakeReferenceChecker and SetScene
  /// do.
  CollisionChecker& Get(const PlanningGroup& group, CollisionModel model,
                        const std::string& scene_id, const std::shared_ptr<const Scene>& scene,
                        std::vector<double> base_positions);

 private:
  struct Entry {
    std::unique_ptr<CollisionChecker> checker;
    std::string scene_id;                // empty: no scene set
    std::shared_ptr<const Scene> scene;  // kept alive for the checker
    std::vector<double> base_positions;  // the group's at 0
  };

  const Robot* robot_;
  std::map<std::pair<std::string, CollisionModel>, Entry> entries_;
};

}  // namespace planbench
