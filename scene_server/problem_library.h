#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "messaging/messages.h"
#include "robot_model/robot_folder.h"
#include "scene/problem.h"
#include "scene/scene.h"

namespace planbench {

/// A problem as it is served.
struct ServedProblem {
  ProblemMessage message;  ///< But for the request_id.
  std::shared_ptr<const Scene> scene;
};

/// The problem sets of some folders, their problems read when they are first asked for and kept
/// from then on. One whose files have changed since ContentId was asked for is refused: it would be
/// another than the id stands for. Thread-safe. Holds references to the robots.
class ProblemLibrary {
 public:
  /// Each folder is a set, or, if it holds no problem itself, a folder of sets, at any depth. The
  /// first problem of every set is read: that it cannot be is logged, so that a set for another
  /// robot is noticed here. `receive_buffer_bytes`: of those who receive scenes; one that is larger
  /// is served with a warning. `mesh_robot`: the referee's, or null; a problem in which it stands
  /// otherwise (PostureMisfits) is, too. Throws InputError: no such folder, no problem in it, two
  /// sets of one name (both folders named).
  ProblemLibrary(const Robot& robot, const std::vector<std::filesystem::path>& folders,
                 std::size_t receive_buffer_bytes, const Robot* mesh_robot = nullptr);

  /// By name.
  const std::map<std::string, ProblemSet>& sets() const { return sets_; }

  /// Content hash of a set: of its files, and of the scenes whose meshes may be in others.
  std::string ContentId(const ProblemSet& set);

  /// Throws InputError: no such set or index (with what there is), a file that cannot be read or
  /// has changed, a problem that does not fit the robot, or that others could not take off the bus.
  ServedProblem Find(const std::string& set, int index);

  /// The scene of that content id, null if no problem has it. Problems that nobody has asked for
  /// yet are read if need be: a server that was restarted must still know the scenes that others
  /// hold on to.
  std::shared_ptr<const Scene> FindScene(const std::string& scene_id);

 private:
  void AddSet(const std::filesystem::path& folder);
  /// Throws InputError if `what`, a file, say, was not what `id` stands for when it was first read.
  void RequireUnchanged(const std::string& what, const std::string& id);
  /// The text of a problem's file, unchanged.
  std::string TextOf(const std::filesystem::path& file);
  const ServedProblem& Read(const ProblemSet& set, const ProblemFiles& files);
  void ReadAll();
  /// Of the mesh robot at the problem's start; "" without one.
  std::string PostureMisfitsOf(const Problem& problem) const;

  const Robot* robot_;
  const Robot* mesh_robot_;
  std::size_t receive_buffer_bytes_;
  std::map<std::string, ProblemSet> sets_;
  std::mutex mutex_;
  std::map<std::pair<std::string, int>, ServedProblem> problems_;  // by set and index
  struct KnownScene {
    std::shared_ptr<const Scene> scene;
    std::size_t bytes;  // as a message
  };
  std::map<std::string, KnownScene> scenes_;  // by content id
  std::map<std::string, std::string> ids_;    // what RequireUnchanged was first told
  bool all_read_ = false;
};

/// Ascending numbers in words: "1-100", "1-3, 7".
std::string DescribeIndices(const std::vector<ProblemFiles>& problems);

}  // namespace planbench
