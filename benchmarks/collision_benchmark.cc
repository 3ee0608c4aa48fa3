// Throughput of collision checking on one published problem: items_per_second is configurations
// (edges) per second of CPU time on one core.
//
//   collision_benchmark --problems DIR [--index N] [--robot DIR] [--model spheres|voxels|meshes]
//   [--engine fast|exact] [--num-spheres N] [--edge-check fixed|certified] [--benchmark_... flags]
//
// Names: check: one configuration a call; block: 16 a call; edge: of at most that length (L2, rad
// and m), as planners check them; unit_edge: free edges of 1 rad at 32 samples; boxes: random
// configurations among that many boxes, of one density around the robot; meshes: the same among
// pebbles of 2000 triangles.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "collision/edge_checker.h"
#include "common/command_line.h"
#include "common/error.h"
#include "common/exit_codes.h"
#include "messaging/robot_flags.h"
#include "robot_model/full_positions.h"
#include "scene/moveit_yaml.h"

namespace planbench {
namespace {

using Configuration = std::vector<double>;

constexpr int kBlock = 16;  ///< Configurations handed over at once.

struct Workload {
  Robot robot;
  Problem problem;
  std::vector<double> base_positions;
  std::unique_ptr<CollisionChecker> checker;
  EdgeCheck edge_check = EdgeCheck::kFixed;
  std::vector<Configuration> random;  ///< Uniform within limits.
  std::vector<Configuration> free;    ///< Those of `random` that are free.
};

Workload Prepare(const RobotFlags& robot, const std::string& problems, int index) {
  Workload work;
  work.robot = robot.Load();
  const ProblemSet set = ListProblemSet(problems);
  const ProblemFiles* files = set.Find(index);
  if (files == nullptr) throw InputError(fmt::format("{} has no problem {}", problems, index));
  work.problem = ReadProblem(files->scene, files->request, work.robot);
  work.base_positions = FullPositions(work.robot.model, work.problem.start.names,
                                      work.problem.start.positions, files->request.string());
  return work;
}

/// Done once the workload is where it stays: the checker refers to the robot.
void AddConfigurations(Workload* work, CollisionModel model, bool exact) {
  const PlanningGroup& group = work->robot.Group(work->problem.group);
  work->checker = exact ? MakeReferenceChecker(work->robot, group, model)
                        : MakeCollisionChecker(work->robot, group, model);
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
  for ([[maybe_unused]] auto _ : state) {
    num_free += checker.IsFree(configurations[i]) ? 1 : 0;
    i = i + 1 == configurations.size() ? 0 : i + 1;
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["free"] = static_cast<double>(num_free) / static_cast<double>(state.iterations());
}

/// Calls visit(block) for 16 configurations after another, round and round.
template <typename Visit>
void VisitBlocks(benchmark::State& state, const std::vector<Configuration>& configurations,
                 Visit visit) {
  std::vector<double> rows;
  for (const Configuration& q : configurations) rows.insert(rows.end(), q.begin(), q.end());
  const std::size_t size = kBlock * configurations.front().size();
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    visit(std::span<const double>(rows).subspan(i, size));
    i = i + 2 * size > rows.size() ? 0 : i + size;
  }
  state.SetItemsProcessed(state.iterations() * kBlock);
}

void CheckBlocks(benchmark::State& state, CollisionChecker& checker,
                 const std::vector<Configuration>& configurations) {
  std::vector<unsigned char> free(kBlock);
  std::int64_t num_free = 0;
  VisitBlocks(state, configurations, [&](std::span<const double> block) {
    checker.CheckAll(block, kBlock, free);
    num_free += std::count(free.begin(), free.end(), 1);
  });
  state.counters["free"] =
      static_cast<double>(num_free) / static_cast<double>(state.iterations() * kBlock);
}

/// Edges from each free configuration towards the next, cut to at most `max_length` (L2, rad and
/// m).
void CheckEdges(benchmark::State& state, Workload& work, double max_length) {
  EdgeChecker edges(work.checker.get(), work.robot.edge_resolution_m, work.edge_check);
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
  for ([[maybe_unused]] auto _ : state) {
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

/// 32 samples of each of 200 free edges of length 1 (L2, rad and m).
void CheckUnitEdges(benchmark::State& state, Workload& work) {
  CollisionChecker& checker = *work.checker;
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal;
  std::vector<MotionSample> samples;
  for (int i = 1; i <= 32; ++i) samples.push_back({i / 32.0});
  struct Edge {
    Configuration start;
    Configuration motion;
  };
  std::vector<Edge> edges;
  for (std::size_t tries = 0; edges.size() < 200 && tries < 1'000'000; ++tries) {
    const Configuration& start = work.free[tries % work.free.size()];
    Configuration motion(start.size());
    double squared = 0;
    for (double& value : motion) {
      value = normal(generator);
      squared += value * value;
    }
    Configuration end = start;
    for (std::size_t j = 0; j < end.size(); ++j) end[j] += motion[j] /= std::sqrt(squared);
    if (!checker.space().WithinLimits(end)) continue;
    if (checker.CheckSamples(start, motion, samples).blocked != 0) continue;
    edges.push_back({start, motion});
  }
  if (edges.empty()) throw InputError("hardly an edge of this problem is free");
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(checker.CheckSamples(edges[i].start, edges[i].motion, samples));
    i = i + 1 == edges.size() ? 0 : i + 1;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples.size()));
}

/// A closed, knobbly mesh of 2000 triangles within a box of that size.
Mesh MakePebble(const Eigen::Vector3d& size) {
  constexpr int kRows = 26;
  constexpr int kColumns = 40;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, -size.z() / 2}, {0, 0, size.z() / 2}};
  const auto at = [](int row, int column) {
    return static_cast<std::uint32_t>(2 + (row - 1) * kColumns + column % kColumns);
  };
  for (int row = 1; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const double a = 2 * std::numbers::pi * column / kColumns;
      const double b = std::numbers::pi * (static_cast<double>(row) / kRows - 0.5);
      const double knobs = 0.45 + 0.05 * std::sin(5 * a) * std::cos(6 * b);
      mesh.vertices.push_back(
          knobs * size.cwiseProduct(Eigen::Vector3d(std::cos(b) * std::cos(a),
                                                    std::cos(b) * std::sin(a), std::sin(b))));
    }
  }
  for (int column = 0; column < kColumns; ++column) {
    mesh.triangles.push_back({0, at(1, column + 1), at(1, column)});
    mesh.triangles.push_back({1, at(kRows - 1, column), at(kRows - 1, column + 1)});
    for (int row = 1; row + 1 < kRows; ++row) {
      mesh.triangles.push_back({at(row, column), at(row, column + 1), at(row + 1, column + 1)});
      mesh.triangles.push_back({at(row, column), at(row + 1, column + 1), at(row + 1, column)});
    }
  }
  return {"", Eigen::Vector3d::Ones(), std::move(mesh)};
}

