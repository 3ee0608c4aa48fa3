#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "tests/report/example_session.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

std::optional<std::string> FindBrowser() {
  for (const char* name :
       {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"}) {
    if (std::filesystem::exists(name)) return name;
  }
  return std::nullopt;
}

/// Asks the page what a reader could see. Everything is drawn first, also what is out of sight.
constexpr char kProbe[] = R"script(<script>
addEventListener("load", () => {
  const found = {};
  const count = () => {
    const marks = {};
    const visit = item => {
      if (item.name && item.marktype) marks[item.name] = (marks[item.name] || 0) + item.items.length;
      (item.items || []).forEach(visit);
    };
    for (const chart of charts.all) visit(chart.view.scenegraph().root);
    return marks;
  };
  const contrasts = () => {
    const luminance = colour => {
      const parts = [1, 3, 5].map(i => parseInt(colour.slice(i, i + 2), 16) / 255)
        .map(c => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
      return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2];
    };
    const contrast = (a, b) => {
      const [dark, light] = [luminance(a), luminance(b)].sort((x, y) => x - y);
      return (light + 0.05) / (dark + 0.05);
    };
    const background = theme.property("--background"), panel = theme.property("--panel");
    return {
      text: Math.min(...["--text", "--muted", "--accent", "--failure"].flatMap(name =>
        [contrast(theme.property(name), background), contrast(theme.property(name), panel)])),
      series: Math.min(...theme.property("--series").split(",").map(c => contrast(c.trim(), background))),
    };
  };
  charts.all.forEach(chart => charts.render(chart));
  found.charts = charts.all.length;
  found.empty = charts.all.filter(chart => !chart.element.querySelector("svg, canvas")).length;
  found.marks = count();
  found.contrast = [contrasts()];
  document.getElementById("theme").click();
  found.contrast.push(contrasts());
  found.themes = document.documentElement.dataset.theme;
  found.requests = performance.getEntriesByType("resource").length;
  found.evil = document.querySelectorAll(".evil, main i").length;
  found.unreachable = [...document.querySelectorAll("a, button:not(:disabled), select, summary, .scroll")]
    .filter(one => one.tabIndex < 0).length;
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
  }
  const probe = document.createElement("pre");
  probe.textContent = "PROBE" + btoa(unescape(encodeURIComponent(JSON.stringify(found)))) + ".";
  document.body.append(probe);
});
</script>)script";

std::string FromBase64(const std::string& text) {
  std::string decoded;
  unsigned bits = 0;
  int num_bits = 0;
  for (const char c : text) {
    const std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) break;
    bits = bits << 6 | static_cast<unsigned>(digit);
    num_bits += 6;
    if (num_bits < 8) continue;
    num_bits -= 8;
    decoded += static_cast<char>(bits >> num_bits & 0xff);
  }
  return decoded;
}

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
    std::ofstream(folder_ / "page.html", std::ios::app) << kProbe;
    ChildProcess browser(
        {*FindBrowser(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
         "--enable-logging=stderr", "--host-resolver-rules=MAP * ~NOTFOUND",
         "--user-data-dir=" + (folder_ / "profile").string(), "--window-size=1200,900",
         "--virtual-time-budget=20000", "--dump-dom", "file://" + (folder_ / "page.html").string()},
        folder_ / "browser");
    EXPECT_EQ(browser.Wait(), 0);
    EXPECT_EQ(browser.Errors().find("CONSOLE"), std::string::npos) << browser.Errors();
    const std::string page = browser.Output();
    const std::size_t begin = page.find("<pre>PROBE");
    if (begin == std::string::npos) {
      ADD_FAILURE() << "the page did not load: " << browser.Errors();
      return {};
    }
    nlohmann::json found = nlohmann::json::parse(FromBase64(page.substr(begin + 10)));
    EXPECT_EQ(found["requests"], 0);
    EXPECT_EQ(found["evil"], 0) << "a name was taken for markup";
    EXPECT_EQ(found["unreachable"], 0) << "not reachable with the keyboard";
    EXPECT_EQ(found["empty"], 0);
    for (const auto& contrast : found["contrast"]) {
      EXPECT_GE(contrast["text"], 4.5);
      EXPECT_GE(contrast["series"], 3);
    }
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
}

TEST_F(PageTest, IsRightForNoRunAndForOne) {
  EXPECT_EQ(Open({})["charts"], 0);
  const nlohmann::json one = Open({{.contestant = "A", .status = PlanStatus::kTimedOut}});
  EXPECT_EQ(one["marks"]["failed-runs"], 1);
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

}  // namespace
}  // namespace planbench
