#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait_until.h"

namespace planbench {

/// Starts planbench's programs on a port of the test's own, with the Fetch and the problem set that
/// ships. What still runs at the end of a test is killed, and makes it fail.
class PipelineTest : public ::testing::Test {
 protected:
  PipelineTest();
  explicit PipelineTest(std::string url);
  ~PipelineTest() override;

  static std::string Program(const std::string& name);
  static std::string RobotFolder();
  static std::string ProblemFolder();

  const std::filesystem::path& folder() const { return folder_.path(); }
  const std::string& url() const { return url_; }

  /// Starts a program of any kind; `url` of the bus in its environment.
  ChildProcess* Start(const std::vector<std::string>& arguments);
  ChildProcess* StartSceneServer();
  /// planner_<kind>.
  ChildProcess* StartPlanner(const std::string& kind, const std::vector<std::string>& more = {});
  ChildProcess* StartLogger(const std::filesystem::path& out);
  ChildProcess* StartDriver(const std::vector<std::string>& flags);
  /// The driver with --launch, robot and problems; `command`: words before it, as `env NAME=VALUE`.
  ChildProcess* StartLaunchedDriver(const std::filesystem::path& out,
                                    const std::vector<std::string>& flags,
                                    std::vector<std::string> command = {});

  /// Asks a process to end with SIGINT and expects exit code 0.
  static void ExpectEndsCleanly(ChildProcess* process);
  /// Expects exit code 2 and one line on stderr that holds `text`.
  static void ExpectBadInput(ChildProcess* process, const std::string& text);
  /// Processes, other than this one, that a test of this fixture started, their own children
  /// included.
  std::vector<int> LeftRunning() const;

  /// Single value of a query on a session's results.sqlite; -1 if it has no answer yet.
  static long long Query(const std::filesystem::path& session, const std::string& sql);
  /// All rows of a query as text.
  static std::vector<std::string> Rows(const std::filesystem::path& session, const std::string& sql,
                                       int num_columns);

 private:
  TemporaryFolder folder_;
  std::string url_;
  std::string mark_;  // in the environment of every process of this test
  std::vector<std::unique_ptr<ChildProcess>> processes_;
};

}  // namespace planbench
