#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "collision/simd/kernels/triangle_tree.h"

// The vectorised sphere engine's inner part: plain arrays of floats in, bit masks out. A block of
// kBlock configurations is checked at once, one SIMD lane a configuration, with the widest
// instructions of the machine it runs on (Highway's run-time dispatch). What it is given has been
// compiled from the robot and the scene by CompiledScene; rounding is covered there, by padding.

namespace planbench::kernels {

/// Configurations in a block; arrays "by lane" have this many values.
inline constexpr int kBlock = 16;

/// A rigid body moved by one joint of the group. Frame C of the body: for a revolute joint its z
/// axis is the joint's, for a prismatic one its axes are the parent's. Body 0 is the base, whose
/// frame is W.
struct Body {
  int parent = 0;  ///< Index of a body before this one.
  int joint = 0;   ///< Index into the group's joints.
  bool prismatic = false;
  bool turns = false;                               ///< False if the rotation is W's for good.
  float rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< R_PC at joint position 0, row-major.
  float position[3] = {0, 0, 0};                    ///< p_PC at joint position 0, m.
  float axis[3] = {0, 0, 1};                        ///< Of a prismatic joint, in P.
};

/// A ball of a tree, in its body's frame (m): if it has no children a sphere of the robot, or what
/// encloses a patch of triangles; else it encloses all of its descendants. Children stand next to
/// each other, behind their parent.
struct Node {
  float center[3];
  float radius;
  std::int32_t first_child;
  std::int32_t num_children;
  /// Of one without children: where the weights of its own Reach stand; of a patch those of all of
  /// its points stand behind them. Others are CompiledRobot's.
  int reach;
  /// Radius of a ball about the same centre that is inside of what it encloses; 0: none is known.
  float inner = 0;
  std::int32_t patch = -1;  ///< Index into SphereRobot::patches, if not negative.
  /// Closed meshes that it encloses: from first_inside on in SphereRobot::insides.
  std::int32_t first_inside = 0;
  std::int32_t num_insides = 0;
};

/// A box along the axes of its frame, m.
struct CenteredBox {
  float center[3];
  float half_size[3];
};

/// Points of a hull; the places left repeat one.
struct alignas(64) PointGroup {
  float p[3][kWide];  ///< By axis, m.
};
/// Points of a hull, at most.
inline constexpr int kMostPoints = 4 * kWide;

/// The convex hull of some points of what a node encloses: of `num` groups from `first` on in
/// SphereRobot::points.
struct NodeHull {
  std::int32_t first = 0;
  std::int32_t num = 0;  ///< 0: none is known.
  float slack = 0;       ///< What the node encloses reaches no further beyond the hull, m.
  float padding = 0;     ///< What single precision rounds of it, m.
};

/// Part of a link's surface, in groups of triangles. Where these leave the part, and its ball and
/// boxes, they belong to others.
struct Patch {
  BoxGroup boxes;  ///< Around groups; children are indices into SphereRobot::triangles.
  int num_groups;
  NodeHull hulls[kWide];  ///< Of groups.
  CenteredBox box;        ///< Around all of them.
  float padding;          ///< Enlargement of the triangles, m: what single precision rounds.
  /// One of each connected part of the surface that this patch answers for.
  std::vector<std::array<float, 3>> points;
};

/// What a closed mesh of the robot encloses.
struct Inside {
  int body;
  float low[3], high[3];  ///< Bounding box, in the body's frame, m.
  float extent;           ///< No part of it is longer, m.
  const SolidMesh* mesh;
  double rotation[9], position[3];  ///< From the body's frame to the mesh's: R row-major, m.
};
/// Whether it does enclose a point, given in the body's frame (m).
bool Encloses(const Inside& inside, const float* p);

/// Points of a body that collide if they are inside of meshes of another.
struct InsideTest {
  int root_in, body_in;  ///< Node: a ball around these meshes.
  int body_of;
  bool doubtful;  ///< Where a point is in a mesh's bounding box is passed on as a doubt.
  std::vector<std::array<float, 3>> points;  ///< In the frame of body_of, m.
  /// A ball around the points.
  float center[3];
  float radius;
};

/// Bound of a motion over a box of configurations: half widths by weights, num_joints values at
/// `first` of SphereRobot::reaches, none of them above `most`. Only those of joints from `begin` to
/// before `end` can differ from zero.
struct Reach {
  int first = 0, begin = 0, end = 0;
  float most = 0;
};

/// Two trees to test against each other.
struct TreePair {
  int root_a, root_b;
  int body_a, body_b;
  bool doubtful;  ///< Hits are passed on as doubts.
  float radius;   ///< Sum of the roots'.
  Reach reach;    ///< Of the centres of balls; weights of all points of patches stand behind them.
  /// Of a gate: so many pairs after it are of parts of the bodies of these trees, and tested where
  /// it does not tell them apart.
  int num_behind = 0;
  /// Of a gate: index into SphereRobot::tables, which tell in the place of the balls; negative:
  /// none.
  int table = -1;
};

/// Lower bounds of how far two bodies are apart, by the positions of two joints between them.
struct JointTable {
  int joints[2];
  float low[2];                       ///< rad or m.
  float cells_per[2];                 ///< Cells per rad or m.
  float size[2];                      ///< Cells.
  float step;                         ///< Of a bound by its number, m.
  std::vector<std::uint32_t> values;  ///< Numbers, four a word; the first joint's position fastest.
};

/// What moves: kinematics, trees of balls, pairs of trees.
struct SphereRobot {
  int num_joints = 0;
  std::vector<Body> bodies;  ///< Parents first; [0] is the base.
  std::vector<Node> nodes;
  std::vector<TreePair> pairs;
  /// Of links of meshes and attached objects, in their bodies' frames; arrays are their owner's to
  /// keep.
  std::vector<Patch> patches;
  std::vector<NodeHull> hulls;  ///< By node.
  const PointGroup* points = nullptr;
  const TriangleGroup* triangles = nullptr;
  std::vector<Inside> insides;
  std::vector<InsideTest> inside_tests;
  std::vector<JointTable> tables;
  /// m/rad: how far the centres of balls move. A ball that turns about its centre stays where it
  /// is.
  std::vector<float> reaches;
};

enum class Kind : std::int32_t {
  kUprightBox,       ///< cos yaw, sin yaw, half sizes (3).
  kBox,              ///< Rows of R_OW (9), half sizes (3).
  kUprightCylinder,  ///< Radius, half length.
  kCylinder,         ///< Axis (3), radius, half length.
  kSphere,           ///< Radius.
  kCapsule,          ///< Axis (3), radius, half length of the segment.
  kCone,             ///< Axis to the apex (3), radius of the base, half length.
  kHalfSpace,        ///< Outward normal (3); `center` is on its surface.
};

/// A solid of the world, in W.
struct Solid {
  Kind kind;
  bool doubtful;  ///< Hits are passed on as doubts: it stands for something inside it.
  float center[3];
  float v[12];    ///< See Kind.
  float extent;   ///< Half its greatest size along its own axes, m.
  int mesh = -1;  ///< What it is a bound of, if not negative: index into SphereWorld::meshes.
};

/// Bounding-volume hierarchy over solids, depth first: `next` is the node behind the subtree, a
/// leaf lists `count` solids from `first` on in SphereWorld::bvh_solids.
struct BvhNode {
  float low[3], high[3];
  std::int32_t next, first, count;
};

/// A tree to test against the world.
struct WorldTree {
  int root;
  int body;
  bool doubtful;
  Reach reach;  ///< As in TreePair, relative to W.
  /// Solids it may meet: `num_candidates` from `first_candidate` on in SphereWorld::candidates. A
  /// negative number: those the hierarchy finds.
  int first_candidate, num_candidates;
  /// Solids that count at all, as far as they may be, likewise; a negative number: all.
  int first_checked, num_checked;
};

/// A grid of distances (m) in W: of a point in cell (i, j, k), cells being cubes of edge
/// `resolution` from `origin` on. A ball collides if the value at its centre is less than its
/// radius.
struct DistanceGrid {
  float origin[3] = {0, 0, 0};
  float resolution = 1;
  int size[3] = {0, 0, 0};
  float outside = 0;   ///< The value everywhere outside.
  float rounding = 0;  ///< Of the positions of balls, m.
  /// Whether single configurations are judged with it, too: a ball that far out is in any of the
  /// cells within it.
  bool is_far = false;
  const float* values = nullptr;  ///< x fastest.
};

/// What stands still.
struct SphereWorld {
  std::vector<Solid> solids;
  std::vector<WorldMesh> meshes;
  std::vector<WorldTree> trees;
  std::vector<std::int32_t> candidates;
  std::vector<BvhNode> bvh;
  std::vector<std::int32_t> bvh_solids;
  std::optional<DistanceGrid> grid;  ///< Tested with every tree that is not doubtful, if any.
};

/// Memory of one thread, and the order in which tests are made: those that hit move to the front.
class SphereScratch {
 public:
  SphereScratch();
  ~SphereScratch();
  SphereScratch(SphereScratch&&) noexcept;
  SphereScratch& operator=(SphereScratch&&) noexcept;
  /// Must be called when the robot or the world has changed.
  void Reset(const SphereRobot& robot, const SphereWorld& world);
  /// See Tests.
  void ForgetOpen();

