#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/exit_codes.h"
#include "messaging/channels.h"
#include "messaging/codec.h"
#include "messaging/event_log.h"
#include "results/session_plan.h"
#include "tests/report/example_session.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace planbench {

/// A session's folder holds its event log; the rest is made of it.
class MergeSessionsTest : public testing::Test {
 protected:
  static SessionMessage Session(const std::string& run_id, std::int64_t start_utime, int num_runs) {
    SessionMessage session = ExampleSession();
    session.run_id = run_id;
    session.host = "host";
    session.start_utime = start_utime;
    session.finished = true;
    session.total_time_s = 10;
    session.num_runs = num_runs;
    session.conditions.problem_sets["shelf"] = "content";
    return session;
  }

  /// What is planned of the problems of the set for the planner of MakeRecord.
  static PlannedCall Call(std::vector<int> problems, Shard shard = {}, int trials = 1,
                          Directions directions = Directions::kForward) {
    return {{{"shelf", std::move(problems)}}, {{"planner", directions, trials}}, shard};
  }

  static SessionMessage Planned(SessionMessage session, const PlannedCall& call) {
    session.settings[kPlanSetting] = PlanText({call});
    if (call.shard.count > 1) {
      session.settings["shard"] = fmt::format("{}/{}", call.shard.index, call.shard.count);
    }
    return session;
  }

  /// Shard I of N, problem I of N, under the name "partI".
  static SessionMessage PartOf(int index, int count) {
    std::vector<int> problems;
    for (int problem = 1; problem <= count; ++problem) problems.push_back(problem);
    return Planned(Session(fmt::format("part{}", index), std::int64_t{1000} * index, 1),
                   Call(problems, {index, count}));
  }

  void Write(const std::string& folder, const SessionMessage& session,
             const std::vector<MadeRun>& runs) {
    std::filesystem::create_directory(folder_ / folder);
    EventLog log(folder_ / folder / (folder + ".lcmlog"), EventLog::Mode::kNew);
    log.Write({channel::kSession, Encode(session), session.start_utime});
    SceneMessage scene;
    scene.scene_id = SceneId(scene.scene);
    log.Write({channel::kScene, Encode(scene), 1});
    for (const MadeRun& run : runs) {
      const std::string key = fmt::format("{}/{}", run.contestant, run.problem);
      RunRecordMessage record = MakeRecord(run, session.run_id, 0);
      record.request_id = record.request.request_id = record.result.request_id =
          session.run_id + "/" + key;
      log.Write({channel::kRunRecord, Encode(record), 2});
    }
  }

  int Merge(const std::vector<std::string>& folders) { return MergeTo("whole", folders); }

  int MergeTo(const std::string& whole, const std::vector<std::string>& folders,
              const std::vector<std::string>& flags = {}) {
    std::vector<std::string> arguments = {std::string(PLANBENCH_BIN_DIR) + "/report", "--merge",
                                          (folder_ / whole).string(), "--out",
                                          (folder_ / "page.html").string()};
    for (const std::string& folder : folders) arguments.push_back((folder_ / folder).string());
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    ChildProcess process(arguments, folder_ / "report");
    const int code = process.Wait().value_or(-1);
    output_ = process.Output();
    errors_ = process.Errors();
    return code;
  }

  void ExpectRefused(const std::vector<std::string>& folders, const std::string& reason) {
    EXPECT_EQ(Merge(folders), kExitBadInput);
    EXPECT_THAT(errors_, testing::HasSubstr(reason));
    EXPECT_EQ(std::count(errors_.begin(), errors_.end(), '\n'), 1) << errors_;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "whole"));
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      EXPECT_EQ(entry.path().string().find("merging"), std::string::npos) << entry.path();
    }
  }

  TemporaryFolder folder_;
  std::string output_, errors_;
};

}  // namespace planbench
