#pragma once

#include <string>
#include <string_view>

namespace planbench {

/// Channel names; lcmtypes/README.md has a row for each.
namespace channel {
inline constexpr char kDiscover[] = "DISCOVER";
inline constexpr char kNodeStatus[] = "NODE_STATUS";
inline constexpr char kProblemSets[] = "PROBLEM_SETS";
inline constexpr char kProblemRequest[] = "PROBLEM_REQUEST";
inline constexpr char kProblem[] = "PROBLEM";
inline constexpr char kSceneRequest[] = "SCENE_REQUEST";
inline constexpr char kScene[] = "SCENE";
inline constexpr char kCollisionRequest[] = "COLLISION_REQUEST";
inline constexpr char kCollisionReply[] = "COLLISION_REPLY";
inline constexpr char kPathCheckRequest[] = "PATH_CHECK_REQUEST";
inline constexpr char kPathCheckReply[] = "PATH_CHECK_REPLY";
inline constexpr char kSession[] = "SESSION";
inline constexpr char kSessionAck[] = "SESSION_ACK";
inline constexpr char kRunRecord[] = "RUN_RECORD";
inline constexpr char kRunRecordAck[] = "RUN_RECORD_ACK";
}  // namespace channel

/// The channels of one planner: the prefix, '_', and the planner's name in upper case with '-' as
/// '_'.
struct PlannerChannels {
  std::string request;   ///< PLAN_REQUEST_<PLANNER>
  std::string ack;       ///< PLAN_ACK_<PLANNER>
  std::string progress;  ///< PLAN_PROGRESS_<PLANNER>
  std::string result;    ///< PLAN_RESULT_<PLANNER>
  std::string cancel;    ///< PLAN_CANCEL_<PLANNER>

  /// Throws InputError unless the name can name a node.
  explicit PlannerChannels(const std::string& planner);
};

/// What a node's name must be.
inline constexpr char kNodeNameRule[] = "1 to 40 letters, digits, '_' or '-' are needed";
bool IsNodeName(std::string_view name);
/// Throws InputError unless `name` can name a node.
void RequireNodeName(const std::string& name);

}  // namespace planbench
