#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "geometry/mesh_loader.h"
#include "scene_server/scene_service.h"
#include "tests/scene_server/tiny_world.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/shared_data.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Expects a service with these folders not to start, and to say why in one line.
void ExpectStartFailure(const TemporaryFolder& folder, const std::vector<fs::path>& problems,
                        const std::vector<std::string>& parts) {
  const Robot robot = LoadRobot(WriteTinyRobot(folder));
  ExpectInputError([&] { SceneService(robot, std::nullopt, problems); }, parts);
}

/// Expects a service with a set of this one problem to refuse it, and to say why.
void ExpectRefusal(const Problem& problem, const std::vector<std::string>& parts) {
  const TemporaryFolder folder;
  WriteTinyProblem(problem, folder.path() / "set", 1);
  SceneService service(LoadRobot(WriteTinyRobot(folder)), std::nullopt, {folder.path() / "set"});
  const ProblemAnswer answer = service.AnswerProblem({"id", "set", 1});
  EXPECT_FALSE(answer.problem.ok);
  EXPECT_FALSE(answer.scene);
  for (const std::string& part : parts) EXPECT_THAT(answer.problem.message, HasSubstr(part));
}

TEST(ProblemAnswer, GivesTheProblemAndItsScene) {
  TinyWorld world;
  const ProblemAnswer answer = world.service().AnswerProblem({"id 7", "cans", 1});
  const ProblemMessage& problem = answer.problem;
  ASSERT_TRUE(problem.ok) << problem.message;
  EXPECT_EQ(problem.request_id, "id 7");
  EXPECT_EQ(problem.problem_set, "cans");
  EXPECT_EQ(problem.problem_index, 1);
  EXPECT_EQ(problem.group, "arm");
  EXPECT_EQ(problem.time_limit_s, 7);
  ASSERT_EQ(problem.goal.size(), 2u);
  // In the group's order, which is not the file's.
  EXPECT_EQ(problem.goal[0].joint, "swing");
  EXPECT_EQ(problem.goal[0].position, kGoalSwing);
  EXPECT_EQ(problem.goal[1].joint, "lift");

  ASSERT_TRUE(answer.scene);
  EXPECT_TRUE(answer.scene->ok);
  EXPECT_EQ(answer.scene->request_id, "id 7");
  EXPECT_EQ(answer.scene->scene_id, problem.scene_id);
  EXPECT_EQ(SceneId(answer.scene->scene), problem.scene_id);
  EXPECT_EQ(problem.scene_id, SceneId(TinyProblem().scene));
}

TEST(ProblemAnswer, GivesTheWholeStart) {
  TinyWorld world;
  const JointState start = world.service().AnswerProblem({"id", "cans", 1}).problem.start;
  EXPECT_THAT(start.names, ElementsAre("lift", "swing", "finger_joint"));
  EXPECT_THAT(start.positions, ElementsAre(0, kStartSwing, 0.05));
}

TEST(ProblemAnswer, SaysWhatWasReadOtherwiseThanWritten) {
  TinyWorld world;
  EXPECT_EQ(world.service().AnswerProblem({"id", "cans", 1}).problem.message, "");
  world.folder().Write("problems/cans/scene0002.yaml", R"(robot_model_name: tiny
world: {collision_objects: [{id: ball, primitives: [{type: sphere, dimensions: [0.1]}],
  primitive_poses: [{position: [3, 0, 0], orientation: [0, 0, 0, 0]}]}]}
)");
  const ProblemMessage problem = world.service().AnswerProblem({"id", "cans", 2}).problem;
  EXPECT_TRUE(problem.ok);
  EXPECT_THAT(problem.message, AllOf(HasSubstr("scene0002.yaml:3"), HasSubstr("no rotation")));
}

TEST(ProblemAnswer, SaysInWhatPostureTheRefereesRobotStandsInstead) {
  TinyWorld world(/*with_mesh_robot=*/true);
  const ProblemMessage problem = world.service().AnswerProblem({"id", "cans", 2}).problem;
  EXPECT_TRUE(problem.ok);
  EXPECT_THAT(problem.message,
              HasSubstr("request0002.yaml: --referee-robot judges it in another posture: joint "
                        "'finger_joint' is fixed there, at 0.0000, not at 0.0500"));
}

