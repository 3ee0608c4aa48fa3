#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "report/figures.h"
#include "report/web_files.h"
#include "tests/support/child_process.h"
#include "tests/support/session_database.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

/// What the page's scripts make of the curves of sessions under different time limits.
class CurvesDrawnTest : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v node >/dev/null") != 0) {
      GTEST_SKIP() << "no node here: apt-get install nodejs";
    }
  }

  /// Sessions of a contestant each, with the limit (s) of all its runs.
  static ComparedSessions Sessions(const std::vector<std::pair<double, std::vector<MadeRun>>>& of) {
    const TemporaryFolder folder;
    std::vector<StoredSession> sessions;
    for (const auto& [limit_s, runs] : of) {
      const std::filesystem::path session = folder / runs.front().contestant;
      WriteSession(session, runs);
      sessions.push_back(ReadSessions(session).sessions.front());
      for (StoredRun& run : sessions.back().runs) run.time_limit_s = limit_s;
    }
    return ComparedSessions(std::move(sessions));
  }

  /// The figure of a kind on the first set; null if there is nothing to draw.
  Json Make(const ComparedSessions& compared, const std::string& kind) {
    folder_.Write("data.json", FigureData(compared, {}, {}).dump());
    std::string script =
        "const theme = {colour: place => place, dash: place => [place], property: name => name};\n";
    for (const char* name : {"charts.js", "figures.js"}) script += WebFile(name);
    script +=
        "const [file, kind] = process.argv.slice(2);\n"
        "const data = JSON.parse(require('fs').readFileSync(file, 'utf8')), set = data.sets[0];\n"
        "const {list, make} = figureKinds[kind], values = list(set);\n"
        "const places = values.map(value => value.contestant);\n"
        "const figure = values.length > 0 && make(440, namesOf(data, set, places), places, "
        "values);\n"
        "console.log(JSON.stringify(figure || null));\n";
    folder_.Write("draw.js", script);
    ChildProcess node(
        {"node", (folder_ / "draw.js").string(), (folder_ / "data.json").string(), kind},
        folder_ / "node");
    EXPECT_EQ(node.Wait(), 0) << node.Errors();
    return Json::parse(node.Output());
  }

  /// Points of the curves of a kind on the first set, each with the place of its contestant.
  Json Draw(const ComparedSessions& compared, const std::string& kind) {
    return Make(compared, kind)["data"][0]["values"];
  }

  static std::vector<Json> Of(const Json& points, int place) {
    std::vector<Json> of;
    for (const Json& point : points) {
      if (point["place"] == place) of.push_back(point);
    }
    return of;
  }

  TemporaryFolder folder_;
};

