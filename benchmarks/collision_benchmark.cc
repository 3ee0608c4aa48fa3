// Throughput of collision checking on one published problem: items_per_second is configurations
// (edges) per second of CPU time on one core.
//
//   collision_benchmark --problems DIR [--index N] [--robot DIR] [--model spheres|meshes]
//   [--benchmark_... flags]

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "collision/edge_checker.h"
#include "common/error.h"
#include "scene/moveit_yaml.h"

namespace planbench {
namespace {

using Configuration = std::vector<double>;

struct Workload {
  Robot robot;
  Problem problem;
  std::vector<double> base_positions;
  std::unique_ptr<CollisionChecker> checker;
  std::vector<Configuration> random;  ///< Uniform within limits.
  std::vector<Configuration> free;    ///< Those of `random` that are free.
};

Workload Prepare(const std::string& robot_folder, const std::string& problems, int index) {
  Workload work;
  work.robot = LoadRobot(robot_folder);
  const ProblemSet set = ListProblemSet(problems);
  const ProblemFiles* files = set.Find(index);
  if (files == nullptr) throw InputError(fmt::format("{} has no problem {}", problems, index));
  work.problem = ReadProblem(files->scene, files->request, work.robot.resources);
  work.base_positions = FullPositions(work.robot.model, work.problem.start.names,
                                      work.problem.start.positions, files->request.string());
  return work;
}

/// Done once the workload is where it stays: the checker refers to the robot.
void AddConfigurations(Workload* work, CollisionModel model) {
  const PlanningGroup& group = work->robot.Group(work->problem.group);
  work->checker = MakeCollisionChecker(work->robot, group, model);
  work->checker->SetScene(work->problem.scene, work->base_positions);
  std::mt19937_64 generator(1);
  for (int i = 0; i < 20000; ++i) {
    Configuration q;
    for (const JointSpace::Joint& joint : group.space.joints()) {
      q.push_back(std::uniform_real_distribution<double>(joint.lower, joint.upper)(generator));
    }
    if (work->checker->IsFree(q)) work->free.push_back(q);
    work->random.push_back(std::move(q));
  }
  if (work->free.size() < 2) throw InputError("hardly a configuration of this problem is free");
}

void Check(benchmark::State& state, CollisionChecker& checker,
           const std::vector<Configuration>& configurations) {
  std::size_t i = 0;
  std::int64_t num_free = 0;
  for (auto _ : state) {
    num_free += checker.IsFree(configurations[i]) ? 1 : 0;
    i = i + 1 == configurations.size() ? 0 : i + 1;
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["free"] = static_cast<double>(num_free) / static_cast<double>(state.iterations());
}

/// Blocks of configurations; one in collision ends a block.
void CheckBlocks(benchmark::State& state, CollisionChecker& checker,
                 const std::vector<Configuration>& configurations) {
  constexpr int kBlock = 16;
  std::vector<double> rows;
  for (const Configuration& q : configurations) rows.insert(rows.end(), q.begin(), q.end());
  const std::size_t block = kBlock * configurations.front().size();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(checker.FindCollision(std::span(rows).subspan(i, block), kBlock));
    i = i + 2 * block > rows.size() ? 0 : i + block;
  }
  state.SetItemsProcessed(state.iterations() * kBlock);
}

/// Edges from each free configuration towards the next, cut to at most `max_length` (L2, rad and
/// m).
void CheckEdges(benchmark::State& state, Workload& work, double max_length) {
  EdgeChecker edges(work.checker.get(), work.robot.edge_resolution_m);
  const JointSpace& space = edges.space();
  std::vector<Configuration> ends;
  for (std::size_t i = 0; i + 1 < work.free.size(); ++i) {
    const double length = space.Distance(work.free[i], work.free[i + 1]);
    ends.push_back(work.free[i + 1]);
    space.Interpolate(work.free[i], work.free[i + 1], std::min(1.0, max_length / length),
                      ends.back());
  }
  std::size_t i = 0;
  std::int64_t num_valid = 0;
  for (auto _ : state) {
    num_valid += edges.IsValidEdge(work.free[i], ends[i], true) ? 1 : 0;
    i = i + 1 == ends.size() ? 0 : i + 1;
  }
  const auto iterations = static_cast<double>(state.iterations());
  state.SetItemsProcessed(state.iterations());
  state.counters["valid"] = static_cast<double>(num_valid) / iterations;
  state.counters["checks_per_edge"] =
      static_cast<double>(edges.counters().configurations) / iterations;
  state.counters["checks_per_second"] = benchmark::Counter(
      static_cast<double>(edges.counters().configurations), benchmark::Counter::kIsRate);
}

void Register(Workload* work) {
  benchmark::RegisterBenchmark("check/random", [work](benchmark::State& state) {
    Check(state, *work->checker, work->random);
  });
  benchmark::RegisterBenchmark(
      "check/free", [work](benchmark::State& state) { Check(state, *work->checker, work->free); });
  benchmark::RegisterBenchmark("block/random", [work](benchmark::State& state) {
    CheckBlocks(state, *work->checker, work->random);
  });
  benchmark::RegisterBenchmark("block/free", [work](benchmark::State& state) {
    CheckBlocks(state, *work->checker, work->free);
  });
  for (const double length : {0.2, 1.0, 100.0}) {
    benchmark::RegisterBenchmark(
        fmt::format("edge/at_most_{}", length).c_str(),
        [work, length](benchmark::State& state) { CheckEdges(state, *work, length); });
  }
  benchmark::RegisterBenchmark("closest/free", [work](benchmark::State& state) {
    std::size_t i = 0;
    for (auto _ : state) {
      benchmark::DoNotOptimize(work->checker->FindClosest(work->free[i]));
      i = i + 1 == work->free.size() ? 0 : i + 1;
    }
    state.SetItemsProcessed(state.iterations());
  });
  benchmark::RegisterBenchmark("set_scene", [work](benchmark::State& state) {
    for (auto _ : state) work->checker->SetScene(work->problem.scene, work->base_positions);
    state.SetItemsProcessed(state.iterations());
  });
}

int Main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::string problems;
  std::string robot = PLANBENCH_SOURCE_DIR "/robots/fetch";
  std::string model_name = "spheres";
  int index = 1;
  CLI::App app("Throughput of collision checking on one problem");
  app.add_option("--problems", problems, "Folder of a problem set")->required();
  app.add_option("--index", index, "Number of the problem")->capture_default_str();
  app.add_option("--robot", robot, "Robot folder")->capture_default_str();
  app.add_option("--model", model_name, "Collision model")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  const auto model = ParseCollisionModel(model_name);
  if (!model) throw InputError(fmt::format("--model: unknown collision model '{}'", model_name));
  Workload work = Prepare(robot, problems, index);
  AddConfigurations(&work, *model);
  benchmark::AddCustomContext("problem", fmt::format("{} {}", problems, index));
  benchmark::AddCustomContext("engine", std::string(work.checker->EngineName()));
  benchmark::AddCustomContext("model", model_name);
  Register(&work);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace planbench

int main(int argc, char** argv) {
  try {
    return planbench::Main(argc, argv);
  } catch (const planbench::InputError& error) {
    std::fprintf(stderr, "collision_benchmark: %s\n", error.what());
    return 2;
  }
}