  struct Buffers;
  Buffers& buffers() { return *buffers_; }

 private:
  std::unique_ptr<Buffers> buffers_;
};

/// Lanes by bit.
using LaneMask = std::uint32_t;

/// Which tests are made.
enum class Tests {
  kAll,
  /// With half widths: all; those that leave a lane open are added to the open ones. The others,
  /// which prove stretches of a motion free, need not be made again for what is cut of these.
  kFindOpen,
  kOpen,    ///< With half widths: the open ones, if they were found; else all.
  kScreen,  ///< Those against the world, and whether parts of the robot are inside of others.
};

struct BlockQuery {
  /// [joint][kBlock], rad or m; revolute |q| <= 2 pi, with tables pi.
  const float* q = nullptr;
  /// [joint][kBlock] or null. With them every lane stands for the box of configurations q +- width.
  const float* half_widths = nullptr;
  /// By lane or null, with half widths: what comes so near (m) counts as colliding.
  const float* margins = nullptr;
  LaneMask lanes = 0;  ///< Lanes to check.
  bool stop_at_first = false;
  Tests tests = Tests::kAll;
};

struct BlockVerdict {
  LaneMask hits = 0;     ///< Colliding; with half widths: not proven free.
  LaneMask certain = 0;  ///< Colliding at q itself. Equal to `hits` without half widths.
  LaneMask doubts = 0;   ///< In touch with something doubtful.
};

/// With stop_at_first it returns when the first certain collision is found, what it then says of
/// other lanes is incomplete.
BlockVerdict CheckBlock(const SphereRobot& robot, const SphereWorld& world, SphereScratch* scratch,
                        const BlockQuery& query);

/// Smaller of `at_most` (m, > 0) and the distance to the nearest solid and of the nearest pair, by
/// lane; 0 or less in collision. Doubtful ones count as they are.
void BlockDistances(const SphereRobot& robot, const SphereWorld& world, SphereScratch* scratch,
                    const float* q, float at_most, float* distances);

/// The group's joints, as configurations are put into lanes.
struct Joints {
  std::vector<std::uint8_t> slides;  ///< Prismatic; others are brought within +-pi.
  std::vector<double> lower, upper;  ///< Limits, rad or m.
  int size() const { return static_cast<int>(slides.size()); }
};

/// Writes up to kBlock configurations, given as rows (rad or m), by [joint][kBlock]; returns the
/// lanes of those outside of the limits.
LaneMask PlaceRows(const Joints& joints, const double* rows, int num_rows, float* q);

/// Configurations on a straight motion, as BlockQuery takes them.
struct SampleBlock {
  const float* start = nullptr;   ///< By joint, rad or m.
  const float* motion = nullptr;  ///< By joint.
  /// By lane: fraction of the motion, half the length of the stretch about it.
  float position[kBlock] = {};
  float half_length[kBlock] = {};
};
/// Writes start + position * motion, and half_length * |motion|, by [joint][kBlock]: each rounded
/// by some 2e-7 of itself, so that angles are as exact as others if |motion| is at most a turn.
void PlaceSamples(const Joints& joints, const SampleBlock& block, float* q, float* half_widths);

/// For tests: sines and cosines of kBlock angles, |angle| <= 2 pi; absolute error below 2e-7.
void BlockSinCos(const float* angles, float* sines, float* cosines);

/// Highway's name of the instruction set that is used here, e.g. "AVX3".
const char* InstructionSet();

}  // namespace planbench::kernels
