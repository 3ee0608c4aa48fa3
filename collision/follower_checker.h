#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "collision/collision_checker.h"

namespace planbench {

/// Checks a group that joints outside it follow (mimic): by an engine for the group of its joints
/// and those, which takes the followers for joints like any other and is told where they are.
class FollowerChecker : public CollisionChecker {
 public:
  using MakeEngine = std::unique_ptr<CollisionChecker> (*)(const Robot& robot,
                                                           const PlanningGroup& group,
                                                           CollisionModel model);

  FollowerChecker(const Robot& robot, const PlanningGroup& group, CollisionModel model,
                  MakeEngine make_engine);

  std::string_view EngineName() const override { return engine_->EngineName(); }
  int BatchSize() const override { return engine_->BatchSize(); }

 protected:
  MotionBound DoSetScene(const Scene& scene, std::span<const double> base_positions) override;
  bool DoIsFree(std::span<const double> q) override;
  void DoCheckAll(std::span<const double> qs, int num, std::span<unsigned char> free) override;
  void DoScreen(std::span<const double> qs, int num, std::span<unsigned char> free) override;
  SampleVerdicts DoCheckSamples(std::span<const double> start, std::span<const double> motion,
                                std::span<const MotionSample> samples, SampleRole role) override;
  void DoFindDistances(std::span<const double> qs, int num, double at_most,
                       std::span<double> distances) override;
  void DoFindClearances(std::span<const double> qs, int num, double at_most,
                        std::span<double> clearances) override;
  std::optional<Contact> DoFindContact(std::span<const double> q) override;
  ClosestPair DoFindClosest(std::span<const double> q) override;

 private:
  // `num` configurations with the followers' positions after the group's.
  std::span<const double> WithFollowers(std::span<const double> qs, int num);

  PlanningGroup moved_;  // The group and its followers.
  std::unique_ptr<CollisionChecker> engine_;
  std::vector<double> rows_;
  std::vector<double> motion_;
};

}  // namespace planbench
