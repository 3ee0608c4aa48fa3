// What a request costs as the problem grows: objects in the world, triangles of its meshes, joints
// of the robot. RRT-Connect or ARA*, without the bus, between random free configurations; a row for
// each size.
//
//   scale_benchmark [--planner rrtc|ara] [--queries N] [--time SECONDS]
//
// setup: from the request to the beginning of the search, the scene handed to the collision checker
// included; planning: setup included; both ms, medians over all queries, those not solved with the
// time they took. check: us of collision checking a configuration, over all queries.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/command_line.h"
#include "common/error.h"
#include "common/exit_codes.h"
#include "common/random.h"
#include "planner_ara/ara_planner.h"
#include "planner_rrtc/rrtc_planner.h"
#include "planning/planner_settings.h"
#include "results/statistics.h"
#include "tests/support/generated_meshes.h"
#include "tests/support/planning_problems.h"
#include "tests/support/random_robot.h"

namespace planbench {
namespace {

struct Flags {
  std::string planner = "rrtc";
  int num_queries = 20;
  double time_limit_s = 2;
};

double Between(double lower, double upper, std::mt19937_64* random) {
  return lower + UniformFraction(random) * (upper - lower);
}

/// Free configurations, drawn evenly within the limits.
Path DrawFree(const Robot& robot, const Scene& scene, int num, std::mt19937_64* random) {
  const PlanningGroup& group = robot.groups.front();
  const auto checker = MakeCollisionChecker(robot, group, CollisionModel::kSpheres);
  checker->SetScene(scene, robot.model.DefaultPositions());
  Path drawn;
  for (int tries = 0; static_cast<int>(drawn.size()) < num; ++tries) {
    if (tries == 1'000'000) throw InputError("hardly a configuration is free");
    Configuration q;
    for (const JointSpace::Joint& joint : group.space.joints()) {
      q.push_back(joint.continuous ? Between(-3, 3, random)
                                   : Between(joint.lower, joint.upper, random));
    }
    if (checker->IsFree(q)) drawn.push_back(std::move(q));
  }
  return drawn;
}

class Costs {
 public:
  void Add(const PlanResult& result) {
    setup_ms_.push_back(1e3 * result.phases.setup_s);
    planning_ms_.push_back(1e3 * result.planning_time_s);
    collision_s_ += result.phases.collision_s;
    const double checked = result.counters.contains("configurations_checked")
                               ? result.counters.at("configurations_checked")
                               : 0;
    checked_.push_back(checked);
    num_checked_ += checked;
    if (result.Solves()) ++num_solved_;
  }
  void Print(const std::string& what, std::int64_t size) const {
    fmt::print("{:<28} {:>9} {:>4}/{:<4} {:>9.3f} {:>10.3f} {:>10.0f} {:>8.3f}\n", what, size,
               num_solved_, setup_ms_.size(), Summarize(setup_ms_).median,
               Summarize(planning_ms_).median, Summarize(checked_).median,
               1e6 * collision_s_ / num_checked_);
    std::fflush(stdout);
  }

 private:
  std::vector<double> setup_ms_;
  std::vector<double> planning_ms_;
  std::vector<double> checked_;
  double collision_s_ = 0;
  double num_checked_ = 0;
  int num_solved_ = 0;
};

void Ask(const Robot& robot, const Scene& scene, const Flags& flags, Costs* costs) {
  const YamlNode settings = YamlNode::Parse("{}", "settings");
  const std::unique_ptr<Planner> planner =
      flags.planner == "ara" ? MakeAraPlanner(robot, settings) : MakeRrtcPlanner(robot, settings);
  planner->WarmUp();
  std::mt19937_64 random(1);
  const Path ends = DrawFree(robot, scene, 2 * flags.num_queries, &random);
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    PlanRequest request = MakeRequest(robot, ends[i], ends[i + 1]);
    request.time_limit_s = flags.time_limit_s;
    request.simplify = false;
    if (i == 0) planner->Plan(request, scene, nullptr);  // what is made for the first request only
    costs->Add(planner->Plan(request, scene, nullptr));
  }
}

/// Boxes, or pebbles of so many triangles each, in a cube around the robot, not where it stands.
Scene MakeThings(const Robot& robot, int num, double half_extent, double size, int num_triangles) {
  Scene scene;
  scene.world_frame = robot.model.links().front().name;
  std::mt19937_64 random(3);
  for (int i = 0; i < num; ++i) {
    SceneObject thing;
    thing.id = fmt::format("thing{}", i);
    Eigen::Vector3d p;
    do {
      for (double& x : p) x = Between(-half_extent, half_extent, &random);
    } while (p.norm() < 0.3);
    thing.X_WO.translation() = p;
    thing.X_WO.linear() =
        Eigen::AngleAxisd(Between(-3, 3, &random), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const double edge = size * Between(0.5, 1.5, &random);
    Shape shape = Box{{edge, edge, edge}};
    if (num_triangles > 0) {
      const int n = static_cast<int>(std::sqrt(num_triangles / 2.0));
      Mesh mesh;
      mesh.triangles = SphereMesh(edge / 2, n, n + 1);
      shape = std::move(mesh);
    }
    thing.shapes.push_back({std::move(shape), Eigen::Isometry3d::Identity()});
    scene.objects.push_back(std::move(thing));
  }
  return scene;
}

void Measure(const Flags& flags) {
  fmt::print("{:<28} {:>9} {:>9} {:>9} {:>10} {:>10} {:>8}\n", "", "size", "solved", "setup ms",
             "planning ms", "checked", "check us");
  const Robot panda = LoadRobot(PLANBENCH_SOURCE_DIR "/robots/panda");
  for (const int num : {10, 100, 1000, 10000, 100000}) {
    Costs costs;
    Ask(panda, MakeThings(panda, num, 0.75 * std::cbrt(num / 10.0), 0.06, 0), flags, &costs);
    costs.Print("boxes, of one density", num);
  }
  // With more the robot has no room left.
  for (const int num : {10, 30, 100, 300, 1000}) {
    Costs costs;
    Ask(panda, MakeThings(panda, num, 0.9, 0.15 / std::cbrt(num / 10.0) / std::cbrt(num / 10.0), 0),
        flags, &costs);
    costs.Print("boxes within reach", num);
  }
  for (const int num : {1000, 10000, 100000, 1000000}) {
    Costs costs;
    Ask(panda, MakeThings(panda, 10, 0.75, 0.06, num / 10), flags, &costs);
    costs.Print("triangles of ten meshes", num);
  }
  for (const int num : {6, 8, 10, 12, 14}) {
    Costs costs;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Robot robot = MakeRandomRobot(num, seed);
      Ask(robot, MakeThings(robot, 30, 0.9, 0.1, 0), flags, &costs);
    }
    costs.Print("joints of five robots", num);
  }
}

int Main(int argc, char** argv) {
  Flags flags;
  CLI::App app("What a request costs as the problem grows", "scale_benchmark");
  app.add_option("--planner", flags.planner, "rrtc or ara")
      ->check(CLI::IsMember({"rrtc", "ara"}))
      ->capture_default_str();
  app.add_option("--queries", flags.num_queries, "Queries a row")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--time", flags.time_limit_s, "Time limit of a query, s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  return RunCommand(&app, argc, argv, [&] {
    Measure(flags);
    return kExitOk;
  });
}

}  // namespace
}  // namespace planbench

int main(int argc, char** argv) { return planbench::Main(argc, argv); }
