#include "report/view_data.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/read_text.h"
#include "common/write_file.h"
#include "geometry/polyhedra.h"
#include "report/page.h"
#include "tests/report/browser.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/mesh_arm.h"
#include "tests/support/obj_text.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

/// Of a mesh of a view, with less than 65537 vertices.
std::size_t NumTriangles(const Json& mesh) { return FromBase64(mesh["triangles"]).size() / 6; }

/// The planar arm (links of 0.5, 0.4 and 0.3 m) in front of a box, and a run that folds it.
class ViewDataTest : public testing::Test {
 protected:
  ViewDataTest() {
    SceneObject box;
    box.id = "box";
    box.X_WO.translation() = Eigen::Vector3d(1, 2, 3);
    box.shapes.push_back({Box{{0.2, 0.4, 0.6}}, Eigen::Isometry3d::Identity()});
    scene_.objects.push_back(box);
    AttachedObject tool;
    tool.link = "hand";
    tool.object.id = "tool";
    tool.object.shapes.push_back({Cylinder{0.01, 0.1}, Eigen::Isometry3d::Identity()});
    scene_.attached.push_back(tool);

    run_.problem_set = "shelf";
    run_.problem_index = 3;
    run_.contestant = "A";
    run_.status = PlanStatus::kInvalidPath;
    run_.request_id = "request";
    run_.request.start = {{"shoulder", "elbow", "wrist"}, {0, 0, 0}};
    run_.request.goal = {{"shoulder", 0, 0, 0}, {"elbow", 1, 0, 0}, {"wrist", 0, 0, 0}};
    // Joints in another order than the group's.
    run_.result.joint_names = {"elbow", "shoulder", "wrist"};
    run_.result.result.path = {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}};
    run_.path_check.verdict.emplace();
    run_.path_check.verdict->segment = 1;
    run_.path_check.verdict->fraction = 0.3;
    run_.path_check.verdict->contact = Contact{"hand", "box", 0.01};
  }

  /// The same arm, its hand a mesh of 3996 triangles.
  Robot MeshArm(const std::string& mesh = "hand.obj") const {
    folder_.Write("arm/hand.obj", ObjText(PrismMesh(0.05, 0.2, 1000)));
    return LoadRobot(WriteMeshArm(folder_, mesh));
  }
  ShownRobot WithoutSpheres(const std::string& mesh = "hand.obj") const {
    Robot robot = MeshArm(mesh);
    robot.spheres.clear();
    return ShownRobot(std::move(robot));
  }

  const TemporaryFolder folder_;
  const ShownRobot robot_{LoadRobot(std::string(PLANBENCH_SOURCE_DIR) + "/tests/data/planar3")};
  Scene scene_;
  RunRecordMessage run_;
};

TEST_F(ViewDataTest, FramesAreTheArmsPosesAlongThePath) {
  const Json view = RunView(robot_, scene_, run_, 10);
  ASSERT_EQ(view["motions"].size(), 1u);
  const Json& motion = view["motions"][0];
  ASSERT_EQ(motion["tips"].size(), 1u);
  ASSERT_EQ(motion["frames"].size(), 12u);  // the start, ten steps, the collision
  ASSERT_EQ(motion["collision"], 7);        // after six, at 0.5 + 0.3 * 0.5
  EXPECT_EQ(motion["remarks"], Json({"the referee: " + Describe(Contact{"hand", "box", 0.01})}));
  const auto expect_tip = [&](std::size_t frame, double elbow) {
    const Json& tip = motion["tips"][0][frame];
    EXPECT_NEAR(tip[0], 0.5 + 0.7 * std::cos(elbow), 1e-5) << frame;
    EXPECT_NEAR(tip[1], 0.7 * std::sin(elbow), 1e-5) << frame;
  };
  expect_tip(0, 0);
  expect_tip(5, 0.5);
  expect_tip(7, 0.65);
  expect_tip(11, 1);
  // The last frame is the goal: upper arm, forearm, hand.
  EXPECT_EQ(motion["frames"][11], view["goals"][0]);
  const Json& goal = view["goals"][0];
  ASSERT_EQ(goal.size(), 3u * 7);
  EXPECT_NEAR(goal[7], 0.5, 1e-5);                // the elbow's place
  EXPECT_NEAR(goal[7 + 5], std::sin(0.5), 1e-5);  // turned by 1 rad about z
  EXPECT_NEAR(goal[14], 0.5 + 0.4 * std::cos(1), 1e-5);
}

