#include "common/yaml.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include "common/error.h"
#include "common/numbers.h"

namespace planbench {
namespace {

using testing::AllOf;
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

TEST(YamlNode, NumbersThatCannotBeRepresentedAreToldAsSuch) {
  for (const std::string text : {"1e400", "-1e400", "1e-400", "!degrees 1e400"}) {
    EXPECT_THAT(ErrorOf([&] { Parse(text).Double(); }),
                HasSubstr(text.substr(text.find("1e")) + "' cannot be represented"))
        << text;
  }
  EXPECT_THAT(ErrorOf([] { Parse("9223372036854775808").Int(); }),
              HasSubstr("'9223372036854775808' cannot be represented"));
}

TEST(YamlNode, NonFiniteNumbersAreErrors) {
  for (const char* text : {".nan", ".NaN", "nan", ".inf", "-.inf", "inf"}) {
    EXPECT_THAT(ErrorOf([&] { Parse(text).Double(); }), HasSubstr("expected a finite number"))
        << text;
  }
}

TEST(YamlNode, NumbersBeyondLimitsAreErrors) {
  EXPECT_THAT(ErrorOf([] { Parse("0").PositiveDouble(); }), HasSubstr("greater than zero"));
  EXPECT_EQ(ErrorOf([] { Parse("-1e-6").NonNegativeDouble(); }),
            "file.yaml:1: must not be negative, found '-1e-6'");
  EXPECT_EQ(Parse("0").NonNegativeDouble(), 0);
  EXPECT_EQ(ErrorOf([] { Parse("0").IntWithin(1, 9); }),
            "file.yaml:1: must be from 1 to 9, found 0");
  EXPECT_EQ(Parse("9").IntWithin(1, 9), 9);
  EXPECT_EQ(Parse("1e-6").DoubleWithin(1e-6, 1), 1e-6);
  for (const char* text : {"1e-7", "1e300", "-1"}) {
    EXPECT_THAT(ErrorOf([&] { Parse(text).DoubleWithin(1e-6, 1); }),
                HasSubstr("must be from 1e-06 to 1, found "));
  }
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

TEST(YamlNode, ControlCharactersAreRefused) {
  const YamlNode node = Parse("a: \"x\\e[2Jy\"\nb: \"\\x7f\"\nc: \"one\\ttwo\\nthree\"\n");
  EXPECT_THAT(ErrorOf([&] { node.At("a").String(); }),
              AllOf(StartsWith("file.yaml:1: a: a control character"), HasSubstr("\\x1b[2J")));
  EXPECT_THAT(ErrorOf([&] { node.At("b").String(); }), HasSubstr("file.yaml:2: b:"));
  EXPECT_EQ(node.At("c").String(), "one\ttwo\nthree");
  EXPECT_THAT(ErrorOf([] { Parse("a: x\xe2\x80\xaey").At("a").String(); }),
              HasSubstr("control character"));
  EXPECT_THAT(ErrorOf([] { Parse("\"k\\x01\": 1").Keys(); }), HasSubstr("control character"));
}

TEST(YamlNode, SyntaxErrorsNameTheLine) {
  EXPECT_THAT(ErrorOf([] { Parse("a: 1\nb: [1, 2\n"); }), StartsWith("file.yaml:"));
  EXPECT_THAT(ErrorOf([] { Parse("a: 1\nb: c: d\n"); }), StartsWith("file.yaml:2: "));
  EXPECT_THAT(ErrorOf([] { Parse("a: 1\n---\nb: 2\n"); }),
              StartsWith("file.yaml:3: a second YAML document"));
  EXPECT_EQ(ErrorOf([] { Parse("\n" + std::string(100000, '[')); }),
            "file.yaml:2: is nested too deep");
}

TEST(YamlNode, TextsThatWereCutOffAreRefusedAtTheirLastLine) {
  for (const char* text : {"a: 1\nb: \"cut here\n", "a: 1\nb: \"cut here", "a: 1\nb: 'cut here\n\n",
                           "a: 1\nb: &x \"cut \\\"\n", "a: 1\nb: !!str 'cut ''\n  ", "a: 1\n\"b\n",
                           "a: 1\nb", "a: 1\nb\n", "a: 1\nb  # no colon\n", "a: 1\n'b'\n\n"}) {
    EXPECT_THAT(ErrorOf([&] { Parse(text); }), StartsWith("file.yaml:2: no valid YAML: ")) << text;
  }
  for (const char* text : {"a: 1\nb", "a: 1\nb\n---\n", "a: 1\nb\n...\n", "a: 1\n&x b\n---\nc: 2\n",
                           "- a: 1\n  b\n---\n", "x: {}\nb\n%YAML 1.2\n---\n"}) {
    EXPECT_EQ(ErrorOf([&] { Parse(text); }), "file.yaml:2: no valid YAML: a key without its colon")
        << text;
  }
  for (const char* text : {"a: 1\n  b\n", "a:\n  b", "{a}", "? a", "? a\n", "? a\n---\n", "a:", "a",
                           "a: \"b\"", "a: |\n  b\n", "a: b # c", "# a", "\n"}) {
    EXPECT_EQ(ErrorOf([&] { Parse(text); }), "no error") << text;
  }
  EXPECT_EQ(Parse("a: |+\n  b\n\n").At("a").String(), "b\n\n");
}

// yaml-cpp would read documents until the memory is full.
TEST(YamlNode, BracketsThatCloseNothingAreSyntaxErrors) {
  for (const char* text : {"a: 1\n}", "a: 1\n]", "{a: 1}\n}\n"}) {
    EXPECT_THAT(ErrorOf([&] { Parse(text); }), HasSubstr("no valid YAML")) << text;
  }
  EXPECT_THAT(ErrorOf([] { Parse("a: 1\n}"); }), StartsWith("file.yaml:2: no valid YAML"));
}

TEST(YamlNode, AbsentAndNullAreTheSame) {
  const YamlNode node = Parse("a: ~\nb:\nc: 0\n");
  EXPECT_FALSE(node.Find("a"));
  EXPECT_FALSE(node.Find("b"));
  EXPECT_FALSE(node.Find("z"));
  EXPECT_TRUE(node.Find("c"));
  EXPECT_EQ(ErrorOf([&] { node.At("a"); }), "file.yaml:1: a: the field 'a' has no value");
  EXPECT_EQ(ErrorOf([&] { node.At("b"); }), "file.yaml:2: b: the field 'b' has no value");
  EXPECT_EQ(ErrorOf([&] { node.At("z"); }), "file.yaml:1: the field 'z' is missing");
  EXPECT_EQ(node.DoubleOr("a", 2), 2);
  EXPECT_EQ(node.DoubleOr("c", 2), 0);
  EXPECT_EQ(node.BoolOr("z", true), true);
  EXPECT_EQ(node.StringOr("b", "x"), "x");
  EXPECT_EQ(ErrorOf([&] { node.RequireValues(); }), "file.yaml:1: a: the field 'a' has no value");
  EXPECT_NO_THROW(Parse("a: ''").RequireValues());
  EXPECT_NO_THROW(Parse("").RequireValues());
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
  EXPECT_EQ(
      ErrorOf([&] {
        node.At("x").AllowOnly({"range", "seed"});
      }),
      "file.yaml:3: x.rnage: unknown key 'rnage'; did you mean 'range'? known are: range, seed");
  EXPECT_EQ(ErrorOf([&] {
              node.At("x").AllowOnly({"range", "seed_of_the_run"});
            }),
            "file.yaml:3: x.rnage: unknown key 'rnage'; did you mean 'range'? known are: range, "
            "seed_of_the_run");
  EXPECT_EQ(
      ErrorOf([&] {
        node.At("x").AllowOnly({"speed", "rnage"});
      }),
      "file.yaml:2: x.range: unknown key 'range'; did you mean 'rnage'? known are: speed, rnage");
  EXPECT_NO_THROW(node.AllowOnly({"x*"}));
  EXPECT_NO_THROW(node.At("x").AllowOnly({"range", "r*"}));
  EXPECT_THROW(node.At("x").AllowOnly({"range", "x-*"}), InputError);
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
  EXPECT_FALSE(node.Find("seed"));
  EXPECT_EQ(ErrorOf([&] { node.At("seed"); }), "--set seed: the field 'seed' has no value");
}

TEST(YamlNode, OverrideErrorsNameTheirOrigin) {
  YamlNode node = Parse("range: 1\n");
  node.Override("range", "far", "--set range");
  node.Override("rnage", "1", "--set rnage");
  EXPECT_EQ(ErrorOf([&] { node.At("range").Double(); }),
            "--set range: expected a number, found 'far'");
  EXPECT_EQ(ErrorOf([&] { node.AllowOnly({"range"}); }),
            "--set rnage: unknown key 'rnage'; did you mean 'range'? known are: range");
  node.Override("range", "[1, far]", "x.yaml:3: set.range");
  EXPECT_EQ(ErrorOf([&] { node.At("range").Doubles(); }),
            "x.yaml:3: set.range[1]: expected a number, found 'far'");
  EXPECT_EQ(ErrorOf([&] {
              node.Override("ompl", "{goal: x}", "--set ompl");
              node.At("ompl").At("goal").Double();
            }),
            "--set ompl.goal: expected a number, found 'x'");
  EXPECT_THAT(ErrorOf([&] { node.Override("range", "[1", "--set range"); }),
              StartsWith("--set range"));
  YamlNode scalar = Parse("x");
  EXPECT_THROW(scalar.Override("a", "1", "--set a"), InputError);
}

TEST(YamlNode, OverrideDescendsAtDots) {
  YamlNode node = Parse("ompl: {goal_bias: 0.05, range: 1}\na.b: 1\n");
  node.Override("ompl.goal_bias", "0.1", "--set ompl.goal_bias");
  node.Override("ompl.delay", "2", "--set ompl.delay");
  node.Override("a.b", "3", "--set a.b");
  node.Override("joints.torso.lift", "4", "--set joints.torso.lift");
  EXPECT_THAT(node.Keys(), ElementsAre("ompl", "a.b", "joints"));
  EXPECT_THAT(node.At("ompl").Keys(), ElementsAre("goal_bias", "range", "delay"));
  EXPECT_EQ(node.At("ompl").At("goal_bias").Double(), 0.1);
  EXPECT_EQ(node.At("ompl").At("range").Double(), 1);
  EXPECT_EQ(node.At("ompl").At("delay").Int(), 2);
  EXPECT_EQ(node.At("a.b").Int(), 3) << "a key of that very name";
  EXPECT_EQ(node.At("joints").At("torso").At("lift").Int(), 4);

  node.Override("ompl.goal_bias", "~", "--set ompl.goal_bias");
  EXPECT_FALSE(node.At("ompl").Find("goal_bias"));
  node.Override("ompl", "{goal_bias: 0.2}", "--set ompl");
  node.Override("ompl.range", "far", "--set ompl.range");
  EXPECT_THAT(node.At("ompl").Keys(), ElementsAre("goal_bias", "range"));
  EXPECT_EQ(ErrorOf([&] { node.At("ompl").At("range").Double(); }),
            "--set ompl.range: expected a number, found 'far'");
}

TEST(YamlNode, OverrideDescendsIntoMapsOnly) {
  YamlNode node = Parse("range: 1\n");
  EXPECT_EQ(ErrorOf([&] { node.Override("range.x", "1", "--set range.x"); }),
            "--set range.x: file.yaml:1: range: expected a map, found '1'");
  node.Override("seed.x", "1", "--set seed.x");
  EXPECT_EQ(ErrorOf([&] { node.AllowOnly({"range"}); }),
            "--set seed.x: seed: unknown key 'seed'; known are: range");
  EXPECT_EQ(ErrorOf([&] { node.At("seed").Int(); }),
            "--set seed.x: seed: expected an integer, found a map");
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

TEST(YamlNode, EmptyDocumentsAroundTheOneDoNotCount) {
  for (const char* text : {"a: 1\n---\n", "---\na: 1\n---\n", "--- \na: 1\n...\n", "a: 1\n---",
                           "a: 1\n---\n\n# no more\n", "---\n---\na: 1\n", "a: 1\n---\n---\n"}) {
    EXPECT_EQ(Parse(text).At("a").Int(), 1) << text;
  }
  EXPECT_TRUE(Parse("---\n---\n").IsNull());
  EXPECT_THAT(ErrorOf([] { Parse("a: 1\n---\n\n---\nb: 2\n---\n"); }),
              StartsWith("file.yaml:5: a second YAML document"));
}

TEST(YamlNode, MergeKeysAddWhatAMapDoesNotSay) {
  const YamlNode node = Parse(R"(
base: &base {a: 1, b: 2}
more: &more
  <<: *base
  b: 3
  c: 4
list:
  - <<: *more
    c: 5
  - <<: [{b: 6}, *more]
  - {<<: {d: 7}, a: ~}
  - {"<<": 8}
)");
  const std::vector<YamlNode> list = node.At("list").Elements();
  EXPECT_EQ(list[0].At("a").Int(), 1);
  EXPECT_EQ(list[0].At("b").Int(), 3);
  EXPECT_EQ(list[0].At("c").Int(), 5);
  EXPECT_THAT(list[0].Keys(), ElementsAre("c", "b", "a"));
  EXPECT_EQ(list[1].At("b").Int(), 6) << "earlier maps come first";
  EXPECT_EQ(list[1].At("c").Int(), 4);
  EXPECT_FALSE(list[2].Find("a")) << "nothing is said too";
  EXPECT_EQ(list[2].At("d").Int(), 7);
  EXPECT_EQ(list[3].At("<<").Int(), 8) << "in quotes it is a key";
  EXPECT_NO_THROW(list[0].AllowOnly({"a", "b", "c"}));
  EXPECT_EQ(ErrorOf([&] {
              list[0].AllowOnly({"b", "c"});
            }),
            "file.yaml:2: list[0].a: unknown key 'a'; known are: b, c");
  EXPECT_EQ(ErrorOf([&] { list[0].At("a").Bool(); }),
            "file.yaml:2: list[0].a: expected true or false, found '1'");
}

TEST(YamlNode, MergeKeysMergeMapsOnly) {
  for (const char* text : {"<<: 1", "<<: [a]", "<<: ~", "a: &a {b: 1}\nc: {<<: [*a, 2]}",
                           "a: &a {b: 1}\nc: {<<: [[*a]]}"}) {
    EXPECT_THAT(ErrorOf([&] { Parse(text); }), HasSubstr("merges a map or a sequence of maps"))
        << text;
  }
  EXPECT_THAT(ErrorOf([] { Parse("<<: {a: 1}\n<<: {b: 1}\n").Keys(); }), HasSubstr("twice"));
}

TEST(YamlNode, AliasesAreFollowedOnce) {
  std::string text = "a0: &a0 [x]\n";
  for (int i = 1; i < 60; ++i) {
    const std::string last = std::to_string(i - 1);
    const std::string name = std::to_string(i);
    text.append("a").append(name).append(": &a").append(name);
    text.append(" [*a").append(last).append(", *a").append(last).append("]\n");
  }
  EXPECT_EQ(Parse(text).At("a59").Size(), 2) << "and not 2^60 elements looked at";
}

TEST(YamlNode, NothingContainsItself) {
  for (const char* text :
       {"a: 1\nb: &a [*a]", "a: 1\nb: &a [1, [*a]]", "a: 1\nb: &a {b: *a}",
        "a: 1\nb: &a {? *a : 1}", "a: 1\nb: &a {<<: *a}", "a: 1\nb: &a {<<: {<<: [*a]}}"}) {
    EXPECT_THAT(ErrorOf([&] { Parse(text); }),
                AllOf(StartsWith("file.yaml:2: b"), HasSubstr(": contains itself")))
        << text;
  }
}

TEST(YamlNode, AliasesAreWhatTheirAnchorWasLast) {
  const YamlNode node = Parse("a: &x 1\nb: *x\nc: &x [2]\nd: *x\ne: &y\nf: *y\n? *x\n: 3\n");
  EXPECT_EQ(node.At("b").Int(), 1);
  EXPECT_EQ(node.At("d").At(0).Int(), 2);
  EXPECT_FALSE(node.Find("f"));
  EXPECT_THAT(ErrorOf([&] { node.Keys(); }), HasSubstr("file.yaml:3: a key is not plain text"));
  EXPECT_THAT(ErrorOf([] { Parse("--- &x\n---\na: *x\n"); }), StartsWith("file.yaml:3: no valid"))
      << "anchors end with their document";
}

// Ten ways from each level to the next: 10^30 to the last, and as many keys.
TEST(YamlNode, MapsThatAreMergedOverAndOverAreFollowedOnce) {
  std::string text = "l0: &l0 {name: s, <<: {deep: 1}}\n";
  for (int i = 1; i <= 30; ++i) {
    const std::string last = fmt::format("*l{}", i - 1);
    text += fmt::format("l{0}: &l{0} {{k{0}: {0}, <<: [{1}", i, last);
    for (int k = 1; k < 10; ++k) text += ", " + last;
    text += "]}\n";
  }
  const YamlNode top = Parse(text).At("l30");
  EXPECT_EQ(top.Keys().size(), 32u);
  EXPECT_EQ(top.Keys().back(), "deep");
  EXPECT_EQ(top.At("name").String(), "s");
  EXPECT_EQ(top.At("k1").Int(), 1);
  EXPECT_FALSE(top.Find("k0"));
}

TEST(YamlNode, MergesMayBeChainedAtAnyLength) {
  std::string text = "l0: &l0 {name: s}\n";
  for (int i = 1; i <= 20000; ++i) {
    text += fmt::format("l{0}: &l{0} {{<<: *l{1}}}\n", i, i - 1);
  }
  const YamlNode top = Parse(text).At("l20000");
  EXPECT_EQ(top.At("name").String(), "s");
  EXPECT_THAT(top.Keys(), ElementsAre("name"));
}

TEST(YamlNode, ListsThatWereCutAreRefused) {
  for (const char* text : {"[1, 2, '...']", "[1, 2, ...]"}) {
    const YamlNode list = Parse("a: 1\nlist: " + std::string(text)).At("list");
    for (const std::string& error :
         {ErrorOf([&] { list.Doubles(); }), ErrorOf([&] { list.Doubles(3); }),
          ErrorOf([&] { list.Strings(); }), ErrorOf([&] { list.Bytes(); })}) {
      EXPECT_EQ(error,
                "file.yaml:2: list[2]: the list was cut here by 'ros2 topic echo'; use "
                "--full-length");
    }
  }
  EXPECT_EQ(Parse("a: '...'").At("a").String(), "...");
}

TEST(YamlNode, WhatADumpHasLeftOutIsRefusedAsSuch) {
  for (const char* text :
       {"<array type: float64, length: 3>", "<array type: double[4]>",
        "<sequence type: double, length: 3>", "<string length: 5>", "<string length: <5>>"}) {
    const YamlNode node = Parse("a: 1\nleft_out: '" + std::string(text) + "'").At("left_out");
    for (const std::string& error :
         {ErrorOf([&] { node.Elements(); }), ErrorOf([&] { node.Doubles(3); }),
          ErrorOf([&] { node.Bytes(); }), ErrorOf([&] { node.String(); })}) {
      EXPECT_EQ(error, "file.yaml:2: left_out: was left out of the dump, which says '" +
                           std::string(text) +
                           "'; use 'topic echo' without --noarr, --no-arr, --nostr and --no-str");
    }
  }
  EXPECT_EQ(Parse("<octomap>").String(), "<octomap>");
}

TEST(YamlNode, AnglesInDegreesAndInPartsOfPi) {
  for (const auto& [text, value] : std::map<std::string, double>{{"!degrees 90", kPi / 2},
                                                                 {"deg(90)", kPi / 2},
                                                                 {"!degrees deg( -45 )", -kPi / 4},
                                                                 {"!degrees '180'", kPi},
                                                                 {"!radians 1.5", 1.5},
                                                                 {"!radians pi/2", kPi / 2},
                                                                 {"rad(2*pi/3)", 2 * kPi / 3},
                                                                 {"rad(-pi)", -kPi},
                                                                 {"rad(0.5)", 0.5},
                                                                 {"!!float 90", 90},
                                                                 {"!!int 90", 90},
                                                                 {"!!str 90", 90}}) {
    EXPECT_NEAR(Parse(text).Double(), value, 1e-15) << text;
    EXPECT_NEAR(Parse("[" + text + "]").Doubles(1)[0], value, 1e-15) << text;
  }
  for (const char* text :
       {"pi", "pi/2", "deg(pi)", "!degrees rad(1)", "!radians deg(1)", "deg 90", "!radians pi/0",
        "rad(pi/)", "!degrees ninety", "!!bool 1", "!!binary AQI="}) {
    EXPECT_THROW(Parse(text).Double(), InputError) << text;
  }
  for (const char* sum : {"rad(pi - 1)", "!radians pi - 1"}) {
    EXPECT_THAT(ErrorOf([&] { Parse(sum).Double(); }),
                HasSubstr("expected a number or a product or quotient of such and pi, found '"))
        << sum;
  }
  EXPECT_THAT(ErrorOf([] { Parse("!degrees 90").Int(); }),
              HasSubstr("expected an integer, found the tag '!degrees'"));
  EXPECT_THAT(ErrorOf([] { Parse("!degrees 90").String(); }), HasSubstr("'!degrees'"));
  EXPECT_THAT(ErrorOf([] { Parse("!degrees 1").Bool(); }), HasSubstr("'!degrees'"));
}

TEST(YamlNode, UnknownTagsAreRefusedWhereverTheyStand) {
  for (const char* text :
       {"a: !foo 1", "a: !foo [1]", "a: !foo {b: 1}", "!foo a: 1", "a: !!python/tuple [1]",
        "a: !!int {b: 1}", "a: !!map [1]", "a: {b: [1, {c: !deg 1}]}"}) {
    EXPECT_THAT(ErrorOf([&] { Parse(text); }), HasSubstr("is not known here")) << text;
  }
  EXPECT_EQ(ErrorOf([] { Parse("a: 1\nb: [1, {c: !deg 1}]"); }),
            "file.yaml:2: b[1].c: the tag '!deg' is not known here");
  for (const char* text : {"a: !degrees [1, 2]", "a: !degrees {b: 1}"}) {
    EXPECT_EQ(ErrorOf([&] { Parse(text); }),
              "file.yaml:1: a: the tag '!degrees' is one number's; write it before each");
  }
  const YamlNode node = Parse("a: !!map {b: !!seq [!!str x]}\nc: !!null ''\nd: !!bool yes");
  EXPECT_THAT(node.At("a").At("b").Strings(), ElementsAre("x"));
  EXPECT_FALSE(node.Find("c"));
  EXPECT_TRUE(node.At("d").Bool());
}

TEST(YamlNode, BytesAsNumbersOrBase64) {
  EXPECT_THAT(Parse("[0, -1, 127, -128, 255]").Bytes(), ElementsAre(0, 255, 127, 128, 255));
  EXPECT_THAT(Parse("!!binary |\n  AQID\n  BA==\n").Bytes(), ElementsAre(1, 2, 3, 4));
  EXPECT_TRUE(Parse("[]").Bytes().empty());
  EXPECT_THAT(ErrorOf([] { Parse("[1, 256]").Bytes(); }),
              StartsWith("file.yaml:1: [1]: is no byte"));
  EXPECT_THROW(Parse("[1, x]").Bytes(), InputError);
  EXPECT_THROW(Parse("!!binary '?'").Bytes(), InputError);
  EXPECT_EQ(ErrorOf([] { Parse(std::string(40000, '7')).Bytes(); }),
            "file.yaml:1: expected a sequence of bytes or !!binary, found a text of 40000 "
            "characters");
}

TEST(YamlNode, OtherTextThanUtf8IsRefusedWithItsLine) {
  EXPECT_EQ(ErrorOf([] { Parse("a: 1\nb: caf\xe9\n"); }),
            "file.yaml:2: the byte \\xe9 is no UTF-8; the file must be UTF-8 text");
  EXPECT_THAT(ErrorOf([] { Parse("# \xff\na: 1\n"); }), StartsWith("file.yaml:1: "));
  EXPECT_EQ(ErrorOf([] { Parse(std::string("a: 1\nb\0: 2\n", 11)); }),
            "file.yaml:2: a byte is 0; the file must be UTF-8 text");
  std::string wide;
  for (const char c : std::string("a: 1\n")) wide += {c, '\0'};
  for (const std::string mark : {"", "\xff\xfe"}) {
    EXPECT_EQ(ErrorOf([&] { Parse(mark + wide); }),
              fmt::format("file.yaml: is UTF-16 text; it must be UTF-8: iconv -f UTF-16{} -t UTF-8 "
                          "file.yaml > file.yaml.utf8",
                          mark.empty() ? "LE" : ""));
  }
  EXPECT_EQ(Parse("\xef\xbb\xbf"
                  "a: caf\xc3\xa9\n")
                .At("a")
                .String(),
            "caf\xc3\xa9");
}

TEST(YamlNode, MessagesAreOneShortLineWhateverTheyQuote) {
  const std::string message = ErrorOf([] { Parse("a: \"x\\ny\\e[2J\"\n").At("a").Double(); });
  EXPECT_EQ(message, "file.yaml:1: a: expected a number, found 'x\\ny\\x1b[2J'");
  EXPECT_LT(ErrorOf([] { Parse("a: " + std::string(5000, 'x')).At("a").Int(); }).size(), 100);
  EXPECT_LT(ErrorOf([] { Parse(std::string(900, 'k') + ": 1").At("a").Int(); }).size(), 1200);
}

TEST(YamlNode, WarningsAreKeptWithTheDocument) {
  const YamlNode node = Parse("a: 1\nb: [2]\n");
  EXPECT_TRUE(node.warnings().empty());
  node.At("b").At(0).Warn("is odd");
  node.At("b").At(0).Warn("is odd");
  node.At("a").Warn("is even");
  EXPECT_THAT(node.warnings(), ElementsAre("file.yaml:2: b[0]: is odd", "file.yaml:1: a: is even"));
}

TEST(YamlNode, LoadFileNamesThePath) {
  EXPECT_EQ(ErrorOf([] { YamlNode::LoadFile("/nonexistent/x.yaml"); }),
            "/nonexistent/x.yaml: cannot be opened");
  EXPECT_THAT(ErrorOf([] { YamlNode::LoadFile(testing::TempDir()); }), HasSubstr(": is a folder"));
  EXPECT_EQ(ErrorOf([] { YamlNode::LoadFile("/dev/zero"); }), "/dev/zero: is no file");
  const auto path = std::filesystem::path(testing::TempDir()) / "planbench_yaml_test.yaml";
  std::ofstream(path) << "a: 1\nb: x";
  EXPECT_EQ(ErrorOf([&] { YamlNode::LoadFile(path.string()).At("b").Int(); }),
            path.string() + ":2: b: expected an integer, found 'x'");
  std::ofstream(path) << "";
  EXPECT_TRUE(YamlNode::LoadFile(path.string()).IsNull());
  std::filesystem::remove(path);
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(ErrorOf([&] { YamlNode::LoadFile(path.string()); }), path.string() + ": is no file");
  std::filesystem::remove(path);
}

TEST(YamlNode, LoadFileReadsThePipesOfAShell) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  ASSERT_EQ(write(ends[1], "a: 1", 4), 4);
  close(ends[1]);
  EXPECT_EQ(YamlNode::LoadFile(fmt::format("/dev/fd/{}", ends[0])).At("a").Int(), 1);
  close(ends[0]);
}

}  // namespace
}  // namespace planbench
