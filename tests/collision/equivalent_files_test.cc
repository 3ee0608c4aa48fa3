// The same problem written in different ways: the files must mean the same, to the verdicts and
// distances that come of them.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "collision/collision_checker.h"
#include "robot_model/full_positions.h"
#include "scene/moveit_yaml.h"

namespace planbench {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// An arm with a gripper whose second finger follows the first, on its own or by a mimic tag.
Robot MakeArm(bool mimic) {
  const std::string urdf =
      fmt::format(R"(<robot name="arm">
  <link name="base"/><link name="upper"/><link name="fore"/><link name="hand"/>
  <link name="left"/><link name="right"/>
  <joint name="j1" type="continuous"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 0.3"/><axis xyz="0 0 1"/></joint>
  <joint name="j2" type="revolute"><parent link="upper"/><child link="fore"/>
    <origin xyz="0.4 0 0"/><axis xyz="0 1 0.2"/>
    <limit lower="-2.6" upper="2.6" velocity="1" effort="1"/></joint>
  <joint name="j3" type="revolute"><parent link="fore"/><child link="hand"/>
    <origin xyz="0.4 0 0" rpy="0.3 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2.6" upper="2.6" velocity="1" effort="1"/></joint>
  <joint name="f1" type="prismatic"><parent link="hand"/><child link="left"/>
    <origin xyz="0.1 0 0"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.1" velocity="1" effort="1"/></joint>
  <joint name="f2" type="revolute"><parent link="hand"/><child link="right"/>
    <origin xyz="0.1 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" velocity="1" effort="1"/>{}</joint>
</robot>)",
                  mimic ? "<mimic joint='f1' multiplier='-8' offset='0.1'/>" : "");
  Robot robot;
  robot.name = "arm";
  robot.model = RobotModel::FromUrdf(urdf, "arm.urdf");
  std::vector<std::string> joints = {"j2", "j1", "f1", "j3"};
  if (!mimic) joints.push_back("f2");
  robot.groups = {robot.model.MakeGroup("arm", joints, "hand")};
  for (const auto& [link, length] : std::map<std::string, double>{
           {"upper", 0.4}, {"fore", 0.4}, {"hand", 0.1}, {"left", 0.1}, {"right", 0.1}}) {
    for (double x = 0; x <= length; x += 0.05) {
      robot.spheres.push_back({robot.model.FindLink(link), Vector3d(x, 0, 0), 0.03});
    }
  }
  std::stable_sort(robot.spheres.begin(), robot.spheres.end(),
                   [](const LinkSphere& a, const LinkSphere& b) { return a.link < b.link; });
  return robot;
}

double Follower(double f1) { return -8 * f1 + 0.1; }

class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}

  double Number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int Index(std::size_t count) { return static_cast<int>(random_() % count); }
  Isometry3d Pose(double reach) {
    Isometry3d X = Isometry3d::Identity();
    X.linear() = Eigen::Quaterniond(Number(-1, 1), Number(-1, 1), Number(-1, 1), Number(-1, 1))
                     .normalized()
                     .toRotationMatrix();
    for (int i = 0; i < 3; ++i) X.translation()[i] = Number(-reach, reach);
    return X;
  }

 private:
  std::mt19937 random_;
};

struct Object {
  std::string id;
  std::string shape;  // Fields of a SolidPrimitive.
  Isometry3d X_BS;    // In the base frame.
};

// What every form of a problem says.
struct Content {
  double j1, j2, j3, f1;  // The start.
  std::vector<Object> objects;
  Object held;  // A ball, by the hand.
};

Content Draw(Generator* draw) {
  Content content{
      draw->Number(-3, 3), draw->Number(-2, 2), draw->Number(-2, 2), draw->Number(0, 0.1), {}, {}};
  const int count = 2 + draw->Index(5);
  for (int i = 0; i < count; ++i) {
    std::string shape;
    switch (draw->Index(4)) {
      case 0:
        shape = fmt::format("type: box, dimensions: [{}, {}, {}]", draw->Number(0.05, 0.5),
                            draw->Number(0.05, 0.5), draw->Number(0.05, 0.5));
        break;
      case 1:
        shape = fmt::format("type: sphere, dimensions: [{}]", draw->Number(0.05, 0.3));
        break;
      case 2:
        shape = fmt::format("type: cylinder, dimensions: [{}, {}]", draw->Number(0.05, 0.5),
                            draw->Number(0.05, 0.2));
        break;
      default:
        shape = fmt::format("type: 4, dimensions: [{}, {}]", draw->Number(0.05, 0.5),
                            draw->Number(0.05, 0.2));
    }
    content.objects.push_back({fmt::format("o{}", i), shape, draw->Pose(1)});
  }
  content.held = {"held", fmt::format("type: sphere, dimensions: [{}]", draw->Number(0.02, 0.1)),
                  draw->Pose(1)};
  return content;
}

