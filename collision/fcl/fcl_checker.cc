#include "collision/fcl/fcl_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "collision/at.h"
#include "collision/link_geometry.h"
#include "collision/model_spheres.h"
#include "collision/pair_rules.h"
#include "common/error.h"
#include "common/numbers.h"

namespace planbench {
namespace {

/// Culling may err towards "may touch" only; this absorbs the rounding of frames some metres apart.
constexpr double kRoundingMargin = 1e-12;
/// What distances by FCL's iterative solvers may differ between neighbouring configurations, m;
/// where they do by more the pair is asked without a limit.
constexpr double kSolverSlack = 1e-6;

inline bool BallMissesBox(const Eigen::Vector3d& center, double radius,
                          const Eigen::Vector3d& box_center, const Eigen::Vector3d& box_half_size) {
  // Most pairs are told apart along one axis.
  const double reach = radius + kRoundingMargin;
  double squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double outside = std::abs(center[axis] - box_center[axis]) - box_half_size[axis];
    if (outside > reach) return true;
    if (outside > 0) squared += outside * outside;
  }
  return squared > reach * reach;
}

/// Signed distance of a point from a box: a lower bound of its signed distance from whatever is in
/// the box.
double BoxDistance(const Eigen::Vector3d& point, const Eigen::Vector3d& box_center,
                   const Eigen::Vector3d& box_half_size) {
  const Eigen::Vector3d beyond = (point - box_center).cwiseAbs() - box_half_size;
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

}  // namespace

FclChecker::FclChecker(const Robot& robot, const PlanningGroup& group, CollisionModel model)
    : CollisionChecker(robot, group, model) {
  std::vector<LinkSphere> balls;  // that cover the geometry
  if (model == CollisionModel::kMeshes) {
    const std::vector<LinkGeometry> links = LoadLinkGeometry(robot);
    RequireSolid(robot, links);
    for (const auto& [link, shapes] : links) {
      LinkShapes& geometry = links_.emplace_back(LinkShapes{link, SphereTree(), {}});
      const std::string& name = At(robot.model.links(), link).name;
      for (const PlacedShape& placed : shapes) {
        geometry.shapes.emplace_back(FclShape(placed.shape, name), Pose::From(placed.X_FS));
      }
    }
    balls = CoverOf(links);
  } else {
    balls = ModelSpheres(robot, model);
    for (int link = 0; link < robot.model.num_links(); ++link) {
      std::vector<Ball> spheres;
      for (const LinkSphere& sphere : balls) {
        if (sphere.link == link) spheres.push_back({sphere.p_LS, sphere.radius});
      }
      if (!spheres.empty()) links_.push_back({link, SphereTree(std::move(spheres)), {}});
    }
    if (links_.empty()) {
      throw InputError(fmt::format("robot '{}' has no {}, which the {} model needs", robot.name,
                                   model == CollisionModel::kEnclosing
                                       ? "enclosing_spheres (see make_spheres)"
                                       : "collision spheres",
                                   EnumName(model)));
    }
  }
  geometry_bound_.emplace(robot.model, group, std::move(balls));
}

void FclChecker::AddGeometry(Geometry geometry) {
  if (geometry.tree != nullptr) {
    const SphereTree::Node& root = geometry.tree->nodes().front();
    geometry.ball_center = root.center;
    geometry.ball_radius = root.radius;
    geometry.box_center = geometry.tree->box_center();
    geometry.box_half_size = geometry.tree->box_half_size();
    geometry.pose = geometry.rigid_body;
    geometry.first_node = static_cast<int>(node_positions_.size());
    node_positions_.resize(node_positions_.size() + geometry.tree->nodes().size());
  } else {
    geometry.ball_center = geometry.shape->bounding_sphere().center;
    geometry.ball_radius = geometry.shape->bounding_sphere().radius;
    geometry.box_center = geometry.shape->box_center();
    geometry.box_half_size = geometry.shape->box_half_size();
    geometry.pose = static_cast<int>(poses_.size());
    poses_.push_back(geometry.X_GS);
  }
  if (geometry.rigid_body != 0) moving_.push_back(static_cast<int>(geometries_.size()));
  geometries_.push_back(geometry);
  // Of what does not move, once for all.
  ball_positions_.push_back(At(poses_, geometry.pose) * geometry.ball_center);
}

void FclChecker::AddLink(const LinkShapes& link) {
  const int body = static_cast<int>(bodies_.size());
  bodies_.push_back({Body::Kind::kLink, link.link, At(robot().model.links(), link.link).name});
  Geometry geometry;
  geometry.body = body;
  geometry.rigid_body = rigid_bodies_->BodyOf(link.link);
  const Pose& X_GL = rigid_bodies_->X_GL(link.link);
  if (!link.spheres.nodes().empty()) {
    geometry.tree = &trees_.emplace_back(link.spheres.Transformed(X_GL));
    AddGeometry(geometry);
  }
  for (const auto& [shape, X_LS] : link.shapes) {
    geometry.shape = &shape;
    geometry.X_GS = X_GL * X_LS;
    AddGeometry(geometry);
  }
}

void FclChecker::AddShapes(int body, int rigid_body, const Pose& X_GO,
                           const std::vector<PlacedShape>& shapes, const std::string& name) {
  for (const PlacedShape& placed : shapes) {
    Geometry geometry;
    geometry.body = body;
    geometry.rigid_body = rigid_body;
    geometry.X_GS = X_GO * Pose::From(placed.X_FS);
    geometry.shape = &object_shapes_.emplace_back(placed.shape, name);
    AddGeometry(geometry);
  }
}

MotionBound FclChecker::DoSetScene(const Scene& scene, std::span<const double> base_positions) {
  rigid_bodies_.emplace(robot().model, group(), base_positions);
  bodies_.clear();
  geometries_.clear();
  trees_.clear();
  object_shapes_.clear();
  moving_.clear();
  ball_positions_.clear();
  node_positions_.clear();
  poses_.assign(static_cast<std::size_t>(rigid_bodies_->size()), Pose());

  for (const LinkShapes& link : links_) AddLink(link);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const int body = static_cast<int>(bodies_.size());
    bodies_.push_back({Body::Kind::kObject, static_cast<int>(i), object.id});
    AddShapes(body, 0, Pose::From(object.X_WO), object.shapes, object.id);
  }
  const PairRules rules(robot(), scene);
  for (std::size_t i = 0; i < scene.attached.size(); ++i) {
    const AttachedObject& attached = scene.attached[i];
    const int link = rules.LinkOf(attached);
    const int body = static_cast<int>(bodies_.size());
    bodies_.push_back({Body::Kind::kAttached, static_cast<int>(i), attached.object.id});
    AddShapes(body, rigid_bodies_->BodyOf(link),
              rigid_bodies_->X_GL(link) * Pose::From(attached.object.X_WO), attached.object.shapes,
              attached.object.id);
  }
  placed_at_.assign(geometries_.size(), -1);
  geometry_bound_->Set(scene, base_positions);
  ListPairs(scene);
  return geometry_bound_->OfAll();
}

