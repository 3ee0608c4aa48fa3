#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "common/read_text.h"
#include "tests/report/browser.h"
#include "tests/report/example_session.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

/// Asks a page of printed figures.
constexpr char kPrintedProbe[] = R"script(
  found.faults = [];
  found.labels = {};
  for (const figure of document.querySelectorAll("svg")) {
    const sheet = figure.getBoundingClientRect();
    const texts = [...figure.querySelectorAll("text")].filter(one => one.getAttribute("opacity") !== "0");
    for (const one of texts) {
      const box = one.getBoundingClientRect();
      if (box.left < sheet.left || box.right > sheet.right || box.bottom > sheet.bottom) found.faults.push(one.textContent);
    }
    // Numbers may not fall to the right.
    for (const axis of figure.querySelectorAll(".role-axis-label")) {
      const ends = [...axis.querySelectorAll("text")].filter(one => /^[0-9.,]+%?$/.test(one.textContent))
        .map(one => [parseFloat(one.textContent.replace(/,/g, "")), one.getBoundingClientRect().right])
        .sort((one, other) => one[0] - other[0]).map(one => one[1]);
      if (ends.some((end, i) => end < ends[i - 1] - 1)) found.faults.push("mirrored");
    }
    found.titles = {...found.titles, [figure.parentElement.id]: [...figure.querySelectorAll(".role-title text")].map(one => one.textContent)};
    found.labels[figure.parentElement.id] = texts.map(one => one.textContent.replace(/ /g, ""));
  }
)script";