std::string PoseText(const Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  const Vector3d& p = X.translation();
  return fmt::format("position: [{}, {}, {}], orientation: [{}, {}, {}, {}]", p.x(), p.y(), p.z(),
                     q.x(), q.y(), q.z(), q.w());
}

std::string TransformFields(const Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  const Vector3d& p = X.translation();
  return fmt::format(
      "translation: {{x: {}, y: {}, z: {}}}, rotation: {{x: {}, y: {}, z: {}, w: {}}}", p.x(),
      p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
}

std::string TransformText(const std::string& header, const std::string& child,
                          const Isometry3d& X) {
  return fmt::format("  - {{header: {{frame_id: {}}}, child_frame_id: {}, transform: {{{}}}}}\n",
                     header, child, TransformFields(X));
}

std::string ObjectText(const Object& object, const std::string& frame, const Isometry3d& X_FS) {
  return fmt::format(
      "id: {}, header: {{frame_id: {}}}, primitives: [{{{}}}], "
      "primitive_poses: [{{{}}}]",
      object.id, frame, object.shape, PoseText(X_FS));
}

enum class Form { kPlain, kFrames, kMergeKeys, kSplitPoses, kAttachedById, kMimic };

// One form of a problem, read.
struct Reading {
  Robot robot;
  Problem problem;
};

Reading Read(const Content& content, Form form, Generator* draw) {
  const bool mimic = form == Form::kMimic;
  Robot robot = MakeArm(mimic);
  std::vector<std::string> names = {"j1", "j2", "j3", "f1"};
  std::vector<double> positions = {content.j1, content.j2, content.j3, content.f1};
  if (!mimic || draw->Index(2) == 0) {
    names.insert(names.begin(), "f2");
    positions.insert(positions.begin(), Follower(content.f1));
  }
  const std::vector<double> full = FullPositions(robot.model, names, positions, "test");
  const std::vector<Isometry3d> X_BL = ComputeLinkPoses(robot.model, full);
  const auto link_pose = [&](const std::string& link) {
    return X_BL[static_cast<std::size_t>(robot.model.FindLink(link))];
  };

  std::string scene = "robot_model_name: arm\n";
  std::string root_joint;
  // Frames and their poses in the base frame.
  std::vector<std::pair<std::string, Isometry3d>> frames = {{"base", Isometry3d::Identity()}};
  if (form == Form::kFrames) {
    const Isometry3d X_WR = draw->Pose(1);
    const Isometry3d X_W1 = draw->Pose(1);
    const Isometry3d X_12 = draw->Pose(1);
    const Isometry3d X_L3 = draw->Pose(1);
    const bool reversed = draw->Index(2) == 0;
    const auto transform = [&](const std::string& near, const std::string& far,
                               const Isometry3d& X) {
      return reversed ? TransformText(far, near, X) : TransformText(near, far, X);
    };
    scene += "fixed_frame_transforms:\n" + transform("one", "two", X_12) +
             transform("odom", "one", X_W1) + transform("/fore", "/three", X_L3);
    root_joint = fmt::format(
        "  multi_dof_joint_state: {{header: {{frame_id: /odom}}, joint_names: "
        "[root], transforms: [{{{}}}]}}\n",
        TransformFields(X_WR));
    const Isometry3d X_BW = X_WR.inverse();
    frames = {{"/odom", X_BW},
              {"''", X_BW},
              {"one", X_BW * X_W1},
              {"/two", X_BW * X_W1 * X_12},
              {"three", link_pose("fore") * X_L3},
              {"hand", link_pose("hand")},
              {"/left", link_pose("left")}};
  }

  std::string world;
  std::string templates;
  for (const Object& object : content.objects) {
    const auto& [frame, X_BF] = frames[static_cast<std::size_t>(draw->Index(frames.size()))];
    const Isometry3d X_FS = X_BF.inverse() * object.X_BS;
    if (form == Form::kMergeKeys) {
      templates += fmt::format(
          "  - &shape_{0} {{primitives: [{{{1}}}], header: {{frame_id: base}}}}\n"
          "  - &place_{0} {{primitive_poses: [{{{2}}}], id: other}}\n"
          "  - &both_{0} {{<<: [*shape_{0}, *place_{0}]}}\n",
          object.id, object.shape, PoseText(X_FS));
      world += draw->Index(2) == 0
                   ? fmt::format("    - {{<<: *both_{0}, id: {0}}}\n", object.id)
                   : fmt::format("    - {{id: {0}, <<: [*place_{0}, *shape_{0}]}}\n", object.id);
    } else if (form == Form::kSplitPoses) {
      const Isometry3d X_BO = draw->Pose(2);
      world += fmt::format("    - {{pose: {{{}}}, {}}}\n", PoseText(X_BO),
                           ObjectText(object, "base", X_BO.inverse() * object.X_BS));
    } else {
      world += "    - {" + ObjectText(object, frame, X_FS) + "}\n";
    }
  }
  std::string attached = "id: held";
  if (form == Form::kAttachedById) {
    world += "    - {" + ObjectText(content.held, "base", content.held.X_BS) + "}\n";
  } else {
    const std::string frame = form == Form::kFrames && draw->Index(2) == 0 ? "two" : "hand";
    const Isometry3d X_BF = frame == "two" ? frames[3].second : link_pose("hand");
    attached = ObjectText(content.held, frame, X_BF.inverse() * content.held.X_BS);
  }
  const std::string start = fmt::format(
      "  joint_state: {{name: [{}], position: [{}]}}\n  attached_collision_objects: "
      "[{{link_name: hand, object: {{{}}}, touch_links: [left, right, fore]}}]\n",
      fmt::join(names, ", "), fmt::join(positions, ", "), attached);
  const bool in_scene = draw->Index(2) == 0;
  if (!templates.empty()) scene = "x-templates:\n" + templates + scene;
  if (in_scene) scene += "robot_state:\n" + root_joint + start;
  scene += "world:\n  collision_objects:\n" + world;
  std::string request = in_scene ? "" : "start_state:\n" + root_joint + start;
  request += "goal_constraints:\n  - joint_constraints:\n";
  for (const JointSpace::Joint& joint : robot.groups[0].space.joints()) {
    request += fmt::format("    - {{joint_name: {}, position: 0}}\n", joint.name);
  }
  Problem problem = ParseProblem(YamlNode::Parse(scene, "scene.yaml"),
                                 YamlNode::Parse(request, "request.yaml"), robot, {});
  return {std::move(robot), std::move(problem)};
}

class Checked {
 public:
  explicit Checked(Reading reading) : reading_(std::move(reading)) {
    const PlanningGroup& group = reading_.robot.groups[0];
    for (const bool exact : {true, false}) {
      checkers_.push_back(
          exact ? MakeReferenceChecker(reading_.robot, group, CollisionModel::kSpheres)
                : MakeCollisionChecker(reading_.robot, group, CollisionModel::kSpheres));
      checkers_.back()->SetScene(reading_.problem.scene,
                                 FullPositions(reading_.robot.model, reading_.problem.start.names,
                                               reading_.problem.start.positions, "start"));
    }
  }

  // Of j2, j1, f1, j3, and what follows of it.
  std::vector<double> Expanded(std::vector<double> q) const {
    if (reading_.robot.groups[0].space.size() == 5) q.push_back(Follower(q[2]));
    return q;
  }
  CollisionChecker& exact() { return *checkers_[0]; }
  CollisionChecker& fast() { return *checkers_[1]; }

 private:
  Reading reading_;
  std::vector<std::unique_ptr<CollisionChecker>> checkers_;
};

TEST(EquivalentFiles, MeanTheSame) {
  int touching = 0;
  int apart = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Generator draw(seed);
    const Content content = Draw(&draw);
    Checked plain(Read(content, Form::kPlain, &draw));
    for (const Form form :
         {Form::kFrames, Form::kMergeKeys, Form::kSplitPoses, Form::kAttachedById, Form::kMimic}) {
      SCOPED_TRACE(static_cast<int>(form));
      Checked other(Read(content, form, &draw));
      for (int i = 0; i < 12; ++i) {
        const std::vector<double> q = {draw.Number(-2, 2), draw.Number(-3, 3), draw.Number(0, 0.1),
                                       draw.Number(-2, 2)};
        const ClosestPair expected = plain.exact().FindClosest(plain.Expanded(q));
        const ClosestPair actual = other.exact().FindClosest(other.Expanded(q));
        EXPECT_NEAR(actual.distance_m, expected.distance_m, 1e-9)
            << expected.body_a << ", " << expected.body_b;
        (expected.distance_m > 0 ? apart : touching) += 1;
        if (std::abs(expected.distance_m) < 1e-3) continue;
        const bool free = plain.exact().IsFree(plain.Expanded(q));
        EXPECT_EQ(other.exact().IsFree(other.Expanded(q)), free);
        EXPECT_EQ(other.fast().IsFree(other.Expanded(q)), free);
      }
    }
  }
  EXPECT_GT(touching, 200);
  EXPECT_GT(apart, 200);
}

}  // namespace
}  // namespace planbench
