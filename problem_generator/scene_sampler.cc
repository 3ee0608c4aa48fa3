#include "problem_generator/scene_sampler.h"

#include <limits>

#include "collision/fcl/fcl_shape.h"
#include "scene/pose.h"

namespace planbench {
namespace {

Shape DrawShape(const PartSpec& part, RandomStream* random) {
  std::vector<double> size;
  for (const Range& range : part.size) size.push_back(random->Draw(range));
  switch (part.kind) {
    case PartKind::kBox:
      return Box{{size[0], size[1], size[2]}};
    case PartKind::kCylinder:
      return Cylinder{.radius = size[1], .length = size[0]};
    case PartKind::kSphere:
      break;
  }
  return Sphere{size[0]};
}

Eigen::Isometry3d DrawPose(const Range3& position, const Range3& rpy, RandomStream* random) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = random->Draw(position);
  pose.linear() = RotationFromRpy(random->Draw(rpy));
  return pose;
}

// A box that encloses shapes, edges along the axes of their frame.
struct Extent {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
};

// How far a shape reaches from its middle along the axes of the frame that it is placed in: exact,
// whichever way it is turned.
Eigen::Vector3d Reach(const PlacedShape& placed) {
  const Eigen::Matrix3d R = placed.X_FS.linear();
  if (const auto* box = std::get_if<Box>(&placed.shape)) return R.cwiseAbs() * (box->size / 2);
  if (const auto* cylinder = std::get_if<Cylinder>(&placed.shape)) {
    return cylinder->length / 2 * R.col(2).cwiseAbs() +
           cylinder->radius * R.leftCols<2>().rowwise().norm();
  }
  return Eigen::Vector3d::Constant(std::get<Sphere>(placed.shape).radius);
}

Extent ExtentOf(const std::vector<PlacedShape>& shapes) {
  Extent extent;
  for (const PlacedShape& placed : shapes) {
    const Eigen::Vector3d center = placed.X_FS.translation();
    const Eigen::Vector3d reach = Reach(placed);
    extent.low = extent.low.cwiseMin(center - reach);
    extent.high = extent.high.cwiseMax(center + reach);
  }
  return extent;
}

// Pose, in the frame of the box `support`, of shapes that stand on it at X_pose (from the middle of
// its upper face; their own height is found here). Nothing if they do not stand wholly on it.
std::optional<Eigen::Isometry3d> StandOn(const Box& support, const Eigen::Isometry3d& X_pose,
                                         std::vector<PlacedShape> shapes) {
  for (PlacedShape& placed : shapes) placed.X_FS = X_pose * placed.X_FS;
  constexpr double kRounding = 1e-9;  // m
  const Extent extent = ExtentOf(shapes);
  const Eigen::Vector3d half = 0.5 * support.size;
  const Eigen::Array2d edge = half.head<2>().array() + kRounding;
  if ((extent.low.head<2>().array() < -edge).any()) return std::nullopt;
  if ((extent.high.head<2>().array() > edge).any()) return std::nullopt;
  Eigen::Isometry3d X_SO = X_pose;
  X_SO.translation().z() += half.z() - extent.low.z();
  return X_SO;
}

// A shape in the base frame, as FCL has it.
struct Body {
  FclShape shape;
  Eigen::Isometry3d X_BS;
};

std::vector<Body> BodiesOf(const std::vector<PlacedShape>& shapes) {
  std::vector<Body> bodies;
  for (const PlacedShape& placed : shapes) {
    bodies.push_back(Body{FclShape(placed.shape, ""), placed.X_FS});
  }
  return bodies;
}

// True if they touch, or are nearer to each other than `gap`.
bool TooNear(const Body& a, const Body& b, double gap) {
  const BoundingSphere& around_a = a.shape.bounding_sphere();
  const BoundingSphere& around_b = b.shape.bounding_sphere();
  const double apart = (a.X_BS * around_a.center - b.X_BS * around_b.center).norm() -
                       around_a.radius - around_b.radius;
  if (apart > gap) return false;
  const Pose X_AB = Pose::From(a.X_BS.inverse() * b.X_BS);
  return a.shape.Touches(b.shape, X_AB) || a.shape.Distance(b.shape, X_AB, gap) < gap;
}

// True if some of the bodies is too near to some of the object's, its part `except` left out.
bool TooNear(const std::vector<Body>& bodies, const std::vector<Body>& object, int except,
             double gap) {
  for (std::size_t i = 0; i < object.size(); ++i) {
    if (static_cast<int>(i) == except) continue;
    for (const Body& body : bodies) {
      if (TooNear(body, object[i], gap)) return true;
    }
  }
  return false;
}

}  // namespace

Eigen::Matrix3d RotationFromRpy(const Eigen::Vector3d& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

std::optional<SampledScene> SampleScene(const ProblemSpec& spec, const Robot& robot,
                                        RandomStream* random, Rejections* rejections) {
  SampledScene sampled;
  Scene& scene = sampled.scene;
  scene.robot_name = robot.name;
  scene.world_frame = robot.model.links().front().name;
  scene.allowed_collisions = spec.allowed_collisions;
  std::vector<int> scene_index;           // Of the specification's objects; -1: not in the scene.
  std::vector<std::vector<Body>> bodies;  // Of the scene's objects.
  for (const ObjectSpec& object : spec.objects) {
    const bool chosen = random->Chance(object.probability);
    std::vector<PlacedShape> shapes;
    for (const PartSpec& part : object.parts) {
      Shape shape = DrawShape(part, random);
      shapes.push_back({std::move(shape), DrawPose(part.position, part.rpy, random)});
    }
    Eigen::Isometry3d X_BO = DrawPose(object.position, object.rpy, random);
    const Eigen::AngleAxisd about_base(random->Draw(object.about_base), Eigen::Vector3d::UnitZ());

    const int parent =
        object.parent < 0 ? -1 : scene_index[static_cast<std::size_t>(object.parent)];
    const bool present = chosen && (object.parent < 0 || parent >= 0);
    scene_index.push_back(present ? static_cast<int>(scene.objects.size()) : -1);
    sampled.poses.emplace_back();
    if (!present) continue;

    if (object.support_part >= 0) {
      const PlacedShape& support = scene.objects[static_cast<std::size_t>(parent)]
                                       .shapes[static_cast<std::size_t>(object.support_part)];
      const auto X_SO = StandOn(std::get<Box>(support.shape), X_BO, shapes);
      if (!X_SO) {
        rejections->Add(object.id + " does not stand wholly on its support", object.where);
        return std::nullopt;
      }
      X_BO = support.X_FS * *X_SO;
    } else if (object.parent >= 0) {
      X_BO = *sampled.poses[static_cast<std::size_t>(object.parent)] * X_BO;
    } else {
      X_BO = about_base * X_BO;
    }
    for (PlacedShape& placed : shapes) placed.X_FS = CanonicalPose(X_BO * placed.X_FS);
    std::vector<Body> own = BodiesOf(shapes);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const int except = static_cast<int>(i) == parent ? object.support_part : -1;
      if (!TooNear(own, bodies[i], except, spec.object_gap_m)) continue;
      rejections->Add(object.id + " too near to " + scene.objects[i].id, object.where);
      return std::nullopt;
    }
    sampled.poses.back() = X_BO;
    SceneObject placed;
    placed.id = object.id;
    placed.shapes = std::move(shapes);
    scene.objects.push_back(std::move(placed));
    bodies.push_back(std::move(own));
  }
  return sampled;
}

}  // namespace planbench
