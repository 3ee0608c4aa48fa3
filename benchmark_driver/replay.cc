#include "benchmark_driver/replay.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "benchmark_driver/run_executor.h"
#include "benchmark_driver/text_table.h"
#include "common/error.h"
#include "common/lookup.h"
#include "common/progress_line.h"
#include "common/random_id.h"
#include "messaging/asked_runs.h"
#include "messaging/channels.h"
#include "messaging/session_conditions.h"
#include "results/statistics.h"
#include "results/training.h"

namespace planbench {
namespace {

/// A run that was not asked is no request to its planner, nor is one that lacked the path that the
/// planner was to improve.
bool HoldsRequest(const RunRecordMessage& run) {
  const std::string& answered = run.result.planner;
  return WasAsked(run) && (answered.empty() || answered == run.planner);
}

std::string PathDifference(const std::string& what, const Path& then, const Path& now) {
  if (then == now) return "";
  if (then.size() != now.size()) {
    return fmt::format("{} of {} waypoints, now {}", what, then.size(), now.size());
  }
  const auto [before, after] = std::mismatch(then.begin(), then.end(), now.begin());
  const std::string place = fmt::format("{}, waypoint {}", what, before - then.begin());
  if (before->size() != after->size()) {
    return fmt::format("{}: {} joints, now {}", place, before->size(), after->size());
  }
  double most = 0;
  for (std::size_t i = 0; i < before->size(); ++i) {
    most = std::max(most, std::abs((*before)[i] - (*after)[i]));
  }
  return fmt::format("{}: off by {:.3g}", place, most);
}

}  // namespace

std::string Difference(const RunRecordMessage& recorded, const PlannerClient::Answer& answer) {
  using Outcome = PlannerClient::Outcome;
  const PlanResultMessage& then = recorded.result;
  const PlanResultMessage& now = answer.result;
  const bool answered_then = !then.request_id.empty();
  const PlanStatus status_then = answered_then ? then.result.status : recorded.status;
  const PlanStatus status_now = answer.outcome == Outcome::kResult    ? now.result.status
                                : answer.outcome == Outcome::kRefused ? PlanStatus::kInvalidRequest
                                                                      : PlanStatus::kNoAnswer;
  if (status_then != status_now) {
    const std::string& why =
        answer.outcome == Outcome::kResult ? now.result.message : answer.message;
    return fmt::format("{}, now {}{}", EnumName(status_then), EnumName(status_now),
                       why.empty() ? "" : " (" + why + ")");
  }
  std::vector<std::string> differences;
  if (then.joint_names != now.joint_names) {
    differences.push_back(fmt::format("joints {}, now {}", fmt::join(then.joint_names, " "),
                                      fmt::join(now.joint_names, " ")));
  }
  for (std::string& difference :
       std::vector{PathDifference("path", then.result.path, now.result.path),
                   PathDifference("simplified path", then.result.simplified_path,
                                  now.result.simplified_path)}) {
    if (!difference.empty()) differences.push_back(std::move(difference));
  }
  if (then.result.cost != now.result.cost) {
    differences.push_back(fmt::format("cost {}, now {}", then.result.cost, now.result.cost));
  }
  return fmt::format("{}", fmt::join(differences, "; "));
}

std::vector<std::string> PlannersAsked(const std::vector<RunRecordMessage>& runs) {
  std::vector<std::string> planners;
  for (const RunRecordMessage& run : runs) {
    if (HoldsRequest(run) &&
        std::find(planners.begin(), planners.end(), run.planner) == planners.end())
      planners.push_back(run.planner);
  }
  return planners;
}

std::vector<std::string> MissingRuns(const std::string& log, const RecordedSession& recorded) {
  std::map<std::string, int> planned;  // by session, as it told last
  for (const SessionMessage& session : recorded.sessions) {
    planned[session.run_id] = session.num_runs;
  }
  std::vector<std::string> lines;
  for (const auto& [run_id, num_planned] : planned) {
    const auto num_held =
        std::count_if(recorded.runs.begin(), recorded.runs.end(),
                      [&id = run_id](const auto& run) { return run.run_id == id; });
    if (num_held >= num_planned) continue;
    lines.push_back(
        fmt::format("{} holds {} of the {} runs of the session {}: the others were not compared.",
                    log, num_held, num_planned, run_id));
  }
  return lines;
}

Replay::Replay(Bus* bus, NodeRegistry* registry, std::string run_id,
               std::vector<RunRecordMessage> runs, std::map<std::string, Scene> scenes,
               const std::vector<std::string>& planners, std::chrono::milliseconds patience,
               std::optional<int> problems_per_process,
               std::function<void(const std::string&)> start_anew)
    : bus_(bus),
      registry_(registry),
      run_id_(std::move(run_id)),
      scenes_(std::move(scenes)),
      patience_(patience),
      renewal_(problems_per_process, std::move(start_anew)) {
  for (const std::string& planner : planners) tallies_[planner];
  for (RunRecordMessage& run : runs) {
    const auto tally = tallies_.find(run.planner);
    if (!HoldsRequest(run) || tally == tallies_.end()) continue;
    if (!scenes_.contains(run.request.scene_id)) {
      throw InputError(
          fmt::format("the log lacks the scene {} of {}", run.request.scene_id, run.request_id));
    }
    ++tally->second.num_requests;
    runs_.push_back(std::move(run));
  }
  for (const auto& [planner, tally] : tallies_) {
    if (tally.num_requests == 0) {
      throw InputError("the log holds no request to a planner named '" + planner + "'");
    }
  }
  scene_requests_ = bus->Subscribe<SceneRequestMessage>(
      channel::kSceneRequest,
      [this](const SceneRequestMessage& request) { OnSceneRequest(request); });
}

void Replay::OnSceneRequest(const SceneRequestMessage& request) {
  const auto scene = scenes_.find(request.scene_id);
  if (scene == scenes_.end()) return;
  SceneMessage answer;
  answer.request_id = request.request_id;
  answer.scene_id = request.scene_id;
  answer.scene = scene->second;
  bus_->Publish(channel::kScene, answer);
}

void Replay::CompareSettings(const RunRecordMessage& run) const {
  const auto planner = registry_->Find(run.planner, NodeKind::kPlanner);
  if (!planner) return;
  const auto compare = [&](const std::string& what, const std::string& then,
                           const std::string& now) {
    if (!IsSameSetting(then, now))
      spdlog::warn("{}: {} was '{}', is '{}'", run.planner, what, then, now);
  };
  compare("algorithm", run.algorithm, planner->algorithm);
  std::map<std::string, std::string> own_settings = run.settings;
  EraseFirstPathSettings(&own_settings);
  std::set<std::string> keys;
  for (const auto& [key, value] : own_settings) keys.insert(key);
  for (const auto& [key, value] : planner->settings) keys.insert(key);
  for (const std::string& key : keys) {
    compare("setting " + key, Lookup(own_settings, key).value_or(""),
            Lookup(planner->settings, key).value_or(""));
  }
}

bool Replay::Run(const std::function<bool()>& interrupted,
                 const std::function<void(const std::string&)>& tell) {
  std::map<std::string, std::unique_ptr<PlannerClient>> clients;
  ProgressLine progress(static_cast<int>(runs_.size()));
  int num_done = 0;
  int num_different = 0;
  bool is_all_asked = true;
  for (const RunRecordMessage& run : runs_) {
    std::unique_ptr<PlannerClient>& client = clients[run.planner];
    if (!client) {
      PlannerClient::Terms terms;
      terms.patience = patience_;
      terms.on_absence = [&planner = run.planner](const std::string& why) {
        spdlog::error("the planner '{}' is given up: {}", planner, why);
      };
      client = std::make_unique<PlannerClient>(bus_, registry_, run.planner, std::move(terms));
      CompareSettings(run);
    }
    PlanRequest request = run.request;
    request.run_id = run_id_;
    request.request_id = UniqueId(run.request_id);
    renewal_.Renew(run.problem_set, run.problem_index, client.get());
    const PlannerClient::Answer answer = client->Solve(request, interrupted);
    if (answer.outcome == PlannerClient::Outcome::kInterrupted) return false;

    Tally& tally = tallies_.at(run.planner);
    if (answer.roundtrip_time_s == 0) {
      is_all_asked = false;
    } else if (const std::string difference = Difference(run, answer); !difference.empty()) {
      ++tally.num_different;
      ++num_different;
      tell(run.request_id + ": " + difference);
    } else {
      ++tally.num_equal;
      const double then_s = run.result.result.planning_time_s -
                            Lookup(run.result.result.counters, kFirstPathTime).value_or(0);
      if (run.result.result.Solves() && then_s > 0) {
        tally.time_ratios.push_back(answer.result.result.planning_time_s / then_s);
      }
    }
    progress.Show(++num_done, fmt::format("{} different", num_different));
  }
  return is_all_asked && num_different == 0;
}

std::string Replay::Table() const {
  TextTable table(
      "Answers now and as recorded",
      {"Planner", "Requests", "Equal", "Different", "Not asked", "Paths", "Time", "25 %", "75 %"},
      1);
  for (const auto& [planner, tally] : tallies_) {
    const Summary ratio = Summarize(tally.time_ratios);
    table.Add({planner, std::to_string(tally.num_requests), std::to_string(tally.num_equal),
               std::to_string(tally.num_different),
               std::to_string(tally.num_requests - tally.num_equal - tally.num_different),
               std::to_string(ratio.count), Number(ratio.median, 2),
               Number(ratio.lower_quartile, 2), Number(ratio.upper_quartile, 2)});
  }
  return table.Format(
      "Equal: status, joints, paths and cost. Paths: equal answers with one, that took more than 0 "
      "s "
      "then. Time: planning time now over planning time then, median and quartiles over these; no "
      "part of the verdict.");
}

}  // namespace planbench
