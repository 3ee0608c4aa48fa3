#include "tests/pipeline/pipeline_fixture.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "common/sqlite.h"
#include "tests/support/private_bus.h"

namespace planbench {
namespace {

std::string ValueText(const SqliteValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
  if (const auto* real = std::get_if<double>(&value)) return fmt::format("{}", *real);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return "NULL";
}

}  // namespace

PipelineTest::PipelineTest() : PipelineTest(PrivateUdpUrl()) {}

PipelineTest::PipelineTest(std::string url)
    : url_(std::move(url)), mark_("PLANBENCH_TEST=" + folder_.path().string()) {}

PipelineTest::~PipelineTest() {
  processes_.clear();
  EXPECT_TRUE(WaitUntil([this] { return LeftRunning().empty(); })) << "processes left running";
}

std::string PipelineTest::Program(const std::string& name) {
  return std::string(PLANBENCH_BIN_DIR) + "/" + name;
}

std::string PipelineTest::RobotFolder() {
  return std::string(PLANBENCH_SOURCE_DIR) + "/robots/fetch";
}

std::string PipelineTest::ProblemFolder() {
  return std::string(PLANBENCH_SOURCE_DIR) + "/problems/shelf_demo";
}

ChildProcess* PipelineTest::Start(const std::vector<std::string>& arguments) {
  const std::string name = fmt::format("{}-{}", processes_.size(),
                                       std::filesystem::path(arguments.at(0)).filename().string());
  processes_.push_back(std::make_unique<ChildProcess>(
      arguments, folder() / name,
      std::map<std::string, std::string>{{"LCM_DEFAULT_URL", url_},
                                         {"PLANBENCH_TEST", folder().string()}}));
  return processes_.back().get();
}

ChildProcess* PipelineTest::StartSceneServer() {
  return Start({Program("scene_server"), "--robot", RobotFolder(), "--problems", ProblemFolder()});
}

ChildProcess* PipelineTest::StartPlanner(const std::string& kind,
                                         const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {Program("planner_" + kind), "--robot", RobotFolder()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return Start(arguments);
}

ChildProcess* PipelineTest::StartLogger(const std::filesystem::path& out) {
  return Start({Program("logger"), "--out", out.string()});
}

ChildProcess* PipelineTest::StartDriver(const std::vector<std::string>& flags) {
  // The machine may be busy: the tests wait longer for the other processes than a user would.
  std::vector<std::string> arguments = {Program("benchmark_driver"), "--discovery-timeout", "60"};
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  return Start(arguments);
}

ChildProcess* PipelineTest::StartLaunchedDriver(const std::filesystem::path& out,
                                                const std::vector<std::string>& flags,
                                                std::vector<std::string> command) {
  command.insert(command.end(), {Program("benchmark_driver"), "--launch", "--robot", RobotFolder(),
                                 "--problems", ProblemFolder(), "--out", out.string()});
  command.insert(command.end(), flags.begin(), flags.end());
  return Start(command);
}

void PipelineTest::ExpectEndsCleanly(ChildProcess* process) {
  process->Signal(SIGINT);
  EXPECT_EQ(process->Wait(), 0) << process->Errors();
}

void PipelineTest::ExpectBadInput(ChildProcess* process, const std::string& text) {
  EXPECT_EQ(process->Wait(), 2) << process->Errors();
  const std::string errors = process->Errors();
  EXPECT_NE(errors.find(text), std::string::npos) << errors;
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
}

std::vector<int> PipelineTest::LeftRunning() const {
  std::vector<int> pids;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    if (std::stoi(name) == getpid()) continue;
    std::ifstream file(entry.path() / "environ");
    const std::string environment{std::istreambuf_iterator<char>(file), {}};
    if (environment.find(mark_) != std::string::npos) pids.push_back(std::stoi(name));
  }
  return pids;
}

long long PipelineTest::Query(const std::filesystem::path& session, const std::string& sql) {
  if (!std::filesystem::exists(session / "results.sqlite")) return -1;
  try {
    SqliteConnection connection(session / "results.sqlite", SqliteConnection::Mode::kReadOnly);
    const SqliteValue value = connection.QueryValue(sql);
    const auto* whole = std::get_if<std::int64_t>(&value);
    return whole != nullptr ? *whole : -1;
  } catch (const SqliteError&) {
    return -1;  // being created, or locked at this moment
  }
}

std::vector<std::string> PipelineTest::Rows(const std::filesystem::path& session,
                                            const std::string& sql, int num_columns) {
  SqliteConnection connection(session / "results.sqlite", SqliteConnection::Mode::kReadOnly);
  SqliteStatement statement = connection.Prepare(sql);
  std::vector<std::string> rows;
  while (statement.Step()) {
    std::string row;
    for (int column = 0; column < num_columns; ++column) {
      row += ValueText(statement.Value(column)) + "|";
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace planbench
