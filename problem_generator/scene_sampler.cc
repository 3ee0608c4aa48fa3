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

Extent ExtentOf(const std::vector<PlacedShape>& shapes) {
  Extent extent;
  for (const PlacedShape& placed : shapes) {
    const FclShape shape(placed.shape, "");
    const Eigen::Vector3d center = placed.X_FS * shape.box_center();
    const Eigen::Vector3d half = placed.X_FS.linear().cwiseAbs() * shape.box_half_size();
    extent.low = extent.low.cwiseMin(center - half);
    extent.high = extent.high.cwiseMax(center + half);
  }
  return extent;
}

// Pose, in the frame of the box `support`, of shapes that stand on it at X_pose (from the middle of
// its upper face; their own height is found here). Nothing if they do not stand wholly on it.
std::optional<Eigen::Isometry3d> StandOn(const Box& support, const Eigen::Isometry3d& X_pose,
                                         std::vector<PlacedShape> shapes) {
  for (PlacedShape& placed : shapes) placed.X_FS = X_pose * placed.X_FS;
  const Extent extent = ExtentOf(shapes);
  const Eigen::Vector3d half = 0.5 * support.size;
  if ((extent.low.head<2>().array() < -half.head<2>().array()).any()) return std::nullopt;
  if ((extent.high.head<2>().array() > half.head<2>().array()).any()) return std::nullopt;
  Eigen::Isometry3d X_SO = X_pose;
  X_SO.translation().z() += half.z() - extent.low.z();
  return X_SO;
}

double Distance(const PlacedShape& a, const PlacedShape& b, double at_most) {
  const FclShape shape_a(a.shape, "");
  const FclShape shape_b(b.shape, "");
  const auto center = [](const PlacedShape& placed, const FclShape& shape) {
    return Eigen::Vector3d(placed.X_FS * shape.bounding_sphere().center);
  };
  const double apart = (center(a, shape_a) - center(b, shape_b)).norm() -
                       shape_a.bounding_sphere().radius - shape_b.bounding_sphere().radius;
  if (apart > at_most) return at_most;
  const Pose X_AB = Pose::From(a.X_FS.inverse() * b.X_FS);
  return shape_a.Touches(shape_b, X_AB) ? 0 : shape_a.Distance(shape_b, X_AB, at_most);
}

// True if some of the shapes is nearer than `gap` to the object, its part `except` left out.
bool TooNear(const std::vector<PlacedShape>& shapes, const SceneObject& object, int except,
             double gap) {
  for (std::size_t i = 0; i < object.shapes.size(); ++i) {
    if (static_cast<int>(i) == except) continue;
    for (const PlacedShape& shape : shapes) {
      const double distance = Distance(shape, object.shapes[i], gap);
      if (distance < gap || distance <= 0) return true;
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
  std::vector<int> scene_index;  // Of the specification's objects; -1: not in the scene.
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
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
      const int except = static_cast<int>(i) == parent ? object.support_part : -1;
      if (!TooNear(shapes, scene.objects[i], except, spec.object_gap_m)) continue;
      rejections->Add(object.id + " too near to " + scene.objects[i].id, object.where);
      return std::nullopt;
    }
    sampled.poses.back() = X_BO;
    SceneObject placed;
    placed.id = object.id;
    placed.shapes = std::move(shapes);
    scene.objects.push_back(std::move(placed));
  }
  return sampled;
}

}  // namespace planbench
