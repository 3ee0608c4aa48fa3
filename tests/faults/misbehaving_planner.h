#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "messaging/bus.h"
#include "messaging/channels.h"
#include "messaging/node_announcer.h"
#include "messaging/node_registry.h"

namespace planbench {

/// A planner, named `mine`, that treats its requests after their problem's index:
/// 1: answers late; 2: twice, and differently; 3: another request first; 4: never, though live;
/// 5: is busy first; 6: for another session. Its verdict is EXHAUSTED, after kTime; of problems
/// that it is given a path of, that path, and 4 is then answered when the driver cancels it.
class MisbehavingPlanner {
 public:
  static constexpr double kTime =
      0.0009765625;  ///< s; below that of any round trip and what clocks differ by

  /// Waits for the scene server, whose robot it takes.
  explicit MisbehavingPlanner(const std::string& url,
                              std::map<int, PlanResultMessage> paths_by_problem = {});

 private:
  void OnRequest(const PlanRequest& request);
  void Answer(const PlanRequest& request, const std::string& request_id, double time_s = kTime);

  Bus bus_;
  NodeRegistry registry_;
  std::map<int, PlanResultMessage> paths_;
  PlannerChannels channels_{"mine"};
  std::string late_;  // request that has been asked for once
  int num_asked_ = 0;
  std::unique_ptr<NodeAnnouncer> announcer_;
  std::optional<PlanRequest> overdue_;  // for handlers only
  Subscription requests_;
  Subscription cancels_;
};

}  // namespace planbench