/// Asks the page what a reader could see. Everything is drawn first, also what is out of sight.
constexpr char kProbe[] = R"script(
  const count = () => {
    const marks = {};
    const visit = item => {
      if (item.name && item.marktype) marks[item.name] = (marks[item.name] || 0) + item.items.length;
      (item.items || []).forEach(visit);
    };
    for (const chart of pictures.all) visit(chart.view.scenegraph().root);
    return marks;
  };
  // What stands beside the axes of the figures.
  const labels = () => {
    const texts = [];
    const visit = item => {
      if (item.role === "axis-label") texts.push(...item.items);
      else (item.items || []).forEach(visit);
    };
    for (const chart of pictures.all) visit(chart.view.scenegraph().root);
    return texts;
  };
  // Texts that are cut to make room, and axes along which numbers, or rows, fall to the right.
  const faults = () => {
    const {textMetrics} = requireModule("vega-scenegraph");
    const all = [];
    const visit = item => {
      if (item.marktype === "text") {
        all.push(...item.items.flatMap(one => [one.text].flat().filter(line =>
          one.limit > 0 && textMetrics.width({...one, limit: 0}, line) > one.limit)));
      }
      if (item.role === "axis-label") {
        const ends = [...item.items].sort((one, other) => one.datum.value - other.datum.value).map(one => one.bounds.x2);
        if (ends.some((end, i) => end < ends[i - 1] - 1)) all.push("mirrored");
      }
      (item.items || []).forEach(visit);
    };
    for (const chart of pictures.all) visit(chart.view.scenegraph().root);
    return all;
  };
  const linear = colour => [1, 3, 5].map(i => parseInt(colour.slice(i, i + 2), 16) / 255)
    .map(c => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  const luminance = colour => {
    const parts = linear(colour);
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2];
  };
  // Of two contestants' colours the least difference (Oklab), as who lacks a kind of cones sees them (Machado, Oliveira and
  // Fernandes 2009), and in grey, that of lightness.
  const differences = () => {
    const times = (matrix, v) => matrix.map(row => row.reduce((sum, one, i) => sum + one * v[i], 0));
    const seen = {
      deutan: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
      protan: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    };
    const oklab = v => times([[0.2104542553, 0.793617785, -0.0040720468], [1.9779984951, -2.428592205, 0.4505937099],
                              [0.0259040371, 0.7827717662, -0.808675766]],
      times([[0.4122214708, 0.5363325363, 0.0514459929], [0.2119034982, 0.6806995451, 0.1073969566],
             [0.0883024619, 0.2817188376, 0.6299787005]], v).map(Math.cbrt));
    const all = theme.property("--series").split(",").map(c => c.trim());
    const least = of => Math.min(...all.flatMap((one, i) => all.slice(0, i).map(other => {
      const a = of(one), b = of(other);
      return Math.hypot(...a.map((value, k) => value - b[k]));
    })));
    const cut = v => v.map(value => Math.min(Math.max(value, 0), 1));
    return {
      ...Object.fromEntries(Object.entries(seen).map(([kind, matrix]) =>
        [kind, least(colour => oklab(cut(times(matrix, linear(colour)))))])),
      grey: least(colour => [Math.cbrt(luminance(colour))]),
    };
  };
  const contrasts = () => {
    const contrast = (a, b) => {
      const [dark, light] = [luminance(a), luminance(b)].sort((x, y) => x - y);
      return (light + 0.05) / (dark + 0.05);
    };
    const background = theme.property("--background"), panel = theme.property("--panel");
    return {
      text: Math.min(...["--text", "--muted", "--accent", "--failure"].flatMap(name =>
        [contrast(theme.property(name), background), contrast(theme.property(name), panel)])),
      series: Math.min(...["--series", "--phases"].flatMap(name => theme.property(name).split(","))
        .map(c => contrast(c.trim(), background))),
    };
  };
  // On paper everything is open, and afterwards what was.
  const closed = () => document.querySelectorAll("details:not([open])").length;
  found.closed = [closed()];
  dispatchEvent(new Event("beforeprint"));
  found.unprinted = closed() + [...document.querySelectorAll("details")].filter(one => !one.querySelector("table, pre")).length;
  dispatchEvent(new Event("afterprint"));
  found.closed.push(closed());
  pictures.all.forEach(chart => pictures.render(chart));
  found.charts = pictures.all.length;
  found.success_width = Math.max(0, ...[...document.querySelectorAll("#success table")].map(one => one.offsetWidth));
  found.names = new Set(pictures.all.map(chart => chart.element.getAttribute("aria-label"))).size;
  found.empty = pictures.all.filter(chart => !chart.element.querySelector("svg, canvas")).length;
  found.marks = count();
  found.faults = faults();
  found.contrast = [contrasts()];
  found.difference = [differences()];
  document.getElementById("theme").click();
  found.contrast.push(contrasts());
  found.difference.push(differences());
  const strokes = [...Array(32).keys()].map(place => `${theme.colour(place)} ${theme.dash(place)}`);
  found.strokes = new Set(strokes).size;
  found.neighbours = strokes.filter((one, place) => place > 0 && String(theme.dash(place)) === String(theme.dash(place - 1))).length;
  // On paper: light, and as wide as a sheet. Only then in the reader's colours again.
  dispatchEvent(new Event("beforeprint"));
  found.printed = {
    theme: document.documentElement.dataset.theme,
    widest: Math.max(0, ...pictures.all.map(chart => chart.width)),
  };
  dispatchEvent(new Event("afterprint"));
  found.printed.after = document.documentElement.dataset.theme;
  found.themes = document.documentElement.dataset.theme;
  found.evil = document.querySelectorAll(".evil, main i").length;
  found.unreachable = [...document.querySelectorAll("a, button:not(:disabled), select, summary, .scroll, .chart")]
    .filter(one => one.tabIndex < 0).length;
  // The tooltips that arrow keys reach in each figure, in order.
  const tooltip = document.getElementById("tooltip"), ring = document.getElementById("ring");
  const press = (chart, key) => {
    chart.element.dispatchEvent(new KeyboardEvent("keydown", {key}));
    return ring.hidden || tooltip.hidden ? "" : tooltip.textContent;
  };
  found.reached = {};
  found.below = {};
  found.back = {};
  found.escaped = {};
  for (const chart of pictures.all) {
    chart.element.focus();
    const tips = found.reached[chart.label] = [];
    for (let before = null; before !== chart.at;) {
      before = chart.at;
      const tip = press(chart, "ArrowRight");
      if (before !== chart.at) tips.push(tip);
    }
    press(chart, "Home");
    found.below[chart.label] = press(chart, "ArrowDown").split("\n")[0];
    found.back[chart.label] = press(chart, "ArrowUp") === tips[0];
    found.escaped[chart.label] = press(chart, "Escape") === "";
    press(chart, "End");
  }
  const ofTimes = pictures.all.find(chart => chart.label.startsWith("Planning time of every run"));
  if (ofTimes) {
    ofTimes.element.focus();
    press(ofTimes, "Home");
    press(ofTimes, "Escape");
    press(ofTimes, "Enter");
    found.unseen = [document.activeElement === ofTimes.element];
    press(ofTimes, "Home");
    ofTimes.element.blur();
    ofTimes.element.focus();
    press(ofTimes, "Enter");
    found.unseen.push(document.activeElement === ofTimes.element);
    press(ofTimes, "Home");
    press(ofTimes, "Enter");
    found.opened = [document.activeElement.closest("section").id, ring.hidden, tooltip.hidden];
  }
  found.legends = [...document.querySelectorAll(".legend button")].map(one => one.textContent);
  found.pair = [...document.querySelectorAll("#pairs .controls select")].slice(1)
    .flatMap(one => [...one.options].map(option => option.textContent));
  found.trained_rows = {};
  for (const section of document.querySelectorAll("section")) {
    found.trained_rows[section.id] = [...section.querySelectorAll("table tr")]
      .filter(row => [...row.children].some(cell => cell.textContent === "(trained)")).length;
  }
  found.trained_labels = labels().filter(label => [label.text].flat().join("").endsWith("(trained)")).length;
  // In a narrow window.
  document.body.style.maxWidth = "420px";
  pictures.all.forEach(chart => pictures.render(chart));
  const right = document.body.getBoundingClientRect().right;
  found.wider = [...document.querySelectorAll("body *")]
    .filter(one => !one.closest(".scroll table, svg, #tooltip, pre") && one.getBoundingClientRect().right > right + 1)
    .map(one => one.tagName);
  found.faults.push(...faults());
  const ofAxis = new Map();
  for (const label of labels().filter(one => one.opacity !== 0)) {
    ofAxis.set(label.mark, [...(ofAxis.get(label.mark) || []), label.bounds]);
  }
  found.crossing = [...ofAxis.values()].flatMap(all => all.filter((one, i) => i > 0 && one.intersects(all[i - 1]))).length;
  document.body.style.maxWidth = "";
  found.contestants = report.data.contestants.map(one => one.name);
  const problem = document.getElementById("problem");
  if (problem) {
    const [set, index] = problem.querySelectorAll("select");
    set.value = "1";
    set.dispatchEvent(new Event("change"));
    found.attempts = problem.querySelectorAll("tbody tr").length;
    found.problem = problem.querySelectorAll("select")[1].options.length;
    [...problem.querySelectorAll("button")].pop().click();
    found.next = problem.querySelectorAll("select")[1].value;
    const failures = [...document.querySelectorAll("#failures button.link")];
    found.failures = failures.map(one => one.textContent);
    if (failures.length > 0) {
      failures[0].click();
      found.led = [...problem.querySelectorAll("select")].map(one => one.selectedOptions[0].textContent);
    }
  }
)script";

