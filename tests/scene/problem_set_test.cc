#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "common/error.h"
#include "scene/problem.h"
#include "tests/support/expect_input_error.h"

namespace planbench {
namespace {
namespace fs = std::filesystem;

class ProblemSetFolder : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(parent_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(parent_); }
  void Touch(const std::string& name) { std::ofstream(folder_ / name) << "x: 1\n"; }
  std::string Error() {
    try {
      ListProblemSet(folder_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path parent_ =
      fs::path(testing::TempDir()) /
      (std::string("planbench_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  fs::path folder_ = parent_ / "my_set";
};

TEST_F(ProblemSetFolder, ListsPairsByIndex) {
  for (const char* name : {"scene0010.yaml", "request0010.yaml", "request0002.yaml",
                           "scene0002.yaml", "scene123456.yaml", "request123456.yaml",
                           "path0002.yaml", "config.yaml", "scene0003.yaml.orig", "scene.yaml"}) {
    Touch(name);
  }
  const ProblemSet set = ListProblemSet(folder_);
  EXPECT_EQ(set.name, "my_set");
  ASSERT_EQ(set.problems.size(), 3);
  EXPECT_EQ(set.problems[0].index, 2);
  EXPECT_EQ(set.problems[1].index, 10);
  EXPECT_EQ(set.problems[2].index, 123456);
  EXPECT_EQ(set.problems[1].scene, folder_ / "scene0010.yaml");
  ASSERT_NE(set.Find(10), nullptr);
  EXPECT_EQ(set.Find(10)->request, folder_ / "request0010.yaml");
  EXPECT_EQ(set.Find(3), nullptr);
  EXPECT_EQ(set.Find(999999), nullptr);
  EXPECT_EQ(ListProblemSet(folder_ / "").name, "my_set");
  EXPECT_EQ(ListProblemSet(folder_ / ".").name, "my_set");
}

TEST_F(ProblemSetFolder, YamlFilesMayEndInYml) {
  for (const char* name : {"scene1.yml", "request1.yaml", "scene2.yml"}) Touch(name);
  const ProblemSet set = ListProblemSet(folder_);
  ASSERT_EQ(set.problems.size(), 2);
  EXPECT_EQ(set.problems[0].scene, folder_ / "scene1.yml");
  EXPECT_EQ(set.problems[0].request, folder_ / "request1.yaml");
  EXPECT_EQ(set.problems[1].request, folder_ / "request2.yml");
  Touch("scene0001.yaml");
  EXPECT_THAT(Error(), testing::HasSubstr("have the same number"));
}

TEST_F(ProblemSetFolder, MissingFolder) {
  fs::remove_all(folder_);
  EXPECT_THAT(Error(), testing::HasSubstr(folder_.string()));
}

TEST_F(ProblemSetFolder, LinkToNowhere) {
  fs::create_directory_symlink(parent_ / "gone", parent_ / "link");
  ExpectInputError(
      [&] { ListProblemSet(parent_ / "link"); },
      {"link: is a link to '", "gone', which cannot be followed: No such file or directory"});
}

TEST_F(ProblemSetFolder, WhatCannotBeLookedAtIsNotCalledMissing) {
  const std::string unlikely(300, 'x');  // a name longer than any file's
  ExpectInputError([&] { ListProblemSet(parent_ / unlikely); }, {"File name too long"});
  Touch("scene1.yaml");
  ExpectInputError([&] { RequireProblemFiles(folder_ / "scene1.yaml", folder_ / unlikely); },
                   {"File name too long"});
}

TEST_F(ProblemSetFolder, ItsNameIsOneLineOfText) {
  Touch("scene1.yaml");
  for (const char* name : {"a\tb", "a\nb"}) {
    fs::remove_all(parent_ / name);
    fs::copy(folder_, parent_ / name);
    ExpectInputError([&] { ListProblemSet(parent_ / name); },
                     {": its name must be one line without tabs"});
  }
}

TEST_F(ProblemSetFolder, EmptyFolder) {
  EXPECT_THAT(Error(), testing::HasSubstr("holds no problems (pairs of sceneNNNN.yaml and "
                                          "requestNNNN.yaml, or .yml)"));
}

TEST_F(ProblemSetFolder, ListsProblemsThatLackAFile) {
  Touch("scene01.yaml");
  Touch("request0002.yaml");
  const ProblemSet set = ListProblemSet(folder_);
  ASSERT_EQ(set.problems.size(), 2);
  EXPECT_EQ(set.problems[0].request, folder_ / "request01.yaml");
  EXPECT_EQ(set.problems[1].scene, folder_ / "scene0002.yaml");
}

TEST_F(ProblemSetFolder, OnlyFilesAreProblemFiles) {
  Touch("scene1.yaml");
  const fs::path scene = folder_ / "scene1.yaml";
  const fs::path request = folder_ / "request1.yaml";
  ExpectInputError([&] { RequireProblemFiles(scene, request); }, {"request1.yaml: is missing"});
  fs::create_symlink(folder_ / "nowhere", request);
  ExpectInputError(
      [&] { RequireProblemFiles(scene, request); },
      {"request1.yaml: is a link to '", "nowhere', which cannot be followed: No such file"});
  fs::remove(request);
  ASSERT_EQ(mkfifo(request.c_str(), 0600), 0);
  ExpectInputError([&] { RequireProblemFiles(scene, request); }, {"request1.yaml: is no file"});
  fs::remove(request);
  fs::create_directory(request);
  ExpectInputError([&] { RequireProblemFiles(scene, request); }, {"request1.yaml: is no file"});
  fs::remove(request);
  Touch("request1.yaml");
  RequireProblemFiles(scene, request);
}

TEST_F(ProblemSetFolder, SameNumberTwice) {
  for (const char* name : {"scene1.yaml", "scene0001.yaml", "request1.yaml"}) Touch(name);
  EXPECT_THAT(Error(), testing::HasSubstr("have the same number"));
}

TEST_F(ProblemSetFolder, NumberTooLarge) {
  Touch("scene99999999999999999999.yaml");
  EXPECT_THAT(Error(), testing::HasSubstr("too large"));
}

}  // namespace
}  // namespace planbench