TEST_F(ViewDataTest, OfPathsBothVerdictsAreTold) {
  PathVerdict& own = *run_.path_check.verdict;
  run_.path_check.mesh_verdict = own;
  own.valid = true;
  run_.result.result.simplified_path = {{0, 0, 0}};
  run_.simplified_check.verdict.emplace().reason = "the path does not end in the goal";
  run_.simplified_check.mesh_verdict.emplace().valid = true;
  const Json view = RunView(robot_, scene_, run_, 10);
  EXPECT_EQ(view["motions"][0]["remarks"],
            Json({"the referee: valid", "the meshes: " + Describe(Contact{"hand", "box", 0.01})}));
  EXPECT_EQ(view["motions"][0]["collision"], 7) << "where the meshes touch";
  EXPECT_EQ(view["motions"][1]["remarks"],
            Json({"the referee: the path does not end in the goal", "the meshes: valid"}));
  EXPECT_FALSE(view["motions"][1].contains("collision")) << "it is no matter of place";
  run_.path_check = {};
  EXPECT_EQ(RunView(robot_, scene_, run_, 10)["motions"][0]["remarks"], Json::array())
      << "not judged yet";
}

TEST_F(ViewDataTest, SolidsAndSpheresAreThoseOfSceneAndRobot) {
  const Json view = RunView(robot_, scene_, run_, 10);
  ASSERT_EQ(view["solids"].size(), 2u);
  EXPECT_EQ(view["solids"][0]["pose"], Json({1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(view["solids"][0]["shape"], Json({{"type", "box"}, {"size", {0.2, 0.4, 0.6}}}));
  EXPECT_EQ(view["solids"][1]["link"], "hand");
  ASSERT_EQ(view["links"].size(), 4u);  // those with spheres
  EXPECT_EQ(view["links"][0]["name"], "column");
  EXPECT_EQ(view["links"][0]["moves"], false);
  EXPECT_EQ(view["links"][1]["spheres"].size(), 9u);
  EXPECT_EQ(view["links"][1]["spheres"][0], Json({0.1, 0.0, 0.0, 0.04}));
}

TEST_F(ViewDataTest, TheGeometryThatWasCheckedIsShown) {
  Robot robot = MeshArm();
  robot.enclosing_spheres = {robot.spheres.back()};
  const ShownRobot shown(std::move(robot));
  // Spheres and shapes of the upper arm and of the hand.
  const auto counts = [&](CollisionModel model) {
    run_.request.collision_model = model;
    const Json view = RunView(shown, scene_, run_, 10);
    EXPECT_EQ(view["facts"].size(), 2u) << view["facts"];
    std::vector<std::size_t> found;
    for (const Json& link : view["links"]) {
      if (link["name"] != "upper_arm" && link["name"] != "hand") continue;
      found.push_back(link["spheres"].size());
      found.push_back(link["shapes"].size());
    }
    found.push_back(view["meshes"].size());
    return found;
  };
  EXPECT_THAT(counts(CollisionModel::kSpheres), testing::ElementsAre(9, 0, 5, 0, 0));
  EXPECT_THAT(counts(CollisionModel::kVoxels), testing::ElementsAre(9, 0, 5, 0, 0));
  EXPECT_THAT(counts(CollisionModel::kMeshes), testing::ElementsAre(0, 9, 0, 5, 1));
  EXPECT_THAT(counts(CollisionModel::kEnclosing), testing::ElementsAre(1, 0, 0));
}

TEST_F(ViewDataTest, WhatStandsForAnotherGeometryIsToldAsSuch) {
  run_.request.collision_model = CollisionModel::kMeshes;
  const ShownRobot lacking(MeshArm("package://elsewhere/hand.obj"));
  const std::string why_not = ".*planar3.urdf.*--package-path elsewhere=DIR.*";
  Json view = RunView(lacking, scene_, run_, 10);
  EXPECT_THAT(view["facts"].back().get<std::string>(),
              testing::MatchesRegex(fmt::format("The collision model is 'meshes'; shown: the "
                                                "robot's spheres, because {}",
                                                why_not)));
  EXPECT_EQ(view["links"][1]["spheres"].size(), 9u);
  EXPECT_TRUE(view["links"][1]["shapes"].empty());
  run_.request.collision_model = CollisionModel::kEnclosing;
  view = RunView(lacking, scene_, run_, 10);
  EXPECT_THAT(view["facts"].back().get<std::string>(),
              testing::MatchesRegex(fmt::format("The collision model is 'enclosing'; shown: the "
                                                "robot's spheres, because it has none for that "
                                                "model, and {}",
                                                why_not)));
  EXPECT_EQ(view["links"][1]["spheres"].size(), 9u);
  view = RunView(robot_, scene_, run_, 10);
  EXPECT_EQ(view["facts"].back(),
            "The robot has no spheres for the collision model 'enclosing'; shown: the collision "
            "geometry of its URDF.");
  EXPECT_EQ(view["links"][1]["shapes"].size(), 9u);
}

TEST_F(ViewDataTest, LinksThatGoUncheckedAreTold) {
  Robot robot = MeshArm();
  robot.unchecked_links = {"hand", "column"};
  const ShownRobot shown(std::move(robot));
  const std::string fact = "Neither checked nor shown, as they have no spheres: hand, column.";
  EXPECT_EQ(RunView(shown, scene_, run_, 10)["facts"].back(), fact);
  run_.request.collision_model = CollisionModel::kMeshes;
  EXPECT_NE(RunView(shown, scene_, run_, 10)["facts"].back(), fact);
}

TEST_F(ViewDataTest, MoreTrianglesThanAPageCanHoldAreMadeFewer) {
  run_.request.collision_model = CollisionModel::kMeshes;
  const Json view = RunView(ShownRobot(MeshArm(), "", 1000), scene_, run_, 10);
  ASSERT_EQ(view["meshes"].size(), 1u);
  const std::size_t num_triangles = NumTriangles(view["meshes"].front());
  EXPECT_GT(num_triangles, 400u);
  EXPECT_LE(num_triangles, 1000u);
  EXPECT_EQ(view["facts"].back(),
            fmt::format("The robot's meshes are shown coarser than they are: {} triangles instead "
                        "of 3996, corners up to 3.46 mm from their places.",
                        num_triangles));
  // However few there may be, a hand stays one.
  const Json coarsest = RunView(ShownRobot(MeshArm(), "", 1), scene_, run_, 10);
  EXPECT_GT(NumTriangles(coarsest["meshes"].front()), 30u);
}

TEST_F(ViewDataTest, AMeshInTwoPlacesIsHeldOnceAndCountsTwiceAsItIsDrawn) {
  MeshArm();
  const auto file = folder_ / "arm/planar3.urdf";
  std::string urdf = ReadText(file);
  const std::string mesh = "<mesh filename=\"hand.obj\"/>";
  const std::size_t next = urdf.find("<sphere", urdf.find(mesh));
  urdf.replace(next, urdf.find("/>", next) + 2 - next, mesh);
  folder_.Write("arm/planar3.urdf", urdf);
  run_.request.collision_model = CollisionModel::kMeshes;
  const Json view = RunView(ShownRobot(LoadRobot(folder_ / "arm"), "", 5000), scene_, run_, 10);
  const Json& hand = view["links"][3]["shapes"];
  EXPECT_EQ(hand[0]["shape"], hand[1]["shape"]);
  ASSERT_EQ(view["meshes"].size(), 1u);
  const std::size_t num_triangles = NumTriangles(view["meshes"].front());
  EXPECT_LE(num_triangles, 2500u);
  EXPECT_THAT(
      view["facts"].back().get<std::string>(),
      testing::HasSubstr(fmt::format(
          "coarser than they are: {} triangles instead of 7992, corners ", 2 * num_triangles)));
}

TEST_F(ViewDataTest, AMeshAtManyPlacesOfASceneIsMadeCoarser) {
  const Mesh can{"", Eigen::Vector3d::Ones(), PrismMesh(0.05, 0.2, 1000)};  // Of 3996 triangles.
  std::vector<PlacedShape>& cans = scene_.objects.front().shapes;
  cans.assign(49, {can, Eigen::Isometry3d::Identity()});
  scene_.attached.front().object.shapes = {{can, Eigen::Isometry3d::Identity()}};
  EXPECT_EQ(RunView(robot_, scene_, run_, 10)["facts"].size(), 2u) << "199,800 triangles";
  cans.push_back(cans.front());
  const Json view = RunView(robot_, scene_, run_, 10);
  ASSERT_EQ(view["meshes"].size(), 1u);
  const std::size_t num_triangles = NumTriangles(view["meshes"].front());
  EXPECT_LE(51 * num_triangles, 200'000u);
  EXPECT_THAT(view["facts"].back().get<std::string>(),
              testing::StartsWith(fmt::format("The scene's meshes are shown coarser than they are: "
                                              "{} triangles instead of 203796, corners ",
                                              51 * num_triangles)));
}

TEST_F(ViewDataTest, WithoutSpheresTheBodiesAreShown) {
  run_.request.collision_model = CollisionModel::kMeshes;
  const Json view = RunView(WithoutSpheres(), scene_, run_, 10);
  ASSERT_EQ(view["links"].size(), 4u);
  const Json& arm = view["links"][1];
  EXPECT_TRUE(arm["spheres"].empty());
  ASSERT_EQ(arm["shapes"].size(), 9u);
  EXPECT_EQ(arm["shapes"][0]["shape"], Json({{"type", "sphere"}, {"radius", 0.04}}));
  EXPECT_EQ(arm["shapes"][0]["pose"], Json({0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}));
  const Json& hand = view["links"][3]["shapes"][0]["shape"];
  EXPECT_EQ(hand["type"], "mesh");
  EXPECT_EQ(NumTriangles(view["meshes"][hand["mesh"].get<std::string>()]), 3996u);
  EXPECT_EQ(view["motions"][0]["frames"][0].size(), 3u * 7) << "they move";
}

TEST_F(ViewDataTest, OfARobotThatCannotBeShownItIsSaid) {
  const ShownRobot robot = WithoutSpheres("package://elsewhere/hand.obj");
  const Json view = RunView(robot, scene_, run_, 10);
  EXPECT_THAT(
      view["facts"].back().get<std::string>(),
      testing::MatchesRegex("The robot is not shown: it has no spheres, and .*planar3.urdf.*"
                            "package://elsewhere/hand.obj.*"));
  EXPECT_EQ(view["links"].size(), 1u) << "what holds the tool";
}

TEST_F(ViewDataTest, ARunThatFoundNothingShowsItsProblem) {
  run_.result.result.path.clear();
  const Json view = RunView(robot_, scene_, run_, 10);
  EXPECT_TRUE(view["motions"].empty());
  EXPECT_EQ(view["goals"].size(), 1u);
}

TEST_F(ViewDataTest, OfSeveralGoalsThatAtThePathsEndIsShown) {
  run_.request.goal.clear();
  for (const double elbow : {-1.0, 0.5, 1.1, 1.0}) {
    for (const JointGoal& one : std::vector<JointGoal>{{"shoulder", 0, 0, 0},
                                                       {"elbow", elbow, 0, elbow == 1.1 ? 0.2 : 0},
                                                       {"wrist", 0, 0, 0}}) {
      run_.request.goal.push_back(one);
    }
  }
  const auto elbow_turned = [](const Json& goal) {
    return 2 * std::asin(goal[7 + 5].get<double>());
  };
  Json view = RunView(robot_, scene_, run_, 10);
  ASSERT_EQ(view["goals"].size(), 1u);
  EXPECT_NEAR(elbow_turned(view["goals"][0]), 1.0, 1e-4) << "nearest of those that contain it";
  EXPECT_EQ(view["facts"].back(), "Of 4 goals the one at the path's end is shown.");
  run_.result.result.path.back()[0] = 0.4;  // ends in none
  EXPECT_NEAR(elbow_turned(RunView(robot_, scene_, run_, 10)["goals"][0]), 0.5, 1e-4);
  // Without a path: all, or as many as can be told apart.
  run_.result.result.path.clear();
  view = RunView(robot_, scene_, run_, 10);
  ASSERT_EQ(view["goals"].size(), 4u);
  EXPECT_NEAR(elbow_turned(view["goals"][0]), -1.0, 1e-4);
  EXPECT_EQ(view["facts"].size(), 2u) << "nothing is left out";
  for (int i = 0; i < 2; ++i) {
    const std::vector<JointGoal> copy = run_.request.goal;
    run_.request.goal.insert(run_.request.goal.end(), copy.begin(), copy.end());
  }
  view = RunView(robot_, scene_, run_, 10);
  EXPECT_EQ(view["goals"].size(), 8u);
  EXPECT_EQ(view["facts"].back(), "8 of 16 goals are shown.");
}

TEST_F(ViewDataTest, WhatDoesNotFitTheRobotIsRefused) {
  run_.request.robot_id = "other";
  ExpectInputError([&] { RunView(robot_, scene_, run_, 10); }, {"planar3", "is not the robot"});
}

TEST_F(ViewDataTest, APathThatLacksJointsIsLeftOutAndToldOf) {
  run_.result.joint_names = {"elbow", "shoulder", "thumb"};
  run_.message = "the referee's reason";
  const Json view = RunView(robot_, scene_, run_, 10);
  EXPECT_TRUE(view["motions"].empty());
  EXPECT_EQ(view["goals"].size(), 1u);
  ASSERT_EQ(view["facts"].size(), 3u);
  EXPECT_THAT(view["facts"][0].get<std::string>(), testing::HasSubstr(run_.message));
  EXPECT_EQ(view["facts"][2], "Its path is not shown: it has no joint 'wrist' of group arm.");
}

TEST_F(ViewDataTest, TheViewDrawsAndTheRobotMoves) {
  if (!FindBrowser()) GTEST_SKIP() << "no Chromium here: apt-get install chromium";
  const TemporaryFolder folder;
  WriteFile(folder / "view.html", ViewPage(RunView(robot_, scene_, run_, 10)));
  const nlohmann::json found = Browse(folder / "view.html", std::string(kPixels) + R"script(
    view.moveTo(0);
    const first = pixels();
    found.colours = new Set(first).size;
    view.moveTo(1);
    const last = pixels();
    found.moved = differing(first, last);
    view.canvas.dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowLeft"}));
    found.turned = differing(last, pixels());
    const press = (key, shiftKey = false) => view.canvas.dispatchEvent(new KeyboardEvent("keydown", {key, shiftKey}));
    const distance = () => view.seenFrom().position.distanceTo(view.seenFrom().target);
    const far = distance();
    press("+");
    found.nearer = distance() / far;
    press("-");
    found.back = distance() / far;
    const target = view.seenFrom().target;
    press("ArrowUp", true);
    found.moved_to = view.seenFrom().target.distanceTo(target);
    found.caption = document.querySelector(".captions").textContent;
    document.getElementById("theme").click();
    found.dark = differing(last, pixels());
    view.dispose();
    found.left = document.querySelectorAll("canvas").length;
  )script");
  EXPECT_GT(found["colours"], 10);
  EXPECT_GT(found["moved"], 100);
  EXPECT_GT(found["turned"], 100);
  EXPECT_LT(found["nearer"], 0.95);
  EXPECT_NEAR(found["back"], 1, 1e-6);
  EXPECT_GT(found["moved_to"], 0.01);
  EXPECT_GT(found["dark"], 1000);
  EXPECT_EQ(found["caption"], "raw path; the referee: " + Describe(Contact{"hand", "box", 0.01}));
  EXPECT_EQ(found["left"], 0);
}

TEST_F(ViewDataTest, HoweverNarrowAViewHoldsTheWholeRobot) {
  if (!FindBrowser()) GTEST_SKIP() << "no Chromium here: apt-get install chromium";
  scene_.objects.clear();
  run_.result.result.simplified_path = {{0, 0, 0}, {1, 0, 0}};
  const TemporaryFolder folder;
  WriteFile(folder / "view.html", ViewPage(RunView(robot_, scene_, run_, 10)));
  const nlohmann::json found = Browse(folder / "view.html", std::string(kPixels) + R"script(
    const main = document.getElementById("main");
    const distance = () => view.seenFrom().position.distanceTo(view.seenFrom().target);
    const wide = distance();
    const light = pixels();
    found.seen = [1100, 800, 400].map(width => {
      main.style.width = width + "px";
      dispatchEvent(new Event("resize"));
      const stacked = main.classList.contains("stacked"), {canvas} = view, all = pixels();
      const [columns, rows] = stacked ? [1, 2] : [2, 1];
      const at = (x, y) => all[y * canvas.width + x];
      // The picture's first, last and middle columns and rows, inside of the frames.
      const cut = [3, Math.floor(canvas.width / 2) - 4, canvas.width - 4].filter((x, i) => i !== 1 || columns === 2)
        .reduce((sum, x) => sum + [...Array(canvas.height).keys()].filter(y =>
          y > 3 && y < canvas.height - 4 && Math.abs(y - canvas.height / 2) > 4 && at(x, y) !== at(3, 3)).length, 0);
      const halves = rows === 2 ? [all.slice(0, all.length / 2), all.slice(all.length / 2)] : [all];
      return {stacked, cut, fit: distance() / wide * Math.min(1, canvas.clientWidth / columns / (canvas.clientHeight / rows)),
              colours: Math.min(...halves.map(half => new Set(half).size))};
    });
    main.style.width = "";
    dispatchEvent(new Event("resize"));
    found.back = distance() / wide;
    document.getElementById("theme").click();
    dispatchEvent(new Event("beforeprint"));
    found.printed = differing(light, pixels(document.querySelector(".sheet")));
  )script");
  for (const auto& seen : found["seen"]) {
    EXPECT_EQ(seen["cut"], 0) << seen;
    EXPECT_NEAR(seen["fit"], 1, 1e-6) << seen;
    EXPECT_GT(seen["colours"], 10) << seen;
  }
  EXPECT_EQ(found["seen"][1]["stacked"], false);
  EXPECT_EQ(found["seen"][2]["stacked"], true);
  EXPECT_NEAR(found["back"], 1, 1e-6);
  EXPECT_EQ(found["printed"], 0) << "not what was seen, in light colours";
}

TEST_F(ViewDataTest, ObjectsNearTheRobotAreInViewFromTheBeginning) {
  if (!FindBrowser()) GTEST_SKIP() << "no Chromium here: apt-get install chromium";
  const TemporaryFolder folder;
  WriteFile(folder / "view.html", ViewPage(RunView(robot_, scene_, run_, 10)));
  const nlohmann::json found = Browse(folder / "view.html", R"script(
    view.dispose();
    const data = JSON.parse(document.getElementById("data").textContent);
    const seen = (size, ...place) => {
      Object.assign(data.solids[0], {shape: {type: "box", size}, pose: [...place, 0, 0, 0, 1]});
      const one = makeViewer(document.getElementById("main"), data);
      const {position, target} = one.seenFrom();
      one.dispose();
      return {distance: position.distanceTo(target), x: target.x};
    };
    found.far = seen([0.2, 0.4, 0.6], 9, 0, 0);
    found.near = seen([0.2, 0.4, 0.6], 1.4, 0, 0);
    found.floor = seen([90, 90, 0.1], 0, 0, -0.2);
  )script");
  EXPECT_GT(found["near"]["distance"], 1.05 * found["far"]["distance"].get<double>());
  EXPECT_GT(found["near"]["x"], found["far"]["x"].get<double>() + 0.05);
  EXPECT_EQ(found["floor"], found["far"]);
}

TEST_F(ViewDataTest, TheMeshOfABoxIsDrawnAsTheBox) {
  if (!FindBrowser()) GTEST_SKIP() << "no Chromium here: apt-get install chromium";
  TriangleMesh box = BoxMesh({0.5, 0.4, 0.6});
  for (const std::size_t num_vertices : {8u, 70000u}) {  // indices of 16 and of 32 bits
    box.vertices.resize(num_vertices, Eigen::Vector3d::Zero());
    Mesh mesh;
    mesh.triangles = box;
    scene_.objects[0].shapes[0].shape = mesh;
    scene_.objects[0].X_WO.translation() = Eigen::Vector3d(0.5, -0.5, 0.2);
    const auto page = folder_ / fmt::format("{}.html", num_vertices);
    WriteFile(page, ViewPage(RunView(robot_, scene_, run_, 10)));
    const nlohmann::json found = Browse(page, std::string(kPixels) + R"script(
      const ofMesh = pixels();
      const data = JSON.parse(document.getElementById("data").textContent);
      let last = view;
      const picture = shape => {
        data.solids[0].shape = shape;
        last = makeViewer(document.getElementById("main"), data, last);
        return pixels(last.canvas);
      };
      found.to_box = differing(ofMesh, picture({type: "box", size: [0.5, 0.4, 0.6]}));
      found.to_another = differing(ofMesh, picture({type: "box", size: [0.5, 0.4, 0.5]}));
    )script");
    EXPECT_LT(found["to_box"], 200);
    EXPECT_GT(found["to_another"], 2000);
  }
}

TEST_F(ViewDataTest, ARobotWithoutSpheresIsDrawnAndOneThatCannotBeIsNoHarm) {
  if (!FindBrowser()) GTEST_SKIP() << "no Chromium here: apt-get install chromium";
  scene_.attached.clear();
  const auto drawn = [&](const std::string& mesh) {
    const auto page = folder_ / (mesh + ".html");
    WriteFile(page, ViewPage(RunView(WithoutSpheres(mesh), scene_, run_, 10)));
    return Browse(page, std::string(kPixels) + R"script(
      view.moveTo(0);
      const first = pixels();
      found.colours = new Set(first).size;
      view.moveTo(1);
      found.moved = differing(first, pixels());
      const away = new KeyboardEvent("keydown", {key: "-"});
      for (let i = 0; i < 30; ++i) view.canvas.dispatchEvent(away);
      const far = pixels();
      view.moveTo(0);
      found.moved_far = differing(far, pixels());
      found.metres = view.seenFrom().position.length();
    )script");
  };
  nlohmann::json found = drawn("hand.obj");
  EXPECT_GT(found["colours"], 10);
  EXPECT_GT(found["moved"], 100);
  EXPECT_GT(found["metres"], 60);
  EXPECT_GT(found["moved_far"], 0) << "nothing is cut off, however far";
  found = drawn("gone.obj");
  EXPECT_GT(found["colours"], 1) << "the box";
  EXPECT_EQ(found["moved"], 0);
}

}  // namespace
}  // namespace planbench