/// The report program's page in a real browser that has no network.
class PageTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!FindBrowser()) GTEST_SKIP() << "no Chromium here: apt-get install chromium";
  }

  nlohmann::json Open(const std::vector<MadeRun>& runs) {
    const std::filesystem::path session = folder_ / fmt::format("session{}", ++num_opened_);
    WriteSession(session, runs, ExampleSession());
    ChildProcess report({std::string(PLANBENCH_BIN_DIR) + "/report", session.string(), "--out",
                         (folder_ / "page.html").string()},
                        folder_ / "report");
    EXPECT_EQ(report.Wait(), 0) << report.Errors();
    nlohmann::json found = Browse(folder_ / "page.html", kProbe);
    EXPECT_EQ(found["evil"], 0) << "a name was taken for markup";
    EXPECT_EQ(found["unreachable"], 0) << "not reachable with the keyboard";
    EXPECT_EQ(found["empty"], 0);
    EXPECT_EQ(found["unprinted"], 0) << "closed, or without what it holds, on paper";
    EXPECT_EQ(found["closed"][1], found["closed"][0]);
    EXPECT_EQ(found["wider"], nlohmann::json::array()) << "than a narrow window";
    EXPECT_EQ(found["faults"], nlohmann::json::array());
    EXPECT_EQ(found["crossing"], 0) << "labels that run into one another";
    EXPECT_EQ(found["names"], found["charts"]) << "figures without names of their own";
    for (const auto& contrast : found["contrast"]) {
      EXPECT_GE(contrast["text"], 4.5);
      EXPECT_GE(contrast["series"], 3);
    }
    for (const auto& difference : found["difference"]) {
      EXPECT_GE(difference["deutan"], 0.075);
      EXPECT_GE(difference["protan"], 0.075);
      EXPECT_GE(difference["grey"], 0.025);
    }
    EXPECT_EQ(found["strokes"], 32) << "contestants that look alike";
    EXPECT_EQ(found["neighbours"], 0) << "told apart by colour alone";
    EXPECT_EQ(found["printed"]["theme"], "light");
    EXPECT_LE(found["printed"]["widest"], 640);
    EXPECT_EQ(found["printed"]["after"], found["themes"]);
    return found;
  }

  TemporaryFolder folder_;
  int num_opened_ = 0;
};