/// The same number of boxes, or of pebbles of their sizes, in every cubic metre around the robot,
/// however many there are.
Scene MakeThings(int num, bool meshes) {
  Scene scene;
  std::mt19937_64 generator(3);
  const double half_extent = std::cbrt(num / 10.0) / 2 * 1.5;
  std::uniform_real_distribution<double> place(-half_extent, half_extent);
  std::uniform_real_distribution<double> size(0.02, 0.1);
  std::uniform_real_distribution<double> angle(-3, 3);
  for (int i = 0; i < num; ++i) {
    SceneObject object;
    object.id = fmt::format("thing{}", i);
    do {
      object.X_WO.translation() << place(generator) + 0.6, place(generator), place(generator) + 0.8;
      // Not where the robot stands.
    } while (object.X_WO.translation().head<2>().norm() < 0.45);
    object.X_WO.linear() =
        Eigen::AngleAxisd(angle(generator), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d edges(size(generator), size(generator), size(generator));
    object.shapes.push_back(
        {meshes ? Shape(MakePebble(edges)) : Shape(Box{edges}), Eigen::Isometry3d::Identity()});
    scene.objects.push_back(std::move(object));
  }
  return scene;
}

void CheckAmong(benchmark::State& state, Workload& work, const Scene& things, bool edges) {
  Scene scene = things;
  scene.allowed_collisions = work.problem.scene.allowed_collisions;
  work.checker->SetScene(scene, work.base_positions);
  // What an engine makes when it is first needed is not what is measured.
  for (std::size_t i = 0; i < 1000; ++i) work.checker->IsFree(work.random[i]);
  if (edges) {
    CheckEdges(state, work, 1.0);
  } else {
    CheckBlocks(state, *work.checker, work.random);
  }
  work.checker->SetScene(work.problem.scene, work.base_positions);
}

/// Joins the nearest two spheres of a link, wherever that enlarges least, until `num` are left: a
/// model of another's size, to compare times only.
void ReduceSpheres(Robot* robot, std::size_t num) {
  auto& spheres = robot->spheres;
  while (spheres.size() > num) {
    std::size_t best_a = 0;
    std::size_t best_b = 0;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < spheres.size(); ++a) {
      for (std::size_t b = a + 1; b < spheres.size(); ++b) {
        if (spheres[a].link != spheres[b].link) continue;
        const double radius =
            ((spheres[a].p_LS - spheres[b].p_LS).norm() + spheres[a].radius + spheres[b].radius) /
            2;
        const double growth = radius - std::max(spheres[a].radius, spheres[b].radius);
        if (growth < best) {
          best = growth;
          best_a = a;
          best_b = b;
        }
      }
    }
    LinkSphere& large =
        spheres[best_a].radius > spheres[best_b].radius ? spheres[best_a] : spheres[best_b];
    const std::size_t gone = &large == &spheres[best_a] ? best_b : best_a;
    spheres.erase(spheres.begin() + static_cast<std::ptrdiff_t>(gone));
  }
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
  benchmark::RegisterBenchmark("unit_edge",
                               [work](benchmark::State& state) { CheckUnitEdges(state, *work); });
  benchmark::RegisterBenchmark("distances/free", [work](benchmark::State& state) {
    std::vector<double> distances(kBlock);
    VisitBlocks(state, work->free, [&](std::span<const double> block) {
      work->checker->FindDistances(block, kBlock, 0.1, distances);
    });
  });
  for (const bool meshes : {false, true}) {
    for (const int num : {10, 100, 1000, 10000}) {
      if (meshes && num > 100) continue;
      for (const bool edges : {false, true}) {
        benchmark::RegisterBenchmark(
            fmt::format("{}/{}/{}", meshes ? "meshes" : "boxes", edges ? "edges" : "random", num)
                .c_str(),
            [work, meshes, num, edges](benchmark::State& state) {
              CheckAmong(state, *work, MakeThings(num, meshes), edges);
            });
      }
    }
  }
  for (const double length : {0.2, 1.0, 100.0}) {
    benchmark::RegisterBenchmark(
        fmt::format("edge/at_most_{}", length).c_str(),
        [work, length](benchmark::State& state) { CheckEdges(state, *work, length); });
  }
  benchmark::RegisterBenchmark("closest/free", [work](benchmark::State& state) {
    std::size_t i = 0;
    for ([[maybe_unused]] auto _ : state) {
      benchmark::DoNotOptimize(work->checker->FindClosest(work->free[i]));
      i = i + 1 == work->free.size() ? 0 : i + 1;
    }
    state.SetItemsProcessed(state.iterations());
  });
  benchmark::RegisterBenchmark("set_scene", [work](benchmark::State& state) {
    for ([[maybe_unused]] auto _ : state)
      work->checker->SetScene(work->problem.scene, work->base_positions);
    state.SetItemsProcessed(state.iterations());
  });
}

