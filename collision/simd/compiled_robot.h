#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "collision/rigid_bodies.h"
#include "collision/simd/ball_tree.h"
#include "collision/simd/kernels/sphere_kernel.h"
#include "collision/simd/robot_meshes.h"
#include "robot_model/robot_folder.h"

namespace planbench {

/// Balls and triangles are enlarged by this much, m, which covers the rounding of positions that
/// single precision gives within kPaddedReach, m, and in proportion by more further out: verdicts
/// err towards collision.
inline constexpr double kRadiusPadding = 2e-5;
inline constexpr double kPaddedReach = 5;
/// Of what is nowhere further than so far (m) from W's origin, with a robot's links between them.
inline double PaddingWithin(double reach) {
  return kRadiusPadding * std::max(1.0, reach / kPaddedReach);
}

/// A tree of balls in the kernel's robot.
struct CompiledTree {
  int link = -1;  ///< Whose spheres they are; -1 for all of a body's.
  int body = 0;
  int root = 0;          ///< Node index.
  Ball reach_W;          ///< That the tree never leaves while prismatic joints are WithinTravel.
  kernels::Reach reach;  ///< Its motion bound relative to W.
  const LinkMeshes* meshes = nullptr;  ///< What it is of; null: balls.
  bool doubtful = false;               ///< The balls stand for something inside them.
};

/// A robot's spheres or meshes, sorted by link, as the kernels take them, with joints outside the
/// group held.
struct CompiledRobot {
  /// `base_positions`: full positions, at which joints outside the group are held. `meshes`: which
  /// take the place of the spheres, unless null; must outlive it.
  CompiledRobot(const Robot& robot, const PlanningGroup& group,
                std::span<const double> base_positions, const std::vector<LinkSphere>& spheres,
                const RobotMeshes* meshes);
  CompiledRobot(const CompiledRobot&) = delete;
  CompiledRobot& operator=(const CompiledRobot&) = delete;

  /// How much of the kernel's robot there is.
  struct Extent {
    std::size_t nodes = 0;
    std::size_t reaches = 0;
    std::size_t pairs = 0;
    std::size_t inside_tests = 0;
    std::size_t patches = 0;
    std::size_t insides = 0;
    std::size_t triangles = 0;
    std::size_t points = 0;
  };
  Extent extent() const {
    return {kernel.nodes.size(),        kernel.reaches.size(), kernel.pairs.size(),
            kernel.inside_tests.size(), kernel.patches.size(), kernel.insides.size(),
            triangles_.size(),          points_.size()};
  }
  /// Forgets the balls and pairs that were added since.
  void Truncate(const Extent& extent);

  /// A tree of balls fixed to a link, given in the link's frame, around something that is not the
  /// robot's: doubtful.
  CompiledTree AddTree(int link, const BallTree& tree_L);
  /// A tree of such shapes themselves, which must outlive it. `meshes`: of one link.
  CompiledTree AddTree(const RobotMeshes& meshes);

  /// A link's or an attached object's tree and one that was added, of different bodies.
  void AddAttachedPair(const CompiledTree& other, const CompiledTree& tree);
  /// The pairs of links of two bodies (or one) that `checks` names, as few pairs of trees as serve.
  /// Those of one body do not move relative to each other: the least of `distance` (m) and theirs
  /// is stored there. Of meshes it is a lower bound; whether they collide the kernel has to be
  /// asked of `standing`.
  void AddPairs(const CompiledTree& body_a, const CompiledTree& body_b,
                const std::function<bool(const CompiledTree&, const CompiledTree&)>& checks,
                double* distance);

  kernels::SphereRobot kernel;
  /// Of meshes: what does not move relative to each other, as pairs that hold at any configuration.
  struct Standing {
    std::vector<kernels::TreePair> pairs;
    std::vector<kernels::InsideTest> inside_tests;
  };
  Standing standing;
  std::vector<CompiledTree> links;   ///< Of every link that has spheres, in link order.
  std::vector<CompiledTree> bodies;  ///< Of every body that has spheres, in body order.

