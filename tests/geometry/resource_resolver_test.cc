#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geometry/mesh_loader.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

class ResourceResolverTest : public testing::Test {
 protected:
  ResourceResolverTest() {
    folder_.Write("robot/meshes/own.stl", "own");
    folder_.Write("other/meshes/theirs.stl", "theirs");
    resolver_ = {folder_.path() / "robot", {{"other_package", folder_.path() / "other"}}};
  }

  TemporaryFolder folder_;
  ResourceResolver resolver_;
};

TEST_F(ResourceResolverTest, FindsFilesOfGivenPackages) {
  EXPECT_EQ(resolver_.Resolve("package://other_package/meshes/theirs.stl"),
            folder_.path() / "other/meshes/theirs.stl");
}

TEST_F(ResourceResolverTest, PackagesAreFoldersOfTheirNameAround) {
  const fs::path own = folder_.path() / "robot/meshes/own.stl";
  EXPECT_EQ(resolver_.Resolve("package://robot/meshes/own.stl"), own);
  EXPECT_EQ(resolver_.Resolve("package://robot//meshes/own.stl"), own);
  EXPECT_EQ(resolver_.Resolve("package://meshes/own.stl"), own);
  EXPECT_EQ(resolver_.Resolve("package://other/meshes/theirs.stl"),
            folder_.path() / "other/meshes/theirs.stl");
  const ResourceResolver deeper{folder_.path() / "robot/urdf/real", {}};
  EXPECT_EQ(deeper.Resolve("package://robot/meshes/own.stl"), own);
  EXPECT_EQ(deeper.Resolve("package://other/meshes/theirs.stl"),
            folder_.path() / "other/meshes/theirs.stl");
}

TEST_F(ResourceResolverTest, AFileOfTheSamePathInAnotherPackageIsNotTaken) {
  for (const char* uri :
       {"package://somewhere_description/meshes/own.stl", "package://robo/meshes/own.stl"}) {
    ExpectInputError([&] { resolver_.Resolve(uri); }, {uri, "no folder of package"});
  }
  ExpectInputError([&] { resolver_.Resolve("package://other/meshes/own.stl"); },
                   {(folder_.path() / "other/meshes/own.stl").string()});
}

TEST_F(ResourceResolverTest, AGivenPackageIsNotLookedForInTheBaseFolder) {
  ExpectInputError([&] { resolver_.Resolve("package://other_package/meshes/own.stl"); },
                   {"package://other_package/meshes/own.stl",
                    (folder_.path() / "other/meshes/own.stl").string()});
}

TEST_F(ResourceResolverTest, TakesFileUrisAbsoluteAndRelativePaths) {
  const fs::path own = folder_.path() / "robot/meshes/own.stl";
  EXPECT_EQ(resolver_.Resolve("file://" + own.string()), own);
  EXPECT_EQ(resolver_.Resolve("file:" + own.string()), own);
  EXPECT_EQ(resolver_.Resolve(own.string()), own);
  EXPECT_EQ(resolver_.Resolve("meshes/own.stl"), own);
}

TEST_F(ResourceResolverTest, RelativePathsBeginInTheFolderOfTheFileThatNamesThem) {
  folder_.Write("robot/urdf/meshes/near.stl", "");
  resolver_.own_folder = folder_.path() / "robot/urdf";
  EXPECT_EQ(resolver_.Resolve("meshes/near.stl"), resolver_.own_folder / "meshes/near.stl");
  EXPECT_EQ(resolver_.Resolve("../meshes/own.stl"), resolver_.own_folder / "../meshes/own.stl");
  EXPECT_EQ(resolver_.Resolve("meshes/own.stl"), resolver_.base_folder / "meshes/own.stl");
  ExpectInputError([&] { resolver_.Resolve("none.stl"); },
                   {"robot/urdf/none.stl, nor ", "robot/none.stl"});
}

