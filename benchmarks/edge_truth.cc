// What the fast engine's verdicts are worth, in one published problem. Random configurations: those
// that the exact engine judges otherwise. Edges accepted by the certified and by the fixed method:
// checked again at 64 times the resolution; what then collides is judged by the exact engine.
//
//   edge_truth --problems DIR [--index N] [--robot DIR] [--package-path NAME=DIR]
//   [--model spheres|meshes|enclosing] [--configurations 1000000] [--edges 1000000] [--length 0.5]

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
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

struct Tally {
  long long accepted = 0;
  long long colliding = 0;
  double deepest_m = 0;
};

/// Largest depth of the edge at samples of the checker's resolution that the exact engine finds; 0
/// if it finds none.
double Depth(const EdgeChecker& fine, CollisionChecker* exact, std::span<const double> from,
             std::span<const double> to) {
  double depth = 0;
  fine.VisitSamples(from, to, [&](double, std::span<const double> q) {
    if (!exact->IsFree(q)) {
      depth = std::max(
          depth, std::max(-exact->FindClosest(q).distance_m, std::numeric_limits<double>::min()));
    }
    return true;
  });
  return depth;
}

void CompareConfigurations(CollisionChecker* fast, CollisionChecker* exact, long long num,
                           std::mt19937_64* generator) {
  constexpr int kBlock = 16;
  const JointSpace& space = fast->space();
  const auto n = static_cast<std::size_t>(space.size());
  std::vector<double> qs(kBlock * n);
  std::vector<unsigned char> free(kBlock);
  long long num_free = 0;
  long long num_strict = 0;   // free for the exact engine alone
  long long num_lenient = 0;  // free for the fast engine alone
  double farthest = 0;        // from contact, of the former
  for (long long done = 0; done < num; done += kBlock) {
    for (std::size_t k = 0; k < qs.size(); ++k) {
      const JointSpace::Joint& joint = space.joint(static_cast<int>(k % n));
      qs[k] = std::uniform_real_distribution<double>(joint.lower, joint.upper)(*generator);
    }
    fast->CheckAll(qs, kBlock, free);
    for (std::size_t i = 0; i < free.size(); ++i) {
      const auto q = std::span(qs).subspan(i * n, n);
      const bool exact_free = exact->IsFree(q);
      num_free += exact_free ? 1 : 0;
      if ((free[i] != 0) == exact_free) continue;
      ++(exact_free ? num_strict : num_lenient);
      if (exact_free) farthest = std::max(farthest, exact->FindClosest(q).distance_m);
    }
  }
  fmt::print(
      "configurations {}: free {}, of them refused {}, at most {:.3f} mm from contact; "
      "accepted though they collide {}\n",
      num, num_free, num_strict, 1000 * farthest, num_lenient);
}

int Main(int argc, char** argv) {
  std::string problems;
  RobotFlags robot_flags{.folder = "fetch", .spheres = {}, .package_paths = {}};
  int index = 1;
  CollisionModel model = CollisionModel::kSpheres;
  long long num_configurations = 1'000'000;
  long long num_edges = 1'000'000;
  double length = 0.5;
  CLI::App app(
      "Compares the fast engine with the exact one, rechecks accepted edges 64 times finer",
      "edge_truth");
  app.add_option("--problems", problems, "Folder of a problem set")->required();
  app.add_option("--index", index, "Number of the problem")->capture_default_str();
  robot_flags.AddTo(&app).front()->capture_default_str();
  app.add_option("--model", model, "Collision model; default: spheres")
      ->transform(OneOf<CollisionModel>());
  app.add_option("--configurations", num_configurations, "Random configurations to compare")
      ->capture_default_str();
  app.add_option("--edges", num_edges, "Certified edges to accept")->capture_default_str();
  app.add_option("--length", length, "Longest edge, rad and m")->capture_default_str();
  return RunCommand(&app, argc, argv, [&] {
    const Robot robot = robot_flags.Load();
    const ProblemSet set = ListProblemSet(problems);
    const ProblemFiles* files = set.Find(index);
    if (files == nullptr) throw InputError(fmt::format("{} has no problem {}", problems, index));
    const Problem problem = ReadProblem(files->scene, files->request, robot);
    const auto base = FullPositions(robot.model, problem.start.names, problem.start.positions,
                                    files->request.string());
    const PlanningGroup& group = robot.Group(problem.group);
    const auto fast = MakeCollisionChecker(robot, group, model);
    const auto exact = MakeReferenceChecker(robot, group, model);
    fast->SetScene(problem.scene, base);
    exact->SetScene(problem.scene, base);
    EdgeChecker certified(fast.get(), robot.edge_resolution_m, EdgeCheck::kCertified);
    EdgeChecker fixed(fast.get(), robot.edge_resolution_m, EdgeCheck::kFixed);
    EdgeChecker fine(fast.get(), robot.edge_resolution_m / 64, EdgeCheck::kFixed);

    std::mt19937_64 generator(1);
    const JointSpace& space = group.space;
    CompareConfigurations(fast.get(), exact.get(), num_configurations, &generator);
    Tally tallies[2];
    std::vector<double> from(group.joints.size());
    std::vector<double> to(group.joints.size());
    while (tallies[0].accepted < num_edges) {
      for (std::size_t j = 0; j < from.size(); ++j) {
        const JointSpace::Joint& joint = space.joint(static_cast<int>(j));
        std::uniform_real_distribution<double> position(joint.lower, joint.upper);
        from[j] = position(generator);
        to[j] = position(generator);
      }
      space.Interpolate(from, to, std::min(1.0, length / space.Distance(from, to)), to);
      EdgeChecker* const methods[] = {&certified, &fixed};
      for (int m = 0; m < 2; ++m) {
        if (!methods[m]->IsValidEdge(from, to)) continue;
        ++tallies[m].accepted;
        if (fine.IsValidEdge(from, to)) continue;
        // The fast engine errs towards collision by up to 0.1 mm.
        const double depth = Depth(fine, exact.get(), from, to);
        if (depth == 0) continue;
        ++tallies[m].colliding;
        tallies[m].deepest_m = std::max(tallies[m].deepest_m, depth);
      }
    }
    for (int m = 0; m < 2; ++m) {
      fmt::print(
          "{:9} accepted {:8}  colliding when rechecked {:6} ({:.4f} %)  deepest {:.2f} mm\n",
          EnumName(m == 0 ? EdgeCheck::kCertified : EdgeCheck::kFixed), tallies[m].accepted,
          tallies[m].colliding,
          100.0 * static_cast<double>(tallies[m].colliding) /
              static_cast<double>(tallies[m].accepted),
          1000 * tallies[m].deepest_m);
    }
    fmt::print("configurations an edge: certified {:.1f}, fixed {:.1f}\n",
               static_cast<double>(certified.counters().configurations) /
                   static_cast<double>(certified.counters().edges),
               static_cast<double>(fixed.counters().configurations) /
                   static_cast<double>(fixed.counters().edges));
    return kExitOk;
  });
}

}  // namespace
}  // namespace planbench

int main(int argc, char** argv) { return planbench::Main(argc, argv); }