 private:
  /// A pair of trees of different bodies, unless they can never meet within the joint limits.
  void AddPair(const CompiledTree& a, const CompiledTree& b);
  /// The weights of a pair's bound, unless the reach of their bodies keeps them apart.
  std::optional<kernels::Reach> AddReachOfPair(const CompiledTree& a, const CompiledTree& b);
  /// Writes a tree whose root has its place already; `link`: one of the body's. `first_patch`: the
  /// kernel's number of the first of its patches.
  void Emit(const BallTree& tree, int link, int index, int first_patch);
  /// `padding`: of its balls.
  void Emit(const BallTree& tree, int link, int index, int first_patch, double padding);
  /// What covers the rounding of all in a ball of a body.
  double PaddingOf(const Ball& ball_G, int body) const;
  void SetBall(const Ball& ball_G, double padding, int link, int index);
  /// Of the link's, if it has any.
  const LinkMeshes* MeshesOf(int link) const;
  Pose PoseOfLink(int link) const;  ///< X_CL
  CompiledTree EmitAttached(int link, const BallTree& tree_L, int first_patch);
  /// Whenever these may have moved.
  void ShareArrays();
  void AddPatches(const std::vector<RobotMeshes::Patch>& patches);
  /// Returns the offset into SphereRobot::reaches. Of points within `radius` of the centre.
  int AddReach(const Ball& ball_G, int link, double radius = 0);
  kernels::Reach AddReachOfTree(int root);
  /// Of weights at that offset.
  kernels::Reach ReachAt(int first) const;
  /// Values of a tree's or a pair's bound: see TreePair.
  std::size_t ReachSize() const { return 2 * static_cast<std::size_t>(kernel.num_joints); }
  /// Of points in a frame whose pose in C is given.
  kernels::NodeHull AddHull(const Hull& hull, const Pose& X_C, double padding);
  /// In the body's frame G, enlarged.
  Ball BallOf(const kernels::Node& node, int body) const;
  Ball RootBall(const CompiledTree& tree) const;
  std::vector<int> NodesBelow(int root) const;  ///< Indices, its own first.
  /// A link and another link of a body, or all of these: the body's own tree.
  using LinkPairs = std::vector<std::pair<const CompiledTree*, const CompiledTree*>>;
  /// A pair of trees that stands for pairs of links.
  void AddLinkPairs(const CompiledTree& a, const CompiledTree& b, const LinkPairs& links_of);
  /// Balls that together hold what the tree does: its leaves, of meshes larger ones.
  std::vector<Ball> BallsOf(const CompiledTree& tree) const;
  /// Closed meshes and points of a link.
  void AddInsides(const LinkMeshes& link, int root);
  /// One point at least of each connected part, in C.
  std::vector<std::array<float, 3>> PointsOf(const CompiledTree& tree) const;
  /// Points of one link or object that may be inside of closed meshes of the other.
  void AddInsideTests(const CompiledTree& of, const CompiledTree& in,
                      std::vector<kernels::InsideTest>* tests) const;
  /// False if `moving` never comes near `carrier` whatever the joints between them do.
  bool WithinReach(const CompiledTree& carrier, const CompiledTree& moving) const;
  /// True if it is proven that the trees never meet within the limits: the joints between them are
  /// few, and their ranges can be covered with boxes over each of which the trees move less than
  /// they are apart.
  bool ProvenApart(const CompiledTree& a, const CompiledTree& b,
                   std::span<const float> reach) const;
  void SamplePoses();
  bool RootsTouch(const CompiledTree& a, const CompiledTree& b,
                  const std::vector<Pose>& X_WG) const;
  /// Share of the configurations at which the trees' root balls touch.
  double ShareTouching(const CompiledTree& a, const CompiledTree& b) const;
  kernels::TreePair PairOf(const CompiledTree& a, const CompiledTree& b,
                           const kernels::Reach& reach) const;
  /// Puts a gate before the pairs of two bodies, those from `first` on, if that saves tests.
  void AddGate(const CompiledTree& a, const CompiledTree& b, std::size_t first);
  /// Index of a table of two bodies, which is made when first asked for and kept when pairs are
  /// forgotten; negative if there is none that serves.
  int TableOf(const CompiledTree& carrier, const CompiledTree& moving, const kernels::Reach& reach);
  std::optional<kernels::JointTable> MakeTable(const CompiledTree& carrier,
                                               const CompiledTree& moving,
                                               const kernels::Reach& reach) const;
  /// How far a ball (in the body's frame) is from a link at least, m, or `at_most` if that is less.
  double Apart(const CompiledTree& link, const Ball& ball_G, double at_most) const;
  /// Adds what of a pair is not proven apart.
  void AddProven(const CompiledTree& a, const CompiledTree& b, const kernels::Reach& reach);

  const RobotModel* model_;
  const PlanningGroup* group_;
  std::vector<double> base_positions_;
  RigidBodies rigid_bodies_;
  std::vector<std::vector<Pose>> samples_;  ///< X_WG at configurations all over the limits.
  std::vector<Eigen::Matrix3d> R_CG_;       ///< By body: from RigidBodies' frame to the kernel's.
  const RobotMeshes* meshes_;
  std::map<std::pair<int, int>, int> tables_;  ///< By bodies: the first carries the second.
  std::vector<kernels::TriangleGroup> triangles_;
  std::vector<kernels::PointGroup> points_;
};

}  // namespace planbench
