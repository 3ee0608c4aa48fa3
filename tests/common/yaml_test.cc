#include "common/yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "common/error.h"

namespace planbench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

YamlNode Parse(const std::string& text) { return YamlNode::Parse(text, "file.yaml"); }

// The message of the InputError that `run` throws.
std::string ErrorOf(const std::function<void()>& run) {
  try {
    run();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(YamlNode, ReadsValuesOfEveryKind) {
  const YamlNode node = Parse("a: 1.5\nb: 3\nc: yes\nd: text\ne: [1, 2e3]\nf: [x, y]\ng: {h: 1}\n");
  EXPECT_EQ(node.At("a").Double(), 1.5);
  EXPECT_EQ(node.At("b").Int(), 3);
  EXPECT_EQ(node.At("b").Double(), 3);
  EXPECT_TRUE(node.At("c").Bool());
  EXPECT_EQ(node.At("d").String(), "text");
  EXPECT_THAT(node.At("e").Doubles(), ElementsAre(1, 2000));
  EXPECT_THAT(node.At("f").Strings(), ElementsAre("x", "y"));
  EXPECT_EQ(node.At("g").At("h").Int(), 1);
  EXPECT_THAT(node.Keys(), ElementsAre("a", "b", "c", "d", "e", "f", "g"));
  EXPECT_EQ(node.At("e").At(1).Where(), "file.yaml:5: e[1]");
}

TEST(YamlNode, NumbersAreExactAndDecimal) {
  EXPECT_EQ(Parse("0.1").Double(), 0.1);
  EXPECT_EQ(Parse("+1.0").Double(), 1);
  EXPECT_EQ(Parse("-3e-07").Double(), -3e-07);
  EXPECT_EQ(Parse("1.7976931348623157e308").Double(), 1.7976931348623157e308);
  EXPECT_EQ(Parse("010").Int(), 10);
  EXPECT_EQ(Parse("-9223372036854775808").Int(), -9223372036854775807LL - 1);
  for (const char* text :
       {"1,5", "1.0x", "0.1robot", "", "x", "[1]", "{a: 1}", "--1", "+-1", "1 2", "1e999"}) {
    EXPECT_THROW(Parse(text).Double(), InputError) << text;
  }
  for (const char* text : {"1.0", "1e3", "9223372036854775808", "x", ""}) {
    EXPECT_THROW(Parse(text).Int(), InputError) << text;
  }
}

TEST(YamlNode, NonFiniteNumbersAreErrors) {
  for (const char* text : {".nan", ".NaN", "nan", ".inf", "-.inf", "inf"}) {
    EXPECT_THAT(ErrorOf([&] { Parse(text).Double(); }), HasSubstr("expected a finite number"))
        << text;
  }
  EXPECT_THAT(ErrorOf([] { Parse("0").PositiveDouble(); }), HasSubstr("greater than zero"));
}

TEST(YamlNode, ErrorsNameFileLineAndField) {
  const YamlNode node = Parse("a:\n  b:\n    - 1\n    - {c: x}\n");
  const YamlNode c = node.At("a").At("b").At(1).At("c");
  EXPECT_EQ(ErrorOf([&] { c.Double(); }), "file.yaml:4: a.b[1].c: expected a number, found 'x'");
  EXPECT_EQ(ErrorOf([&] { c.Bool(); }), "file.yaml:4: a.b[1].c: expected true or false, found 'x'");
  EXPECT_EQ(ErrorOf([&] { c.At("d"); }),
            "file.yaml:4: a.b[1].c: expected a map with the field 'd', found 'x'");
  EXPECT_EQ(ErrorOf([&] { c.Elements(); }),
            "file.yaml:4: a.b[1].c: expected a sequence, found 'x'");
  EXPECT_EQ(ErrorOf([&] { node.At("a").At("z"); }), "file.yaml:2: a: the field 'z' is missing");
  EXPECT_EQ(ErrorOf([&] { node.At("a").At("b").At(2); }), "file.yaml:3: a.b: element 2 is missing");
  EXPECT_EQ(ErrorOf([&] { node.At("a").At("b").String(); }),
            "file.yaml:3: a.b: expected text, found a sequence");
  EXPECT_EQ(ErrorOf([&] { node.At("a").At("b").Doubles(3); }),
            "file.yaml:3: a.b: expected 3 numbers, found 2");
}

TEST(YamlNode, SyntaxErrorsNameTheLine) {
  EXPECT_THAT(ErrorOf([] { Parse("a: 1\nb: [1, 2\n"); }), StartsWith("file.yaml:"));
  EXPECT_THAT(ErrorOf([] { Parse("a: 1\nb: c: d\n"); }), StartsWith("file.yaml:2: "));
  EXPECT_THAT(ErrorOf([] { Parse("a: 1\n---\nb: 2\n"); }),
              StartsWith("file.yaml:3: a second YAML document"));
  EXPECT_THROW(Parse(std::string(100000, '[')), InputError);
}

TEST(YamlNode, AbsentAndNullAreTheSame) {
  const YamlNode node = Parse("a: ~\nb:\nc: 0\n");
  EXPECT_FALSE(node.Find("a"));
  EXPECT_FALSE(node.Find("b"));
  EXPECT_FALSE(node.Find("z"));
  EXPECT_TRUE(node.Find("c"));
  EXPECT_THAT(ErrorOf([&] { node.At("b"); }), HasSubstr("'b' is missing"));
  EXPECT_EQ(node.DoubleOr("a", 2), 2);
  EXPECT_EQ(node.DoubleOr("c", 2), 0);
  EXPECT_EQ(node.IntOr("z", 7), 7);
  EXPECT_EQ(node.BoolOr("z", true), true);
  EXPECT_EQ(node.StringOr("b", "x"), "x");
  EXPECT_TRUE(Parse("").IsNull());
  EXPECT_FALSE(Parse("").Find("a"));
  EXPECT_TRUE(Parse("").Keys().empty());
}

TEST(YamlNode, KeysThatOccurTwiceAreErrors) {
  const YamlNode node = Parse("a: 1\nb: 2\na: 3\n");
  EXPECT_EQ(ErrorOf([&] { node.Find("a"); }), "file.yaml:3: a: the key 'a' occurs twice");
  EXPECT_EQ(ErrorOf([&] {
              node.AllowOnly({"a", "b"});
            }),
            "file.yaml:3: a: the key 'a' occurs twice");
  EXPECT_EQ(node.At("b").Int(), 2);
}

TEST(YamlNode, AllowOnlyNamesTheUnknownKey) {
  const YamlNode node = Parse("x:\n  range: 1\n  rnage: 2\n");
  EXPECT_NO_THROW(node.At("x").AllowOnly({"range", "rnage"}));
  EXPECT_EQ(ErrorOf([&] {
              node.At("x").AllowOnly({"range", "seed"});
            }),
            "file.yaml:3: x.rnage: unknown key 'rnage'; known are: range, seed");
  EXPECT_THROW(Parse("[1]").AllowOnly({"a"}), InputError);
  EXPECT_NO_THROW(Parse("").AllowOnly({"a"}));
}

TEST(YamlNode, OverrideReplacesAndAdds) {
  YamlNode node = Parse("range: 1\nseed: 2\n");
  node.Override("range", "2.5", "--set range");
  node.Override("name", "[a, b]", "--set name");
  EXPECT_EQ(node.At("range").Double(), 2.5);
  EXPECT_EQ(node.At("seed").Int(), 2);
  EXPECT_THAT(node.At("name").Strings(), ElementsAre("a", "b"));
  EXPECT_THAT(node.Keys(), ElementsAre("range", "seed", "name"));
  node.Override("seed", "~", "--set seed");
  EXPECT_EQ(node.IntOr("seed", 9), 9);
}

TEST(YamlNode, OverrideErrorsNameTheirOrigin) {
  YamlNode node = Parse("range: 1\n");
  node.Override("range", "far", "--set range");
  node.Override("rnage", "1", "--set rnage");
  EXPECT_EQ(ErrorOf([&] { node.At("range").Double(); }),
            "--set range: range: expected a number, found 'far'");
  EXPECT_EQ(ErrorOf([&] { node.AllowOnly({"range"}); }),
            "--set rnage: rnage: unknown key 'rnage'; known are: range");
  EXPECT_THAT(ErrorOf([&] { node.Override("range", "[1", "--set range"); }),
              StartsWith("--set range"));
  YamlNode scalar = Parse("x");
  EXPECT_THROW(scalar.Override("a", "1", "--set a"), InputError);
}

TEST(YamlNode, OverrideWorksOnAnEmptyFileAndLeavesCopiesAlone) {
  YamlNode node = Parse("");
  const YamlNode before = node;
  node.Override("a", "1", "--set a");
  EXPECT_TRUE(node.IsMap());
  EXPECT_EQ(node.At("a").Int(), 1);
  EXPECT_FALSE(before.Find("a"));

  const YamlNode base = Parse("a: 1\n");
  YamlNode changed = base;
  changed.Override("a", "2", "--set a");
  EXPECT_EQ(base.At("a").Int(), 1);
  EXPECT_EQ(changed.At("a").Int(), 2);
}

TEST(YamlNode, LoadFileNamesThePath) {
  EXPECT_EQ(ErrorOf([] { YamlNode::LoadFile("/nonexistent/x.yaml"); }),
            "/nonexistent/x.yaml: cannot be opened");
  EXPECT_THROW(YamlNode::LoadFile(testing::TempDir()), InputError) << "a folder";
  const auto path = std::filesystem::path(testing::TempDir()) / "planbench_yaml_test.yaml";
  std::ofstream(path) << "a: 1\nb: x";
  EXPECT_EQ(ErrorOf([&] { YamlNode::LoadFile(path.string()).At("b").Int(); }),
            path.string() + ":2: b: expected an integer, found 'x'");
  std::ofstream(path) << "";
  EXPECT_TRUE(YamlNode::LoadFile(path.string()).IsNull());
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace planbench
