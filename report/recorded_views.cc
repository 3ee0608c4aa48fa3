#include "report/recorded_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>

#include "common/error.h"
#include "report/session_robot.h"

namespace planbench {
namespace {

/// Of a path in a report, where many share the room.
constexpr int kFramesEmbedded = 40;
/// Of the element that holds a view or a mesh in the page, about.
constexpr std::size_t kElementBytes = 120;

}  // namespace

RecordedViews::RecordedViews(const StoredSession& session,
                             const std::filesystem::path& robot_folder,
                             const std::map<std::string, std::filesystem::path>& packages)
    : log_(FindEventLog(std::filesystem::absolute(session.file).parent_path())) {
  RecordedSession recorded = ReadRecords(log_);
  SessionMessage told = LastTold(recorded, session.run_id);
  if (told.settings.empty()) told.settings = session.flags;  // The log has lost it.
  robot_ =
      ShownRobot(LoadSessionRobot(told, robot_folder, packages), told.conditions.mesh_robot_id);
  for (auto& [id, scene] : ReadScenes(log_, &passed_over_)) scenes_.emplace(id, std::move(scene));
  passed_over_.insert(passed_over_.end(), recorded.passed_over.begin(), recorded.passed_over.end());
  for (const RecordedRun& run : recorded.runs) {
    if (run.run_id == session.run_id) records_.emplace(run.request_id, run.place);
  }
}

Json RecordedViews::View(const StoredRun& run, int num_frames) const {
  const auto place = records_.find(run.request_id);
  if (place == records_.end()) {
    throw InputError(fmt::format("{}: run {} is not in it", log_.string(), run.id));
  }
  const RunRecordMessage record = ReadRecord(place->second);
  const auto scene = scenes_.find(record.request.scene_id);
  if (scene == scenes_.end()) {
    throw InputError(fmt::format("{}: the scene of run {} is not in it", log_.string(), run.id));
  }
  return RunView(robot_, scene->second, record, num_frames);
}

EmbeddedViews EmbedViews(const ComparedSessions& compared, std::size_t most_bytes,
                         const std::map<std::string, std::filesystem::path>& packages) {
  struct Candidate {
    std::size_t attempt;
    std::size_t session;
    const StoredRun* run;
  };
  std::vector<Candidate> candidates;
  for (const ComparedContestant& contestant : compared.contestants()) {
    for (const StoredRun* run : contestant.runs) {
      candidates.push_back({candidates.size(), contestant.session, run});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return std::tie(a.run->trial, a.run->problem_index) <
           std::tie(b.run->trial, b.run->problem_index);
  });

  EmbeddedViews embedded;
  std::vector<std::unique_ptr<RecordedViews>> sessions(compared.sessions().size());
  bool knows_robots = true;
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    if (compared.sessions()[s].imported) continue;
    try {
      sessions[s] = std::make_unique<RecordedViews>(compared.sessions()[s], "", packages);
      for (const std::string& line : sessions[s]->passed_over())
        embedded.notes.push_back(line + ".");
    } catch (const InputError& error) {
      knows_robots = knows_robots && dynamic_cast<const UnknownRobot*>(&error) == nullptr;
      embedded.notes.push_back(
          fmt::format("{}: no 3D views: {}.", compared.session_names()[s], error.what()));
    }
  }
  struct NotShown {
    int number = 0;
    std::string first;  ///< Why that is not.
  };
  std::vector<NotShown> not_shown(sessions.size());
  std::size_t num_bytes = 0;
  for (const Candidate& candidate : candidates) {
    const auto& session = sessions[candidate.session];
    if (!session) continue;
    try {
      Json view = session->View(*candidate.run, kFramesEmbedded);
      std::map<std::string, Json> new_meshes;
      for (auto& [id, mesh] : view["meshes"].items()) {
        if (!embedded.meshes.contains(id)) new_meshes[id] = std::move(mesh);
        mesh = nullptr;
      }
      num_bytes += view.dump().size() + kElementBytes;
      for (const auto& [id, mesh] : new_meshes) num_bytes += mesh.dump().size() + kElementBytes;
      if (num_bytes > most_bytes) break;
      embedded.meshes.merge(new_meshes);
      embedded.by_attempt.emplace(candidate.attempt, std::move(view));
    } catch (const InputError& error) {
      NotShown& others = not_shown[candidate.session];
      if (others.number++ == 0) others.first = error.what();
    }
  }
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    if (not_shown[s].number == 0) continue;
    embedded.notes.push_back(fmt::format("{}: attempts without a 3D view: {}; the first: {}.",
                                         compared.session_names()[s], not_shown[s].number,
                                         not_shown[s].first));
  }
  if (embedded.by_attempt.size() < candidates.size()) {
    embedded.extent = fmt::format(
        "The page holds the 3D views of {} of {} attempts; view --session FOLDER --run "
        "RUN{} shows any.",
        embedded.by_attempt.size(), candidates.size(), knows_robots ? "" : " --robot DIR");
  }
  return embedded;
}

}  // namespace planbench