TEST_F(PageTest, HasAMarkForEveryRowOfTheData) {
  const nlohmann::json found = Open(ExampleRuns());
  EXPECT_EQ(found["contestants"], (nlohmann::json{kTagName, kScriptName}));
  EXPECT_EQ(found["marks"]["confirmed"], 4);     // two contestants on two sets
  EXPECT_EQ(found["marks"]["solved-runs"], 45);  // each run of 48
  EXPECT_EQ(found["marks"]["failed-runs"], 3);
  EXPECT_EQ(found["marks"]["problems"], 18);  // common problems of the pair
  EXPECT_EQ(found["attempts"], 3);            // at the first problem of the second set
  EXPECT_EQ(found["problem"], 12);
  EXPECT_EQ(found["next"], "1");
  EXPECT_EQ(found["failures"], (nlohmann::json{"6", "11", "12"}));
  EXPECT_EQ(found["led"], (nlohmann::json{"a<i>set</i>", "6"}));
}

TEST_F(PageTest, KeysReachEveryMarkOfAFigure) {
  const nlohmann::json found = Open(ExampleRuns());
  // Every run, and a median for each contestant, from left to right.
  const nlohmann::json& times = found["reached"]["Planning time of every run, shelf"];
  ASSERT_EQ(times.size(), 38u);
  const std::string first = std::string(kTagName) + "\nproblem 1, trial ";
  EXPECT_THAT(times[0].get<std::string>(), testing::StartsWith(first));
  EXPECT_THAT(times[24].get<std::string>(), testing::StartsWith(kTagName));
  EXPECT_THAT(times[25].get<std::string>(), testing::StartsWith(kScriptName));
  EXPECT_THAT(times[37].get<std::string>(), testing::HasSubstr("not solved"));
  EXPECT_EQ(found["reached"]["Success, shelf"].size(), 2u) << "of interval and dot the dot";
  EXPECT_EQ(found["reached"]["Share solved by a time, shelf"],
            (nlohmann::json{kTagName, kScriptName}));
  for (const char* figure :
       {"Planning time of every run, shelf", "Success, shelf", "Share solved by a time, shelf"}) {
    EXPECT_EQ(found["below"][figure], kScriptName) << figure;
  }
  EXPECT_EQ(found["back"].size(), found["charts"]);
  for (const auto& [figure, tips] : found["reached"].items()) {
    EXPECT_EQ(found["back"][figure], true) << "to the first mark of " << figure;
    EXPECT_EQ(found["escaped"][figure], true) << figure;
  }
  EXPECT_EQ(found["unseen"], (nlohmann::json{true, true})) << "a point opened without a ring";
  EXPECT_EQ(found["opened"], (nlohmann::json{"problem", true, true}));
}

TEST_F(PageTest, DrawsImprovementsWithTheirBounds) {
  const nlohmann::json found =
      Open({{.contestant = "A", .progress = {{0.1, 4, 30, 1}, {1, 2, 15, 2}}},
            {.contestant = "A", .problem = 2, .progress = {{0.5, 3, 10, 1}}}});
  // Cost and bound besides success, times, survival, phases and path quality.
  EXPECT_EQ(found["charts"], 7);
}

TEST_F(PageTest, MarksWhoHasLearnedWhereverItIsShown) {
  std::vector<MadeRun> runs;
  for (const char* contestant : {"Pupil", "Other"}) {
    for (const char* set : {"exam", "shelf"}) {
      for (int problem = 1; problem <= 2; ++problem) {
        MadeRun& run = runs.emplace_back();
        run = {.contestant = contestant, .set = set, .problem = problem};
        if (run.contestant == "Pupil") run.settings["learned_from"] = "shelf";
        if (problem == 2 && run.set == "shelf") run.status = PlanStatus::kTimedOut;
      }
    }
  }
  const nlohmann::json found = Open(runs);
  const std::string in_page = "Pupil (trained on shelf)", in_set = "Pupil (trained)";
  EXPECT_EQ(found["legends"], (nlohmann::json{in_page, "Other", in_page, "Other"}));
  EXPECT_EQ(found["pair"], (nlohmann::json{in_set, "Other", in_set, "Other"})) << "of all sets";
  EXPECT_EQ(found["led"], (nlohmann::json{"shelf", "2"}));
  for (const char* section : {"success", "times", "quality", "phases", "failures"}) {
    EXPECT_EQ(found["trained_rows"][section].get<int>() > 0, true) << section;
  }
  // Its figures: its row in success, times, quality and phases.
  EXPECT_EQ(found["trained_labels"], 4);
}

