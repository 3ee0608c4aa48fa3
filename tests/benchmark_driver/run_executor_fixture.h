#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "benchmark_driver/run_executor.h"
#include "tests/benchmark_driver/fake_nodes.h"

namespace planbench {

/// The planner "arm" and what a session asks of it.
class RunExecutorTest : public testing::Test {
 protected:
  RunExecutorTest() { bus_.Start(); }

  static SessionConditions Conditions() {
    SessionConditions conditions;
    PlanRequest& request = conditions.request;
    request.run_id = "run";
    request.robot_id = kFakeRobotId;
    request.time_limit_s = 7;
    request.edge_resolution_m = 0.02;
    request.simplify = false;
    request.parameters = {{"step", "4"}};
    conditions.referee_step_m = 0.004;
    Contestant contestant;
    contestant.planner = "arm";
    contestant.name = "Arm (fast)";
    contestant.collision_model = CollisionModel::kVoxels;
    contestant.edge_resolution_m = 0.03;
    conditions.contestants = {contestant};
    return conditions;
  }
  static ScheduledRun Scheduled(int index = 2) {
    ScheduledRun run;
    run.planner = "arm";
    run.problem_set = "cans";
    run.problem_index = index;
    run.direction = Direction::kBackward;
    run.trial = 3;
    run.seed = 9;
    run.request_id = "run/cans/" + std::to_string(index) + "/arm/backward/3";
    return run;
  }
  RunRecordMessage Execute(RunExecutor* executor, const ScheduledRun& run = Scheduled()) {
    return executor->Execute(run, {&client_}, [] { return false; }).value();
  }
  RunRecordMessage Execute(const ScheduledRun& run = Scheduled()) {
    return Execute(&executor_, run);
  }
  /// When the time that it tells has passed.
  static void AnswerWith(const PlanResult& result, FakePlanner* planner) {
    planner->OnRequest([planner, result](const PlanRequest& request) {
      std::this_thread::sleep_for(
          std::chrono::duration<double>(result.total_time_s + result.phases.simplification_s));
      planner->SendResult(request.request_id, result);
    });
  }
  void AnswerWith(const PlanResult& result) { AnswerWith(result, &planner_); }

  Bus bus_{"memq://"};
  NodeRegistry registry_{&bus_};
  FakePlanner planner_{&bus_};
  PlannerClient client_{&bus_, &registry_, "arm"};
  RunExecutor executor_{&bus_, &registry_, Conditions()};
  std::atomic<bool> interrupted_ = false;
};

}  // namespace planbench