bool FclChecker::ChecksBodies(const PairRules& rules, const Scene& scene, const Body& a,
                              const Body& b) const {
  using Kind =
      Body::Kind;  // bodies_ holds links, then objects, then attached objects: a.kind <= b.kind
  switch (a.kind) {
    case Kind::kLink:
      if (b.kind == Kind::kLink) return rules.ChecksLinks(a.index, b.index);
      if (b.kind == Kind::kObject) {
        return model() != CollisionModel::kVoxels &&
               rules.ChecksLinkWithObject(a.index, At(scene.objects, b.index));
      }
      return rules.ChecksAttachedWithLink(At(scene.attached, b.index), a.index);
    case Kind::kObject:
      return b.kind == Kind::kAttached &&
             rules.ChecksAttachedWithObject(At(scene.attached, b.index),
                                            At(scene.objects, a.index));
    case Kind::kAttached:
      return rules.ChecksAttached(At(scene.attached, a.index), At(scene.attached, b.index));
  }
  return false;
}

void FclChecker::ListPairs(const Scene& scene) {
  const PairRules rules(robot(), scene);
  const int num_bodies = static_cast<int>(bodies_.size());
  const int num_geometries = static_cast<int>(geometries_.size());
  // Objects, of which there may be many, are checked with nothing but what comes after all of them.
  const int first_attached = num_bodies - static_cast<int>(scene.attached.size());
  const auto first_of_attached = static_cast<int>(
      std::partition_point(geometries_.begin(), geometries_.end(),
                           [&](const Geometry& g) { return g.body < first_attached; }) -
      geometries_.begin());

  pairs_.clear();
  reaches_.clear();
  std::vector<Pair> standing;
  int body = -1;
  std::vector<unsigned char> checked(bodies_.size(), 0);  // with that body, of those after it
  for (int g = 0; g < num_geometries; ++g) {
    const Geometry& a = At(geometries_, g);
    const bool is_object = At(bodies_, a.body).kind == Body::Kind::kObject;
    if (a.body != body) {
      body = a.body;
      At(checked, body) = 0;
      for (int b = is_object ? first_attached : body + 1; b < num_bodies; ++b) {
        At(checked, b) = ChecksBodies(rules, scene, At(bodies_, body), At(bodies_, b)) ? 1 : 0;
      }
    }
    int reach_to_objects = -1;  // is that to any of them
    for (int h = is_object ? first_of_attached : g + 1; h < num_geometries; ++h) {
      const Geometry& b = At(geometries_, h);
      if (At(checked, b.body) == 0) continue;
      const bool b_is_source =
          b.tree != nullptr && (a.tree == nullptr || b.tree->num_spheres() < a.tree->num_spheres());
      Pair pair{b_is_source ? h : g, b_is_source ? g : h, !OutOfReach(a, b) && !OutOfReach(b, a)};
      if (a.rigid_body == b.rigid_body) {
        standing.push_back(pair);
        continue;
      }
      const bool is_to_object = At(bodies_, b.body).kind == Body::Kind::kObject;
      pair.reach = is_to_object && reach_to_objects >= 0 ? reach_to_objects : AddReach(a, b);
      if (is_to_object) reach_to_objects = pair.reach;
      pairs_.push_back(pair);
    }
  }
  all_ = List([](const Pair&) { return true; });
  selected_ = {};

  // Where the robot stands does not matter to pairs that keep their relative pose.
  Place(std::vector<double>(group().joints.size(), 0.0));
  standing_contact_.reset();
  standing_closest_ = {kInfinity, "", ""};
  for (const Pair& pair : standing) {
    if (!standing_contact_ && Within(pair, 0)) standing_contact_ = ContactOf(standing, pair);
    const double distance = Distance(pair, standing_closest_.distance_m);
    if (distance < standing_closest_.distance_m) SetClosest(pair, distance, &standing_closest_);
  }
  last_closest_ = {};
}

