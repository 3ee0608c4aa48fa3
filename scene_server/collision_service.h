#pragma once

#include <memory>
#include <mutex>

#include "messaging/messages.h"
#include "robot_model/robot_folder.h"
#include "scene/scene.h"
#include "scene_server/checker_cache.h"

namespace planbench {

/// Answers questions about states and edges in collision. Thread-safe (one request at a time).
class CollisionService {
 public:
  /// Samples that the edges of one request may have; more are refused.
  static constexpr double kMaxSamples = 1e6;

  explicit CollisionService(const Robot& robot) : robot_(&robot), checkers_(robot) {}

  /// One verdict for every state and edge. Edges are checked as EdgeChecker does it by the method
  /// asked for; the first of the fixed method's samples in collision gives contact and fraction, if
  /// there is one: where a proof alone fails, a fraction only. States outside the joint limits are
  /// checked for collision all the same. Throws InputError naming the field.
  CollisionReplyMessage Answer(const CollisionRequestMessage& request,
                               const std::shared_ptr<const Scene>& scene);

 private:
  const Robot* robot_;
  std::mutex mutex_;
  CheckerCache checkers_;
};

}  // namespace planbench
