#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "collision/collision_checker.h"
#include "collision/fcl/fcl_shape.h"
#include "collision/fcl/sphere_tree.h"
#include "collision/geometry_bound.h"
#include "collision/rigid_bodies.h"

namespace planbench {

/// The FCL engine, in double precision: robot spheres or the URDF's collision geometry against
/// exact shapes.
///
/// What a check costs is decided in SetScene: it lists the pairs of geometries that may meet at
/// all, decides once those that do not move relative to each other, and drops those out of each
/// other's reach. A check moves one frame per group joint and then asks, pair by pair, first the
/// bounding sphere of one against the bounding box of the other, then (sphere against sphere) plain
/// arithmetic or (anything else) FCL's narrow phase. A stretch of a motion is free if each pair is
/// further apart at its middle than the bound on the motion of that pair, of one relative to the
/// other.
class FclChecker : public CollisionChecker {
 public:
  /// `model`: with kVoxels links are not checked against objects, which a distance field does; all
  /// else is as with kSpheres. Throws InputError if the robot has no spheres, no collision
  /// geometry, or a mesh that cannot be read.
  FclChecker(const Robot& robot, const PlanningGroup& group, CollisionModel model);

  std::string_view EngineName() const override { return "fcl"; }
  /// True if bodies collide that do not move relative to each other, so that no configuration of
  /// the scene set last is free.
  bool AlwaysCollides() const { return standing_contact_.has_value(); }

  enum class Pairs { kAll, kSelected };
  /// Selects, for the scene set last, the pairs with an attached object or with one of the scene's
  /// objects for which `objects` (by place in its list) is not 0.
  void Select(std::span<const unsigned char> objects);
  /// The verdict, in bit 0, on the stretch q +- half_length * motion: the configuration q alone if
  /// half_length is 0. Sizes are not checked.
  SampleVerdicts CheckStretch(std::span<const double> q, std::span<const double> motion,
                              double half_length, Pairs pairs);

 protected:
  MotionBound DoSetScene(const Scene& scene, std::span<const double> base_positions) override;
  bool DoIsFree(std::span<const double> q) override;
  SampleVerdicts DoCheckSamples(std::span<const double> start, std::span<const double> motion,
                                std::span<const MotionSample> samples, SampleRole role) override;
  std::optional<Contact> DoFindContact(std::span<const double> q) override;
  ClosestPair DoFindClosest(std::span<const double> q) override;
  void DoFindDistances(std::span<const double> qs, int num, double at_most,
                       std::span<double> distances) override;

 private:
  /// Geometry of one link, in the link's frame.
  struct LinkShapes {
    int link;
    SphereTree spheres;                             // spheres model
    std::vector<std::pair<FclShape, Pose>> shapes;  // meshes model, X_LS
  };
  /// A body: a link with geometry, an object, or an attached object.
  struct Body {
    enum class Kind { kLink, kObject, kAttached } kind;
    int index;  // link index, or index in the scene's list
    std::string name;
  };
  /// One thing to test: the sphere tree of a link, or one shape. Frame S is the rigid body's frame
  /// for a tree, the shape's own for a shape.
  struct Geometry {
    int body = 0;        // index into bodies_
    int rigid_body = 0;  // that it is fixed to
    int pose = 0;        // index into poses_: X_WS
    Pose X_GS;           // in the rigid body's frame
    const SphereTree* tree = nullptr;
    const FclShape* shape = nullptr;
    Eigen::Vector3d ball_center = Eigen::Vector3d::Zero();  // bounding ball and box, in S
    double ball_radius = 0;
    Eigen::Vector3d box_center = Eigen::Vector3d::Zero();
    Eigen::Vector3d box_half_size = Eigen::Vector3d::Zero();
    int first_node = 0;  // of a tree: where its nodes' world positions begin in node_positions_
  };
  /// Two geometries to test against each other. If one is a tree, the source is; of two trees the
  /// smaller.
  struct Pair {
    int source;
    int target;
    bool can_meet;
    int reach =
        0;  // where the bound on its relative motion begins in reaches_; others may share it
  };
  /// Indices into pairs_: those that can meet (often hit first), then the others.
  struct PairList {
    std::vector<int> order;
    std::size_t num_meeting = 0;
  };

  void AddLink(const LinkShapes& link);
  void AddShapes(int body, int rigid_body, const Pose& X_GO, const std::vector<PlacedShape>& shapes,
                 const std::string& name);
  void AddGeometry(Geometry geometry);
  void ListPairs(const Scene& scene);
  bool ChecksBodies(const class PairRules& rules, const Scene& scene, const Body& a,
                    const Body& b) const;
  bool OutOfReach(const Geometry& moving, const Geometry& carrier) const;
  /// Returns where it begins in reaches_.
  int AddReach(const Geometry& a, const Geometry& b);
  template <typename Takes>
  PairList List(Takes takes) const;

  void Place(std::span<const double> q);
  void PlaceNodes(int geometry);
  double RelativeMotion(const Pair& pair, std::span<const double> motion) const;
  /// Whether the pair is no further apart than `margin`, m.
  bool Within(const Pair& pair, double margin);
  /// How deep the pair's shapes are in each other, m; 0 if they do not touch.
  double Depth(const Pair& pair);
  double Distance(const Pair& pair, double at_most);
  double DistanceBound(const Pair& pair) const;
  /// If nothing is nearer than `at_most`, what stands closest or nothing.
  ClosestPair FindClosestWithin(std::span<const double> q, double at_most);
  /// The distance of the pair that was closest last, or `at_most`. It is at most what it was then
  /// and the way that the two have moved since.
  double LastClosestNow(std::span<const double> q, double at_most);
  Contact ContactOf(std::span<const Pair> pairs, const Pair& touching);
  void SetClosest(const Pair& pair, double distance, ClosestPair* closest) const;

  std::vector<LinkShapes> links_;
  std::optional<GeometryBound> geometry_bound_;

  // Of the scene set last.
  std::optional<RigidBodies> rigid_bodies_;
  std::vector<Body> bodies_;
  std::deque<SphereTree> trees_;
  std::deque<FclShape> object_shapes_;
  std::vector<Geometry> geometries_;
  std::vector<Pair> pairs_;                  // whose relative pose varies, in fixed order
  std::optional<Contact> standing_contact_;  // of pairs whose relative pose does not vary
  ClosestPair standing_closest_;
  std::vector<double> reaches_;  // m/rad: n values each, see MotionBound
  PairList all_;
  PairList selected_;

  // Of the configuration checked last.
  std::vector<Pose> poses_;                      // rigid bodies, then shapes
  std::vector<int> moving_;                      // geometries that are fixed to a moving body
  std::vector<Eigen::Vector3d> ball_positions_;  // in W, by geometry
  std::vector<Eigen::Vector3d> node_positions_;  // in W, see Geometry::first_node
  std::vector<std::int64_t> placed_at_;  // by geometry: the value of placement_ its nodes are of
  std::int64_t placement_ = 0;
  std::vector<std::pair<double, int>> by_bound_;  // scratch of FindClosestWithin
  /// What FindClosestWithin found last.
  struct LastClosest {
    int pair = -1;  ///< Index, -1 if there is none.
    double distance_m = 0;
    std::vector<double> q;
  };
  LastClosest last_closest_;
  std::vector<double> q_;  // scratch of CheckSamples
};

}  // namespace planbench