int FclChecker::AddReach(const Geometry& a, const Geometry& b) {
  const std::size_t first = reaches_.size();
  reaches_.resize(first + group().joints.size(), 0.0);
  for (const auto& [moving, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    const Body& body = At(bodies_, moving->body);
    if (body.kind == Body::Kind::kObject) continue;
    const MotionBound& bound = body.kind == Body::Kind::kLink
                                   ? geometry_bound_->OfLink(body.index)
                                   : geometry_bound_->OfAttached(body.index);
    for (const int joint :
         rigid_bodies_->JointsBelowCommon(moving->rigid_body, other->rigid_body)) {
      At(reaches_, first + static_cast<std::size_t>(joint)) = At(bound.reach(), joint);
    }
  }
  return static_cast<int>(first);
}

template <typename Takes>
FclChecker::PairList FclChecker::List(Takes takes) const {
  PairList list;
  for (const bool can_meet : {true, false}) {
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (pairs_[i].can_meet == can_meet && takes(pairs_[i])) {
        list.order.push_back(static_cast<int>(i));
      }
    }
    if (can_meet) list.num_meeting = list.order.size();
  }
  return list;
}

void FclChecker::Select(std::span<const unsigned char> objects) {
  const auto is_selected = [&](int geometry) {
    const Body& body = At(bodies_, At(geometries_, geometry).body);
    return body.kind == Body::Kind::kAttached ||
           (body.kind == Body::Kind::kObject && At(objects, body.index) != 0);
  };
  selected_ =
      List([&](const Pair& pair) { return is_selected(pair.source) || is_selected(pair.target); });
}