TEST(ProblemAnswer, ThatPostureHidesNoOtherWarning) {
  TinyWorld world(/*with_mesh_robot=*/true);
  world.folder().Write("problems/cans/scene0002.yaml", R"(robot_model_name: tiny
world: {collision_objects: [{id: ball, primitives: [{type: sphere, dimensions: [0.1]}],
  primitive_poses: [{position: [3, 0, 0], orientation: [0, 0, 0, 0]}]}]}
)");
  EXPECT_THAT(world.service().AnswerProblem({"id", "cans", 2}).problem.message,
              AllOf(HasSubstr("judges it in another posture: "), HasSubstr("scene0002.yaml:3"),
                    HasSubstr("no rotation")));
}

TEST(ProblemAnswer, NamesTheGroupThatAnEmptyNameMeans) {
  const TemporaryFolder folder;
  Problem problem = TinyProblem();
  problem.group = "";
  WriteTinyProblem(problem, folder.path() / "set", 1);
  SceneService service(LoadRobot(WriteTinyRobot(folder)), std::nullopt, {folder.path() / "set"});
  EXPECT_EQ(service.AnswerProblem({"id", "set", 1}).problem.group, "arm");
}

TEST(ProblemAnswer, ProblemsOfEqualScenesShareTheId) {
  TinyWorld world;
  const auto scene_id = [&](int index) {
    return world.service().AnswerProblem({"id", "cans", index}).problem.scene_id;
  };
  EXPECT_EQ(scene_id(1), scene_id(5));
  EXPECT_NE(scene_id(1), scene_id(2));
}

TEST(ProblemAnswer, UnknownSetNamesTheKnownOnes) {
  TinyWorld world;
  const ProblemAnswer answer = world.service().AnswerProblem({"id", "boxes", 1});
  EXPECT_FALSE(answer.problem.ok);
  EXPECT_FALSE(answer.scene);
  EXPECT_EQ(answer.problem.request_id, "id");
  EXPECT_EQ(answer.problem.problem_set, "boxes");
  EXPECT_THAT(answer.problem.message, AllOf(HasSubstr("'boxes'"), HasSubstr("cans")));
}

TEST(ProblemAnswer, UnknownIndexNamesTheRange) {
  TinyWorld world;
  const ProblemMessage problem = world.service().AnswerProblem({"id", "cans", 3}).problem;
  EXPECT_FALSE(problem.ok);
  EXPECT_THAT(problem.message, AllOf(HasSubstr("'cans' has no problem 3"), HasSubstr("1-2, 5")));
  EXPECT_EQ(problem.problem_index, 3);
}

TEST(ProblemAnswer, MalformedFileIsRefusedWithFileAndLine) {
  TinyWorld world;
  world.folder().Write("problems/cans/request0002.yaml", "group_name: arm\ngoal_constraints: 3\n");
  const ProblemAnswer answer = world.service().AnswerProblem({"id", "cans", 2});
  EXPECT_FALSE(answer.problem.ok);
  EXPECT_FALSE(answer.scene);
  EXPECT_THAT(answer.problem.message, HasSubstr("request0002.yaml:2"));
}

// On the bus the two frames have one name: control characters are escaped there.
TEST(ProblemAnswer, WhatPlannersCouldNotTakeOffTheBusIsRefused) {
  TinyWorld world;
  world.folder().Write("problems/cans/scene0002.yaml", R"(robot_model_name: tiny
fixed_frame_transforms:
  - {header: {frame_id: 'a\tb'}, child_frame_id: base_link,
     transform: {translation: [0, 0, 0], rotation: [0, 0, 0, 1]}}
  - {header: {frame_id: "a\tb"}, child_frame_id: base_link,
     transform: {translation: [0, 0, 0], rotation: [0, 0, 0, 1]}}
)");
  const ProblemAnswer answer = world.service().AnswerProblem({"id", "cans", 2});
  EXPECT_FALSE(answer.problem.ok);
  EXPECT_FALSE(answer.scene);
  EXPECT_THAT(answer.problem.message,
              AllOf(HasSubstr("scene0002.yaml: cannot be sent: SCENE: frame[1]"),
                    HasSubstr("occurs twice")));
}