TEST_F(PageTest, IsRightForNoRunAndForOne) {
  EXPECT_EQ(Open({})["charts"], 0);
  const nlohmann::json one =
      Open({{.contestant = "RRT-Connect (canonical)", .status = PlanStatus::kTimedOut}});
  EXPECT_EQ(one["marks"]["failed-runs"], 1);
  EXPECT_GT(one["closed"][0], 0);
  EXPECT_LE(one["success_width"], 1176) << "cut off in a window of 1300 px";
}

TEST_F(PageTest, IsWholeWhereNoProblemIsInCommon) {
  const nlohmann::json found = Open({{.contestant = "A"}, {.contestant = "B", .problem = 2}});
  // Success, times, survival, the pair without a point, path quality and phases; no profile.
  EXPECT_EQ(found["charts"], 6);
  EXPECT_EQ(found["attempts"], 1);
}

TEST_F(PageTest, HoldsThirtyContestants) {
  std::vector<MadeRun> runs;
  for (int c = 1; c <= 30; ++c) {
    for (int problem = 1; problem <= 3; ++problem) {
      runs.push_back({.contestant = fmt::format("contestant {} of a longer name than most", c),
                      .problem = problem,
                      .time_s = 0.001 * c * problem});
    }
  }
  const nlohmann::json found = Open(runs);
  EXPECT_EQ(found["marks"]["solved-runs"], 90);
  EXPECT_EQ(found["marks"]["confirmed"], 30);
}

TEST_F(PageTest, HasRoomBesideTheWidestNames) {
  Open({{.contestant = std::string(60, 'W')}, {.contestant = "B", .time_s = 2}});
}

TEST_F(PageTest, PrintedFiguresHoldTheNamesOfASweep) {
  if (std::system("command -v node >/dev/null") != 0) {
    GTEST_SKIP() << "no node here: apt-get install nodejs";
  }
  std::vector<MadeRun> runs;
  std::vector<std::string> names;
  for (const char* balance : {"true", "false"}) {
    for (const char* range : {"0.5", "2"}) {
      names.push_back(fmt::format("RRT-Connect (sweep), balance {}, range {}, before the change",
                                  balance, range));
      for (int problem = 1; problem <= 3; ++problem) {
        runs.push_back({.contestant = names.back(), .problem = problem, .time_s = 0.01 * problem});
      }
      runs.push_back({.contestant = names.back(), .problem = 4, .status = PlanStatus::kTimedOut});
    }
  }
  WriteSession(folder_ / "sweep", runs, ExampleSession());
  ChildProcess report(
      {std::string(PLANBENCH_BIN_DIR) + "/report", (folder_ / "sweep").string(), "--out",
       (folder_ / "page.html").string(), "--figures", (folder_ / "figures").string()},
      folder_ / "report");
  ASSERT_EQ(report.Wait(), 0) << report.Errors();
  std::string page = "<body>";
  for (const char* kind : {"success", "times", "survival", "profile", "phases", "path_length"}) {
    page += fmt::format("<div id=\"{}\">{}</div>", kind,
                        ReadText(folder_ / "figures" / (std::string(kind) + "-shelf.svg")));
  }
  folder_.Write("printed.html", page);
  const nlohmann::json found = Browse(folder_ / "printed.html", kPrintedProbe);
  EXPECT_EQ(found["faults"], nlohmann::json::array());
  for (std::string& name : names)
    name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
  for (const auto& [kind, labels] : found["labels"].items()) {
    for (const std::string& name : names) EXPECT_THAT(labels, testing::Contains(name)) << kind;
  }
  EXPECT_THAT(found["labels"]["phases"], testing::Contains("collisionchecking"));
  EXPECT_EQ(found["titles"].size(), 6u);
  EXPECT_EQ(found["titles"]["survival"], (nlohmann::json{"Share solved by a time: shelf",
                                                         "4 problems, time limit 10 s, Fast CPU"}));
}

}  // namespace
}  // namespace planbench