bool FclChecker::OutOfReach(const Geometry& moving, const Geometry& carrier) const {
  if (!rigid_bodies_->Descends(moving.rigid_body, carrier.rigid_body)) return false;
  const Ball reach = rigid_bodies_->Reach(carrier.rigid_body, moving.rigid_body,
                                          {moving.X_GS * moving.ball_center, moving.ball_radius});
  return BallMissesBox(carrier.X_GS.InverseTimes(reach.center), reach.radius, carrier.box_center,
                       carrier.box_half_size);
}

void FclChecker::Place(std::span<const double> q) {
  ++placement_;
  rigid_bodies_->ComputePoses(
      q, std::span(poses_).first(static_cast<std::size_t>(rigid_bodies_->size())));
  for (int g : moving_) {
    const Geometry& geometry = At(geometries_, g);
    Pose& X_WS = At(poses_, geometry.pose);
    if (geometry.tree == nullptr) X_WS = At(poses_, geometry.rigid_body) * geometry.X_GS;
    At(ball_positions_, g) = X_WS * geometry.ball_center;
  }
}

void FclChecker::PlaceNodes(int g) {
  if (At(placed_at_, g) == placement_) return;
  At(placed_at_, g) = placement_;
  const Geometry& geometry = At(geometries_, g);
  const Pose& X_WS = At(poses_, geometry.pose);
  auto position = node_positions_.begin() + geometry.first_node;
  for (const SphereTree::Node& node : geometry.tree->nodes()) *position++ = X_WS * node.center;
}

double FclChecker::RelativeMotion(const Pair& pair, std::span<const double> motion) const {
  const double* reach = reaches_.data() + pair.reach;
  double bound = 0;
  for (std::size_t j = 0; j < motion.size(); ++j) bound += std::abs(motion[j]) * reach[j];
  return bound;
}

bool FclChecker::Within(const Pair& pair, double margin) {
  const Geometry& source = At(geometries_, pair.source);
  const Geometry& target = At(geometries_, pair.target);
  const Pose& X_WT = At(poses_, target.pose);
  if (BallMissesBox(X_WT.InverseTimes(At(ball_positions_, pair.source)),
                    source.ball_radius + margin, target.box_center, target.box_half_size)) {
    return false;
  }
  if (source.tree == nullptr) {
    const Pose& X_WS = At(poses_, source.pose);
    if (BallMissesBox(X_WS.InverseTimes(At(ball_positions_, pair.target)),
                      target.ball_radius + margin, source.box_center, source.box_half_size)) {
      return false;
    }
    const Pose X_TS = X_WT.Inverse() * X_WS;
    if (margin == 0) return target.shape->Touches(*source.shape, X_TS);
    return target.shape->Distance(*source.shape, X_TS, 2 * margin) <= margin;
  }

  PlaceNodes(pair.source);
  const auto nodes = source.tree->nodes();
  const int end = static_cast<int>(nodes.size());
  for (int i = 0; i < end;) {
    const SphereTree::Node& node = At(nodes, i);
    const double radius = node.radius + margin;
    const Eigen::Vector3d center = X_WT.InverseTimes(At(node_positions_, source.first_node + i));
    if (BallMissesBox(center, radius, target.box_center, target.box_half_size)) {
      i = node.next;
      continue;
    }
    if (target.tree != nullptr) {
      if (!target.tree->Touches(center, radius)) {
        i = node.next;
        continue;
      }
      if (node.leaf) return true;
    } else if (node.leaf && target.shape->TouchesBall(center, radius)) {
      return true;
    }
    ++i;
  }
  return false;
}

