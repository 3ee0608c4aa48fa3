#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "messaging/record_log.h"
#include "report/view_data.h"
#include "results/compared_sessions.h"

namespace planbench {

/// 3D views of a session's runs, made of its event log and its robot.
class RecordedViews {
 public:
  /// `robot_folder`, `packages`, and errors of the robot, as of LoadSessionRobot. Throws InputError
  /// if the log cannot be read.
  RecordedViews(const StoredSession& session, const std::filesystem::path& robot_folder,
                const std::map<std::string, std::filesystem::path>& packages);

  /// `num_frames` as of RunView. Throws InputError if the log lacks the run or its scene, or the
  /// robot is another.
  Json View(const StoredRun& run, int num_frames) const;

  const Robot& robot() const { return robot_.robot(); }
  /// Of the log, as RecordedSession tells it.
  const std::vector<std::string>& passed_over() const { return passed_over_; }

 private:
  std::filesystem::path log_;
  ShownRobot robot_;
  std::vector<std::string> passed_over_;
  std::map<std::string, EventPlace> records_;  ///< By request.
  std::map<std::string, ShownScene> scenes_;   ///< By content id.
};

/// Views of as many runs as fit into `most_bytes`, those of first trials first.
struct EmbeddedViews {
  /// Those of all views, by id: in the views themselves null stands for them.
  std::map<std::string, Json> meshes;
  /// By the run's place among those of all contestants, in their order.
  std::map<std::size_t, Json> by_attempt;
  /// What cannot be shown and why: what is wrong with an event log, say.
  std::vector<std::string> notes;
  /// How many there are, and where others are to be had; "" if there are no others.
  std::string extent;
};
/// `packages`: as of LoadSessionRobot.
EmbeddedViews EmbedViews(const ComparedSessions& compared, std::size_t most_bytes,
                         const std::map<std::string, std::filesystem::path>& packages);

}  // namespace planbench
