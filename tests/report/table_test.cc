#include "report/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace planbench {
namespace {

TEST(FormatNumberTest, ShowsThreeSignificantDigits) {
  EXPECT_EQ(FormatNumber(0), "0");
  EXPECT_EQ(FormatNumber(1), "1.00");
  EXPECT_EQ(FormatNumber(0.012345), "0.0123");
  EXPECT_EQ(FormatNumber(9.994), "9.99");
  EXPECT_EQ(FormatNumber(9.996), "10.0");
  EXPECT_EQ(FormatNumber(99.96), "100");
  EXPECT_EQ(FormatNumber(-12345.6), "-12346");
  EXPECT_EQ(FormatNumber(0.0000123), "1.23e-05");
  EXPECT_EQ(FormatNumber(std::numeric_limits<double>::infinity()), "-");
}

TEST(FormatCellTest, ShowsWhatThereIs) {
  EXPECT_EQ(FormatCell({}, Style::kNumber), "-");
  EXPECT_EQ(FormatCell(std::nan(""), Style::kShare), "-");
  EXPECT_EQ(FormatCell(7, Style::kCount), "7");
  EXPECT_EQ(FormatCell(33.333, Style::kShare), "33.3");
  EXPECT_EQ(FormatCell(0.00003, Style::kPValue), "< 0.0001");
  EXPECT_EQ(FormatCell(0.25, Style::kPValue), "0.2500");
  EXPECT_EQ(FormatCell(Estimate{2, Interval{1, 3}}, Style::kNumber), "2.00 [1.00, 3.00]");
  EXPECT_EQ(FormatCell(Estimate{2, std::nullopt}, Style::kNumber), "2.00");
  EXPECT_EQ(FormatCell(Estimate{0.952, Interval{0.904, 1.0028}}, Style::kRatio),
            "0.952 [0.904, 1.003]");
}

Table Example() {
  return {
      "example",
      "Example",
      "note",
      {{"name", "name"}, {"median_ms", "median", Style::kNumber, true}, {"n", "n", Style::kCount}},
      {{std::string("a,\"b\""), Estimate{0.1, Interval{0.05, 0.25}}, 3},
       {std::string("x_y & 50 %"), Estimate{1, std::nullopt}, 4},
       {std::string("plain"), Cell(), 5}}};
}

TEST(TableTest, CsvHasEveryNumberByItself) {
  EXPECT_EQ(TableCsv(Example()),
            "name,median_ms,median_ms_lower,median_ms_upper,n\r\n"
            "\"a,\"\"b\"\"\",0.1,0.05,0.25,3\r\n"
            "x_y & 50 %,1,,,4\r\n"
            "plain,,,,5\r\n");
}

TEST(TableTest, LatexEscapesWhatItWouldInterpret) {
  const std::string latex = TableLatex(Example());
  EXPECT_NE(latex.find("\\begin{tabular}{lrr}"), std::string::npos) << latex;
  EXPECT_NE(latex.find("x\\_y \\& 50 \\% & 1.00 & 4 \\\\"), std::string::npos) << latex;
  EXPECT_NE(latex.find("plain & - & 5 \\\\"), std::string::npos) << latex;
  Table table = Example();
  table.rows = {{std::string("\\{~^$#<"), Cell(), 1}};
  EXPECT_NE(TableLatex(table).find(
                "\\textbackslash{}\\{\\textasciitilde{}\\textasciicircum{}\\$\\#$<$ & - & 1"),
            std::string::npos);
}

TEST(TableTest, LatexKeepsDashesAndWhatARowBeginsWith) {
  Table table = Example();
  table.rows = {{std::string("[b] --time 1, ---"), Cell(), 1},
                {std::string("*star, a-b"), Cell(), 1},
                {std::string("ARA* [x]"), Cell(), 1}};
  const std::string latex = TableLatex(table);
  EXPECT_NE(latex.find("\\midrule\n{}[b] -{}-time 1, -{}-{}- & - & 1 \\\\\n"), std::string::npos)
      << latex;
  EXPECT_NE(latex.find("\n{}*star, a-b & - & 1 \\\\\n"), std::string::npos) << latex;
  EXPECT_NE(latex.find("\nARA* [x] & - & 1 \\\\\n"), std::string::npos) << latex;
}

TEST(TableTest, JsonHoldsWhatIsShown) {
  const Json json = TableJson(Example());
  EXPECT_EQ(json["rows"][0][1], "0.100 [0.0500, 0.250]");
  EXPECT_EQ(json["columns"][0]["numeric"], false);
  EXPECT_EQ(json["columns"][2]["numeric"], true);
}

}  // namespace
}  // namespace planbench