SampleVerdicts FclChecker::CheckStretch(std::span<const double> q, std::span<const double> motion,
                                        double half_length, Pairs pairs) {
  if (standing_contact_) return {1, 1};
  Place(q);
  PairList& list = pairs == Pairs::kAll ? all_ : selected_;
  auto& order = list.order;
  const std::size_t end = rigid_bodies_->WithinTravel(q) ? list.num_meeting : order.size();
  SampleVerdicts verdict;
  for (std::size_t i = 0; i < end; ++i) {
    const Pair& pair = At(pairs_, order[i]);
    // Once the stretch is not proven free, only what is certain matters.
    const bool around = half_length > 0 && verdict.blocked == 0;
    const double margin = around ? half_length * RelativeMotion(pair, motion) : 0.0;
    if (!Within(pair, margin)) continue;
    verdict.blocked = 1;
    if (margin > 0 && !Within(pair, 0)) continue;
    verdict.certain = 1;
    // Pairs that hit move to the front, one step at a time: the next check will find them sooner.
    if (i > 0 && i != list.num_meeting) std::swap(order[i], order[i - 1]);
    break;
  }
  return verdict;
}

bool FclChecker::DoIsFree(std::span<const double> q) {
  return CheckStretch(q, {}, 0, Pairs::kAll).blocked == 0;
}

SampleVerdicts FclChecker::DoCheckSamples(std::span<const double> start,
                                          std::span<const double> motion,
                                          std::span<const MotionSample> samples,
                                          SampleRole /*role*/) {
  q_.resize(start.size());
  SampleVerdicts verdicts;
  for (std::size_t k = 0; k < samples.size() && verdicts.certain == 0; ++k) {
    for (std::size_t j = 0; j < q_.size(); ++j) q_[j] = start[j] + samples[k].position * motion[j];
    const SampleVerdicts one = CheckStretch(q_, motion, samples[k].half_length, Pairs::kAll);
    verdicts.blocked |= one.blocked << k;
    verdicts.certain |= one.certain << k;
  }
  return verdicts;
}

std::optional<Contact> FclChecker::DoFindContact(std::span<const double> q) {
  if (standing_contact_) return standing_contact_;
  Place(q);
  for (const Pair& pair : pairs_) {
    if (Within(pair, 0)) return ContactOf(pairs_, pair);
  }
  return std::nullopt;
}

Contact FclChecker::ContactOf(std::span<const Pair> pairs, const Pair& touching) {
  const auto bodies_of = [this](const Pair& pair) {
    return std::minmax(At(geometries_, pair.source).body, At(geometries_, pair.target).body);
  };
  const auto [first, second] = bodies_of(touching);
  Contact contact{At(bodies_, first).name, At(bodies_, second).name, 0};
  for (const Pair& pair : pairs) {
    const auto [a, b] = bodies_of(pair);
    if (a == first && b == second) contact.depth_m = std::max(contact.depth_m, Depth(pair));
  }
  if (At(bodies_, first).kind == Body::Kind::kObject) std::swap(contact.body_a, contact.body_b);
  return contact;
}

double FclChecker::DistanceBound(const Pair& pair) const {
  const Geometry& source = At(geometries_, pair.source);
  const Geometry& target = At(geometries_, pair.target);
  const Eigen::Vector3d source_T =
      At(poses_, target.pose).InverseTimes(At(ball_positions_, pair.source));
  const Eigen::Vector3d target_S =
      At(poses_, source.pose).InverseTimes(At(ball_positions_, pair.target));
  return std::max(
      BoxDistance(source_T, target.box_center, target.box_half_size) - source.ball_radius,
      BoxDistance(target_S, source.box_center, source.box_half_size) - target.ball_radius);
}