int Main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::string problems;
  RobotFlags robot{.folder = "fetch", .spheres = {}, .package_paths = {}};
  CollisionModel model = CollisionModel::kSpheres;
  int index = 1;
  CLI::App app("Throughput of collision checking on one problem", "collision_benchmark");
  app.add_option("--problems", problems, "Folder of a problem set")->required();
  app.add_option("--index", index, "Number of the problem")->capture_default_str();
  robot.AddTo(&app).front()->capture_default_str();
  app.add_option("--model", model, "Collision model; default: spheres")
      ->transform(OneOf<CollisionModel>());
  std::string engine = "fast";
  EdgeCheck edge_check = EdgeCheck::kFixed;
  std::size_t num_spheres = 0;
  app.add_option("--engine", engine, "fast or exact")
      ->check(CLI::IsMember({"fast", "exact"}))
      ->capture_default_str();
  app.add_option("--edge-check", edge_check, "Method; default: fixed")
      ->transform(OneOf<EdgeCheck>());
  app.add_option("--num-spheres", num_spheres, "Reduce the robot's spheres to this many");
  return RunCommand(&app, argc, argv, [&] {
    Workload work = Prepare(robot, problems, index);
    if (num_spheres > 0) ReduceSpheres(&work.robot, num_spheres);
    work.edge_check = edge_check;
    AddConfigurations(&work, model, engine == "exact");
    benchmark::AddCustomContext("problem", fmt::format("{} {}", problems, index));
    benchmark::AddCustomContext("engine", std::string(work.checker->EngineName()));
    benchmark::AddCustomContext("model", std::string(EnumName(model)));
    Register(&work);
    benchmark::RunSpecifiedBenchmarks();
    return kExitOk;
  });
}

}  // namespace
}  // namespace planbench

int main(int argc, char** argv) { return planbench::Main(argc, argv); }