TEST_F(CurvesDrawnTest, SharesBeginWithTheirIntervalAndEndAtTheirOwnLimit) {
  const ComparedSessions compared =
      Sessions({{2, {{.contestant = "A", .time_s = 0.3}, {.contestant = "A", .problem = 2}}},
                {20, {{.contestant = "B", .time_s = 4}, {.contestant = "B", .problem = 2}}},
                {0.5, {{.contestant = "C", .status = PlanStatus::kTimedOut}}}});
  ASSERT_EQ(compared.contestants().back().name, "C");
  const Json points = Draw(compared, "survival");
  const std::vector<Json> a = Of(points, 0), b = Of(points, 1), c = Of(points, 2);
  const Interval nothing = WilsonInterval(0, 2);
  EXPECT_EQ(a.front()["x"], 100) << "the axis begins at a power of ten";
  for (const std::vector<Json>& curve : {a, b}) {
    EXPECT_EQ(curve.front()["share"], 0);
    EXPECT_NEAR(curve.front()["upper"], nothing.upper, 1e-5);
  }
  EXPECT_EQ(a.back()["x"], 2000);
  EXPECT_EQ(a.back()["share"], 1);
  EXPECT_EQ(b.back()["x"], 20'000);
  EXPECT_EQ(c.back()["x"], 500);
  EXPECT_NEAR(c.back()["upper"], WilsonInterval(0, 1).upper, 1e-5) << "nothing solved";
  // What was found backward came after the limit of an attempt.
  const ComparedSessions backward =
      Sessions({{2,
                 {{.contestant = "A", .status = PlanStatus::kTimedOut, .time_s = 2},
                  {.contestant = "A", .time_s = 1, .direction = Direction::kBackward}}},
                {20, {{.contestant = "B", .time_s = 4}}}});
  EXPECT_EQ(Of(Draw(backward, "survival"), 0).back()["x"], 3000);
}

TEST_F(CurvesDrawnTest, NothingSolvedUnderALimitThatIsAPowerOfTenIsACurveAllTheSame) {
  for (const double limit_s : {1.0, 1.5}) {
    const Json points = Draw(
        Sessions({{limit_s, {{.contestant = "A", .status = PlanStatus::kTimedOut}}}}), "survival");
    EXPECT_EQ(points.front()["x"], 100);
    EXPECT_EQ(points.back()["x"], 1000 * limit_s);
  }
}

TEST_F(CurvesDrawnTest, TimesOfNothingStandBeforeAllOthers) {
  const auto domain = [&](const std::vector<MadeRun>& runs) {
    const Json scale = Make(Sessions({{10, runs}}), "times")["scales"][1];
    EXPECT_EQ(scale["clamp"], true) << scale;
    return scale["domain"];
  };
  const MadeRun nothing = {.contestant = "A", .time_s = 0};
  const MadeRun other = {.contestant = "A", .problem = 2, .time_s = 0.2};
  EXPECT_EQ(domain({other})[0], 100);
  EXPECT_EQ(domain({nothing, other})[0], 10);
  EXPECT_EQ(domain({nothing})[0], 1000) << "before the limit";
}

TEST_F(CurvesDrawnTest, ALimitThatIsNotKnownIsNotDrawn) {
  const auto draws_limit = [&](double limit_s) {
    const Json marks =
        Make(Sessions({{limit_s, {{.contestant = "A", .status = PlanStatus::kTimedOut}}}}),
             "times")["marks"];
    return std::any_of(marks.begin(), marks.end(),
                       [](const Json& mark) { return mark.value("name", "") == "limit"; });
  };
  EXPECT_TRUE(draws_limit(10));
  EXPECT_FALSE(draws_limit(0));
  // Nor is a share by a time, where nothing is known by any.
  const ComparedSessions failed =
      Sessions({{0, {{.contestant = "A", .status = PlanStatus::kTimedOut}}}});
  EXPECT_TRUE(Make(failed, "survival").is_null());
}

TEST_F(CurvesDrawnTest, AProfileOverNoProblemIsNone) {
  const std::vector<MadeRun> one = {{.contestant = "A"}};
  const std::vector<MadeRun> other = {{.contestant = "B", .problem = 2}};
  EXPECT_TRUE(Make(Sessions({{10, one}, {10, other}}), "profile").is_null());
}

TEST_F(CurvesDrawnTest, ImprovementsEndAtTheirOwnLimit) {
  const std::vector<PlanProgress> progress = {{0.1, 0, 3, 1}, {1, 0, 2, 1}};
  const std::vector<PlanProgress> longer = {{0.2, 0, 3, 1}, {9, 0, 2, 1}};
  const Json points =
      Draw(Sessions({{2, {{.contestant = "A", .length = 2, .progress = progress}}},
                     {20, {{.contestant = "B", .time_s = 9, .length = 2, .progress = longer}}}}),
           "cost");
  EXPECT_EQ(Of(points, 0).back()["x"], 2000);
  EXPECT_EQ(Of(points, 1).back()["x"], 9000);
  // What was found backward improved after the limit of an attempt.
  const ComparedSessions backward =
      Sessions({{2,
                 {{.contestant = "A", .status = PlanStatus::kTimedOut, .time_s = 2},
                  {.contestant = "A",
                   .time_s = 1,
                   .direction = Direction::kBackward,
                   .length = 2,
                   .progress = progress}}}});
  EXPECT_EQ(Of(Draw(backward, "cost"), 0).back()["x"], 3000);
}

}  // namespace
}  // namespace planbench