double FclChecker::Distance(const Pair& pair, double at_most) {
  const Geometry& source = At(geometries_, pair.source);
  const Geometry& target = At(geometries_, pair.target);
  const Pose& X_WT = At(poses_, target.pose);
  if (source.tree == nullptr) {
    return target.shape->Distance(*source.shape, X_WT.Inverse() * At(poses_, source.pose), at_most);
  }
  PlaceNodes(pair.source);
  double best = at_most;
  const auto nodes = source.tree->nodes();
  const int end = static_cast<int>(nodes.size());
  for (int i = 0; i < end;) {
    const SphereTree::Node& node = At(nodes, i);
    const Eigen::Vector3d center = X_WT.InverseTimes(At(node_positions_, source.first_node + i));
    const double bound = BoxDistance(center, target.box_center, target.box_half_size) - node.radius;
    if (bound - kRoundingMargin >= best) {
      i = node.next;
      continue;
    }
    if (node.leaf) {
      best = target.tree != nullptr
                 ? target.tree->Distance(center, node.radius, best)
                 : std::min(best, target.shape->BallDistance(center, node.radius));
    }
    ++i;
  }
  return best;
}

double FclChecker::Depth(const Pair& pair) {
  const Geometry& source = At(geometries_, pair.source);
  const Geometry& target = At(geometries_, pair.target);
  if (source.tree != nullptr) return std::max(0.0, -Distance(pair, 0));
  if (!Within(pair, 0)) return 0;
  return target.shape->Depth(*source.shape,
                             At(poses_, target.pose).Inverse() * At(poses_, source.pose));
}

void FclChecker::SetClosest(const Pair& pair, double distance, ClosestPair* closest) const {
  const auto [first, second] =
      std::minmax(At(geometries_, pair.source).body, At(geometries_, pair.target).body);
  *closest = {distance, At(bodies_, first).name, At(bodies_, second).name};
  if (At(bodies_, first).kind == Body::Kind::kObject) std::swap(closest->body_a, closest->body_b);
}

double FclChecker::LastClosestNow(std::span<const double> q, double at_most) {
  const Pair& pair = At(pairs_, last_closest_.pair);
  std::vector<double>& motion = last_closest_.q;
  for (std::size_t j = 0; j < q.size(); ++j) motion[j] -= q[j];
  const double limit =
      std::min(at_most, last_closest_.distance_m + RelativeMotion(pair, motion) + kSolverSlack);
  const double distance = Distance(pair, limit);
  return distance < limit || limit == at_most ? distance : Distance(pair, at_most);
}

ClosestPair FclChecker::FindClosestWithin(std::span<const double> q, double at_most) {
  Place(q);
  double best = std::min(at_most, standing_closest_.distance_m);
  // Along a path the pair that was closest mostly is: what is further needs no distance. Ties still
  // go to the first by its bound, whatever was asked before.
  const int last = last_closest_.pair;
  double of_last = 0;
  if (last >= 0) {
    of_last = LastClosestNow(q, best);
    best = std::min(best, std::nextafter(of_last, kInfinity));
  }
  by_bound_.clear();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const double bound = DistanceBound(pairs_[i]);
    if (bound - kRoundingMargin < best) by_bound_.emplace_back(bound, static_cast<int>(i));
  }
  std::sort(by_bound_.begin(), by_bound_.end());
  int best_pair = -1;
  for (const auto& [bound, index] : by_bound_) {
    if (bound - kRoundingMargin >= best) break;
    const double distance = index == last ? of_last : Distance(At(pairs_, index), best);
    if (distance < best) {
      best = distance;
      best_pair = index;
    }
  }
  last_closest_ = {best_pair, best, {q.begin(), q.end()}};
  ClosestPair closest = standing_closest_;
  if (best_pair >= 0) SetClosest(At(pairs_, best_pair), best, &closest);
  return closest;
}

ClosestPair FclChecker::DoFindClosest(std::span<const double> q) {
  return FindClosestWithin(q, kInfinity);
}

void FclChecker::DoFindDistances(std::span<const double> qs, int num, double at_most,
                                 std::span<double> distances) {
  const std::size_t n = group().joints.size();
  for (std::size_t i = 0; i < static_cast<std::size_t>(num); ++i) {
    distances[i] = std::min(at_most, FindClosestWithin(qs.subspan(i * n, n), at_most).distance_m);
  }
}

}  // namespace planbench
