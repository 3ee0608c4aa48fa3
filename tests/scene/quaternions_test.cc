#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/error.h"
#include "tests/scene/frame_texts.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Quaternions, AreNormalisedOrTakenAsNoRotationWithAWarning) {
  const auto warnings = [](const std::string& quaternion) {
    const Problem problem = ParseProblem(
        Replaced(BallIn("base_link"), "orientation: [0, 0, 0, 1]", "orientation: " + quaternion),
        kBallRequest);
    EXPECT_TRUE(problem.scene.objects[0].shapes[0].X_FS.linear().isUnitary(1e-12));
    return problem.warnings;
  };
  for (const char* fine :
       {"[0, 0, 0, 1]", "[0, 0, 0.7071, 0.7071]", "[0, 0, 0.6, 0.8005]", "[0, 0, 0, -1]"}) {
    EXPECT_THAT(warnings(fine), IsEmpty()) << fine;
  }
  EXPECT_THAT(
      warnings("[0, 0, 0, 0]"),
      ElementsAre("scene.yaml:7: world.collision_objects[0].primitive_poses[0].orientation: "
                  "is all zero; taken as no rotation"));
  EXPECT_THAT(warnings("{x: 0, y: 0, z: 0, w: 0}"), ElementsAre(HasSubstr("no rotation")));
  for (const char* w : {"2", "-3", "1e-12", "1e+308"}) {
    const std::string length = w + (*w == '-' ? 1 : 0);
    EXPECT_THAT(warnings("[0, 0, 0, " + std::string(w) + "]"),
                ElementsAre(HasSubstr(": has length " + length + "; taken as no rotation")));
  }
  EXPECT_THAT(warnings("[0, 0, 0.6, 0.83]"), ElementsAre(HasSubstr("normalised")));
  EXPECT_THAT(warnings("[0, 0, 0.6, 0.77]"), ElementsAre(HasSubstr("normalised")));
  for (const char* bad : {"[0, 0, 0.6, 0.9]", "[0, 0, 1.57, 0]", "[0, 0.1, 0, 2]"}) {
    EXPECT_THROW(warnings(bad), InputError) << bad;
  }
  ExpectInputError([&] { warnings("[0, 0, 1e-9, 1e-9]"); },
                   {"is no unit quaternion (length 1.41421e-09)"});
}

TEST(Quaternions, EverywhereAlike) {
  const std::string zero = "[0, 0, 0, 0]";
  const Problem problem = ParseProblem(
      "robot_model_name: fetch\nrobot_state:\n" +
          Replaced(RootAt("odom", "0, 0, 1"), "[0, 0, 0, 1]", zero) +
          "  attached_collision_objects:\n    - {link_name: gripper_link, object: {id: tool, "
          "header: {frame_id: gripper_link}, primitives: [{type: sphere, dimensions: [1]}], "
          "primitive_poses: [{position: [1, 0, 0], orientation: " +
          zero + "}]}}\n" + kTransforms +
          Replaced(Transform("camera", "odom", "0, 0, 1"), "[0, 0, 0, 1]", zero) +
          "world: {collision_objects: [{id: ball, pose: {position: [1, 0, 0], orientation: " +
          zero +
          "}, meshes: [{vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 2]]}], "
          "mesh_poses: [{position: [0, 0, 1], orientation: " +
          zero + "}]}]}\n",
      kBallRequest);
  EXPECT_EQ(problem.warnings.size(), 5u);
  for (const std::string& warning : problem.warnings) {
    EXPECT_THAT(warning, HasSubstr("is all zero; taken as no rotation"));
  }
}

}  // namespace
}  // namespace planbench