TEST(ProblemAnswer, OfASceneThatReceiveBuffersDoNotHoldTheSizeIsTold) {
  const TemporaryFolder folder;
  const fs::path set = folder.path() / "cans";
  Problem large = TinyProblem();
  large.scene.objects[0].shapes.resize(3000, large.scene.objects[0].shapes[0]);
  WriteTinyProblem(large, set, 1);
  WriteTinyProblem(large, set, 2);  // of the same scene
  const Robot robot = LoadRobot(WriteTinyRobot(folder));
  const auto told = [&](std::size_t receive_buffer_bytes, int index) {
    SceneService service(robot, std::nullopt, {set}, false, receive_buffer_bytes);
    const ProblemMessage problem = service.AnswerProblem({"id", "cans", index}).problem;
    EXPECT_TRUE(problem.ok);
    return problem.message;
  };
  EXPECT_EQ(told(300'000, 1), "");
  for (const int index : {1, 2}) {
    EXPECT_THAT(
        told(200'000, index),
        AllOf(HasSubstr(fmt::format("scene000{}.yaml: the scene is a message of 0.3 MB", index)),
              HasSubstr("hold 0.2 MB"), HasSubstr("recv_buf_size")));
  }
}

TEST(ProblemAnswer, ProblemsAreReadOnceAndKept) {
  TinyWorld world;
  ASSERT_TRUE(world.service().AnswerProblem({"id", "cans", 5}).problem.ok);
  fs::remove(world.folder().path() / "problems/cans/scene0005.yaml");
  EXPECT_TRUE(world.service().AnswerProblem({"another id", "cans", 5}).problem.ok);
}

TEST(ProblemAnswer, WhatHasChangedSinceTheSetGotItsIdIsRefused) {
  TinyWorld world;
  const fs::path set = world.folder().path() / "problems/cans";
  const std::string id = world.service().ProblemSets("server").sets.at(0).content_id;
  Problem other = TinyProblem();
  other.goal[0].position += 0.1;
  WriteTinyProblem(other, set, 5);
  const ProblemAnswer answer = world.service().AnswerProblem({"id", "cans", 5});
  EXPECT_FALSE(answer.problem.ok);
  EXPECT_FALSE(answer.scene);
  EXPECT_THAT(answer.problem.message,
              HasSubstr("request0005.yaml has changed since the server started; start it again"));
  WriteTinyProblem(TinyProblem(), set, 5);  // as it was
  EXPECT_TRUE(world.service().AnswerProblem({"id", "cans", 5}).problem.ok);
  EXPECT_EQ(world.service().ProblemSets("server").sets.at(0).content_id, id);
}

TEST(ProblemAnswer, WhatCouldNotBeReadWhenTheSetGotItsIdIsRefusedEvenIfMended) {
  TinyWorld world;
  world.folder().Write("problems/cans/scene0002.yaml", R"(robot_model_name: tiny
world: {collision_objects: [{id: rock, meshes: [{resource: rock.obj}],
  mesh_poses: [{position: [3, 0, 0], orientation: [0, 0, 0, 1]}]}]}
)");
  const fs::path request = world.folder().path() / "problems/cans/request0005.yaml";
  fs::rename(request, request.string() + ".away");
  const auto refusal = [&](int index) {
    return world.service().AnswerProblem({"id", "cans", index}).problem.message;
  };
  world.service().ProblemSets("server");
  EXPECT_THAT(refusal(2), HasSubstr("rock.obj"));
  EXPECT_THAT(refusal(5), HasSubstr("request0005.yaml: is missing"));

  world.folder().Write("problems/cans/rock.obj",
                       "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  fs::rename(request.string() + ".away", request);
  EXPECT_THAT(refusal(2), AllOf(HasSubstr("a file that "), HasSubstr("scene0002.yaml or its"),
                                HasSubstr("has changed since the server started")));
  EXPECT_THAT(refusal(5), HasSubstr("request0005.yaml has changed since the server started"));
}

TEST(SceneAnswer, GivesAServedScene) {
  TinyWorld world;
  const std::string scene_id = world.SceneIdOfFirst();
  const SceneMessage scene = world.service().AnswerScene({"id", scene_id});
  ASSERT_TRUE(scene.ok) << scene.message;
  EXPECT_EQ(scene.request_id, "id");
  EXPECT_EQ(scene.scene_id, scene_id);
  EXPECT_EQ(SceneId(scene.scene), scene_id);
}

TEST(SceneAnswer, FindsTheSceneOfAProblemThatNobodyAskedForYet) {
  TinyWorld world;
  Problem problem = TinyProblem();
  problem.scene.objects.pop_back();                                    // as in problem 2
  world.folder().Write("problems/cans/request0005.yaml", "nonsense");  // must not be in the way
  const SceneMessage scene = world.service().AnswerScene({"id", SceneId(problem.scene)});
  ASSERT_TRUE(scene.ok) << scene.message;
  EXPECT_EQ(scene.scene.objects.size(), 1u);
}

TEST(SceneAnswer, UnknownSceneIsRefused) {
  TinyWorld world;
  const SceneMessage scene = world.service().AnswerScene({"id", "0123"});
  EXPECT_FALSE(scene.ok);
  EXPECT_EQ(scene.request_id, "id");
  EXPECT_EQ(scene.scene_id, "0123");
  EXPECT_THAT(scene.message, HasSubstr("'0123'"));
}

TEST(ProblemSets, AreSummarised) {
  TinyWorld world;
  const ProblemSetsMessage message = world.service().ProblemSets("server");
  EXPECT_EQ(message.server, "server");
  EXPECT_EQ(message.robot_name, "tiny");
  EXPECT_EQ(message.robot_id, world.service().robot().content_id);
  EXPECT_EQ(message.referee_robot_id, "");
  ASSERT_EQ(message.sets.size(), 1u);
  EXPECT_EQ(message.sets[0].name, "cans");
  EXPECT_THAT(message.sets[0].indices, ElementsAre(1, 2, 5));

  TinyWorld with_meshes(/*with_mesh_robot=*/true);
  EXPECT_NE(with_meshes.service().ProblemSets("server").referee_robot_id, "");
}

TEST(ProblemSets, HaveTheIdOfWhatTheirFilesSay) {
  const TemporaryFolder folder;
  const auto set = folder.path() / "problems" / "cans";
  const auto id = [&](const Problem& problem) {
    WriteTinyProblem(problem, set, 1);
    SceneService service(LoadRobot(WriteTinyRobot(folder)), std::nullopt, {set});
    return service.ProblemSets("server").sets.at(0).content_id;
  };
  Problem problem = TinyProblem();
  const std::string first = id(problem);
  EXPECT_EQ(id(problem), first);
  problem.goal[0].position += 0.1;
  EXPECT_NE(id(problem), first);
  problem = TinyProblem();
  problem.scene.objects.pop_back();
  EXPECT_NE(id(problem), first);

  // A mesh in a file of its own.
  const std::string rest = "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  const auto file = folder.Write("problems/cans/thing.obj", "v 0 0 0\n" + rest);
  problem = TinyProblem();
  SceneObject thing = problem.scene.objects[0];
  thing.id = "thing";
  thing.X_WO.translation() = Eigen::Vector3d(5, 5, 5);
  Mesh shape;
  shape.resource = file.string();
  shape.triangles = LoadMesh(file);
  thing.shapes = {{shape, Eigen::Isometry3d::Identity()}};
  problem.scene.objects.push_back(thing);
  const std::string with_mesh = id(problem);
  setenv("PLANBENCH_MESH_STORE", (file / "below").c_str(), 1);
  EXPECT_EQ(id(problem), with_mesh) << "whether meshes can be stored or not";
  unsetenv("PLANBENCH_MESH_STORE");
  folder.Write("problems/cans/thing.obj", "v -1 0 0\n" + rest);
  EXPECT_NE(id(problem), with_mesh);

  WriteTinyProblem(TinyProblem(), set, 1);
  const std::string one_problem = id(TinyProblem());
  WriteTinyProblem(TinyProblem(), set, 2);
  EXPECT_NE(id(TinyProblem()), one_problem);
}

TEST(ProblemSets, HaveTheIdOfMeshesThatAreNamedByTheirFilesAlone) {
  const TemporaryFolder folder;
  const auto set = folder.path() / "problems" / "cans";
  const auto id = [&](const std::string& mesh, const std::string& corner) {
    WriteTinyProblem(TinyProblem(), set, 1);
    folder.Write("problems/cans/scene0001.yaml",
                 "world: {collision_objects: [{id: rock, " + mesh + "}]}\n");
    folder.Write("problems/cans/rock.obj", corner +
                                               "\nv 6 5 5\nv 5 6 5\nv 5 5 6\nf 1 3 2\nf 1 2 4\n"
                                               "f 2 3 4\nf 3 1 4\n");
    SceneService service(LoadRobot(WriteTinyRobot(folder)), std::nullopt, {set});
    return service.ProblemSets("server").sets.at(0).content_id;
  };
  for (const char* mesh : {"mesh: rock.obj", "meshes: [rock.obj]"}) {
    EXPECT_NE(id(mesh, "v 5 5 5"), id(mesh, "v 4 5 5")) << mesh;
  }
}

TEST(ProblemSets, FolderOfSetsServesEach) {
  const TemporaryFolder folder;
  for (const char* name : {"b", "a"}) {
    WriteTinyProblem(TinyProblem(), folder.path() / "problems" / name, 1);
  }
  folder.Write("problems/notes/readme.txt", "no problems here");
  SceneService service(LoadRobot(WriteTinyRobot(folder)), std::nullopt,
                       {folder.path() / "problems"});
  const ProblemSetsMessage message = service.ProblemSets("server");
  ASSERT_EQ(message.sets.size(), 2u);
  EXPECT_EQ(message.sets[0].name, "a");
  EXPECT_EQ(message.sets[1].name, "b");
}

TEST(ProblemSets, AreFoundAtAnyDepth) {
  const TemporaryFolder folder;
  for (const char* name : {"b/far/cans", "a/boxes", "a/more/and/more/cups"}) {
    WriteTinyProblem(TinyProblem(), folder.path() / "problems" / name, 1);
  }
  fs::create_directory_symlink(folder.path() / "problems", folder.path() / "problems/a/loop");
  SceneService service(LoadRobot(WriteTinyRobot(folder)), std::nullopt,
                       {folder.path() / "problems"});
  std::vector<std::string> names;
  for (const ProblemSetSummary& set : service.ProblemSets("server").sets) {
    names.push_back(set.name);
  }
  EXPECT_THAT(names, ElementsAre("boxes", "cans", "cups"));
}

TEST(ProblemSets, LinksToNowhereAreRefusedAtAnyDepth) {
  const TemporaryFolder folder;
  const fs::path problems = folder.path() / "problems";
  WriteTinyProblem(TinyProblem(), problems / "cans", 1);
  fs::create_directories(problems / "far/away");
  fs::create_symlink("somebody@somewhere.1", problems / "far/.#notes");  // an editor's lock
  fs::create_symlink(".loop", problems / "far/.loop");                   // leads to itself
  const Robot robot = LoadRobot(WriteTinyRobot(folder));
  EXPECT_EQ(SceneService(robot, std::nullopt, {problems}).ProblemSets("server").sets.size(), 1u);
  const std::string unlikely(300, 'x');  // a name longer than any file's
  for (const auto& [target, reason] : std::map<std::string, std::string>{
           {"gone", "No such file or directory"},
           {"cups", "Too many levels of symbolic links"},  // a link to itself
           {unlikely, "File name too long"}}) {
    fs::create_directory_symlink(target, problems / "far/away/cups");
    ExpectStartFailure(folder, {problems},
                       {"problems/far/away/cups: is a link to '" + target.substr(0, 20),
                        "cannot be followed: " + reason});
    fs::remove(problems / "far/away/cups");
  }
}

TEST(ProblemSets, AreNotHiddenByFoldersNamedLikeAProblem) {
  const TemporaryFolder folder;
  WriteTinyProblem(TinyProblem(), folder.path() / "problems" / "cans", 1);
  fs::create_directories(folder.path() / "problems" / "scene0001.yaml");
  SceneService service(LoadRobot(WriteTinyRobot(folder)), std::nullopt,
                       {folder.path() / "problems"});
  const ProblemSetsMessage message = service.ProblemSets("server");
  ASSERT_EQ(message.sets.size(), 1u);
  EXPECT_EQ(message.sets[0].name, "cans");
}

TEST(ProblemSets, TwoOfOneNameAreRefusedWithBothFolders) {
  const TemporaryFolder folder;
  const fs::path one = folder.path() / "one" / "cans";
  const fs::path two = folder.path() / "two" / "cans";
  WriteTinyProblem(TinyProblem(), one, 1);
  WriteTinyProblem(TinyProblem(), two, 1);
  ExpectStartFailure(folder, {one, two}, {"'cans'", one.string(), two.string()});
}

TEST(ProblemSets, FoldersWithoutProblemsAreRefused) {
  const TemporaryFolder folder;
  const fs::path missing = folder.path() / "missing";
  ExpectStartFailure(folder, {missing}, {missing.string(), "no such folder"});
  const fs::path empty = folder.path() / "empty";
  fs::create_directories(empty / "also_empty");
  ExpectStartFailure(folder, {empty}, {empty.string(), "holds no problems"});
  ExpectStartFailure(folder, {}, {"--problems"});
}

TEST(WrongRobot, IsRefusedByItsName) {
  Problem problem = TinyProblem();
  problem.scene.robot_name = "fetch";
  ExpectRefusal(problem, {"scene0001.yaml:2: robot_model_name", "'fetch'", "'tiny'"});
}

TEST(WrongRobot, IsRefusedByAJoint) {
  Problem problem = TinyProblem();
  problem.start.names[0] = "torso";
  ExpectRefusal(problem, {"scene0001.yaml:7: robot_state.joint_state.name[0]", "'torso'"});
  problem = TinyProblem();
  problem.goal[0].joint = "torso";
  ExpectRefusal(problem, {"request0001.yaml:", "goal_constraints[0]", "'torso'"});
}

TEST(WrongRobot, IsRefusedByTheGroup) {
  Problem problem = TinyProblem();
  problem.group = "legs";
  ExpectRefusal(problem, {"request0001.yaml:1: group_name", "'legs'"});
}

TEST(WrongRobot, IsRefusedByTheLinkOfAnAttachedObject) {
  Problem problem = TinyProblem();
  AttachedObject attached;
  attached.link = "hand";
  attached.object = problem.scene.objects[0];
  attached.object.id = "cup";
  problem.scene.attached.push_back(attached);
  ExpectRefusal(problem, {"scene0001.yaml:", "attached_collision_objects[0].link_name", "'hand'"});
}

TEST(PublishedSets, AllProblemsFitTheFetch) {
  PLANBENCH_NEED_SHARED_DATA("problems");
  SceneService service(LoadRobot(fs::path(PLANBENCH_SOURCE_DIR) / "robots/fetch"), std::nullopt,
                       {SharedData("problems/bookshelf_small_fetch"),
                        SharedData("problems/box_fetch"), SharedData("problems/table_pick_fetch")});
  const ProblemSetsMessage sets = service.ProblemSets("server");
  ASSERT_EQ(sets.sets.size(), 3u);
  for (const ProblemSetSummary& set : sets.sets) {
    EXPECT_EQ(set.indices.size(), 100u);
    for (const int index : {1, 50, 100}) {
      const ProblemMessage problem = service.AnswerProblem({"id", set.name, index}).problem;
      EXPECT_TRUE(problem.ok) << problem.message;
      EXPECT_EQ(problem.start.names.size(), 15u);
    }
  }
}

}  // namespace
}  // namespace planbench