TEST_F(ResourceResolverTest, UrisMayWriteCharactersInPercent) {
  const fs::path spaced = folder_.Write("robot/meshes/sp\xc3\xa4t er.stl", "own");
  const fs::path literal = folder_.Write("robot/meshes/100%25.stl", "own");
  const std::string folder = (folder_.path() / "robot").string();
  EXPECT_EQ(resolver_.Resolve("file://" + folder + "/meshes/sp%C3%a4t%20er.stl"), spaced);
  EXPECT_EQ(resolver_.Resolve("package://robot/meshes/sp%c3%A4t%20er.stl"), spaced);
  EXPECT_EQ(resolver_.Resolve("package://robot/meshes/100%25.stl"), literal);
  EXPECT_EQ(resolver_.Resolve("meshes/100%25.stl"), literal);
  EXPECT_EQ(resolver_.Resolve("file://LocalHost" + folder + "/meshes/sp%C3%a4t%20er.stl"), spaced);
  EXPECT_EQ(resolver_.Resolve("meshes/sp%C3%A4t%20er.stl"), spaced);
  EXPECT_EQ(resolver_.Resolve(folder + "/meshes/sp%C3%A4t%20er.stl"), spaced);
  // Of two that a name may stand for, a URI names the decoded, a path the one that is so called.
  const fs::path decoded = folder_.Write("robot/meshes/100%.stl", "own");
  EXPECT_EQ(resolver_.Resolve("package://robot/meshes/100%25.stl"), decoded);
  EXPECT_EQ(resolver_.Resolve("meshes/100%25.stl"), literal);
  // What is no code stays what it is.
  for (const char* uri : {"meshes/sp%C3%A4t%20.stl", "package://robot/meshes/a%2.stl",
                          "package://robot/meshes/a%xy.stl", "package://robot/meshes/a%"}) {
    ExpectInputError([&] { resolver_.Resolve(uri); }, {uri, "no file"});
  }
}

TEST_F(ResourceResolverTest, SaysWhatItTriedAndHowToMendIt) {
  ExpectInputError([&] { resolver_.Resolve("package://lost/meshes/a.stl"); },
                   {"package://lost/meshes/a.stl", (folder_.path() / "robot").string(),
                    "--package-path lost=DIR"});
  ExpectInputError([&] { resolver_.Resolve("meshes/a.stl"); }, {"meshes/a.stl", "no file"});
  ExpectInputError([&] { resolver_.Resolve("meshes"); }, {"meshes", "no file"});  // A folder.
  ExpectInputError([&] { resolver_.Resolve("http://host/a.stl"); }, {"http://host/a.stl"});
  for (const char* uri : {"package:/robot/meshes/own.stl", "PACKAGE://robot/meshes/own.stl",
                          "File:///meshes/own.stl"}) {
    ExpectInputError([&] { resolver_.Resolve(uri); },
                     {uri, "package://NAME/path", "file:///FOLDER/FILE", "lower case"});
  }
  ExpectInputError([&] { resolver_.Resolve("file://meshes/own.stl"); },
                   {"file://meshes/own.stl", "machine 'meshes'", "file:///"});
  ExpectInputError([&] { resolver_.Resolve("package://lost"); }, {"package://NAME/path"});
  ExpectInputError([&] { resolver_.Resolve("package:///a.stl"); }, {"package://NAME/path"});
  ExpectInputError([&] { resolver_.Resolve(""); }, {"empty"});
}

TEST_F(ResourceResolverTest, ParsesPackagePaths) {
  const std::string folder = (folder_.path() / "other").string();
  const std::map<std::string, fs::path> my_package = {{"my_package", folder}};
  EXPECT_EQ(ParsePackagePaths({"my_package=" + folder, "my_package=" + folder + "/"}), my_package);
  const std::vector<std::string> malformed = {"my_package", "=" + folder, "my_package=", folder};
  for (const std::string& bad : malformed) {
    ExpectInputError([&] { ParsePackagePaths({bad}); }, {"--package-path", bad, "NAME=DIR"});
  }
  ExpectInputError([&] { ParsePackagePaths({"a=" + folder + "/nowhere"}); },
                   {"no folder", "nowhere"});
  ExpectInputError([&] { ParsePackagePaths({"a/b=" + folder}); }, {"a/b", "no '/'"});
  ExpectInputError(
      [&] {
        ParsePackagePaths({"a=" + folder, "a=" + folder + "/meshes"});
      },
      {"--package-path 'a=" + folder + "/meshes'", "a is given as " + folder});
}

}  // namespace
}  // namespace planbench
