#include "viewer/live_page.h"

#include <gtest/gtest.h>

#include <string>

#include "messaging/channels.h"
#include "tests/report/browser.h"
#include "tests/support/planar_session.h"
#include "tests/support/temporary_folder.h"
#include "viewer/live_session.h"

namespace planbench {
namespace {

/// Stands for the connection to LiveServer: the probe sends events.
constexpr char kSentEvents[] = R"script(<script>
class EventSource {
  constructor() { window.source = this; this.heard = {}; }
  addEventListener(name, listener) { this.heard[name] = listener; }
}
</script>)script";

constexpr char kLiveProbe[] = R"script(
  let now = 1e9;
  performance.now = () => now;
  const text = id => document.getElementById(id).textContent;
  const tell = (name, data) => { now += 1e4; source.heard[name]({data: JSON.stringify(data)}); };
  const shown = () => ({title: text("view-title"), facts: text("facts"),
                        picture: document.getElementById("view").getClientRects().length > 0});
  tell("state", state);
  found.subtitle = text("subtitle");
  found.runs = text("runs");
  found.images = document.querySelectorAll("main img").length;
  tell("view", view);
  found.first = shown();
  tell("view", {message: "The scene has not been heard."});
  found.without = shown();
  tell("view", view);
  found.again = shown();
)script";

TEST(LivePage, ShowsWhatItIsSentAndNoPictureOfAnotherRequest) {
  if (!FindBrowser()) GTEST_SKIP() << "no Chromium here: apt-get install chromium";
  PlanarSession bus;
  bus.record.message = "<img src=x>";  // from a stranger
  LiveSession live("");
  const auto hear = [&](const std::string& channel, const auto& message) {
    live.Hear(PlanarSession::Received(channel, message), {});
  };
  hear(channel::kSession, bus.session);
  hear(channel::kScene, bus.scene);
  hear(channel::kRunRecord, bus.record);
  std::string page = LivePage();
  page.insert(page.find("</head>"), kSentEvents);
  const TemporaryFolder folder;
  folder.Write("page.html", page);
  const nlohmann::json found =
      Browse(folder / "page.html", "const state = " + live.State({}, {}).dump() +
                                       ", view = " + live.View()->dump() + ";" + kLiveProbe);
  EXPECT_NE(found["subtitle"].get<std::string>().find("session session"), std::string::npos)
      << found;
  EXPECT_NE(found["runs"].get<std::string>().find("<img src=x>"), std::string::npos) << found;
  EXPECT_EQ(found["images"], 0);
  EXPECT_EQ(found["first"]["title"], "shelf 1");
  EXPECT_EQ(found["first"]["picture"], true);
  EXPECT_EQ(found["without"]["title"], "No view");
  EXPECT_EQ(found["without"]["facts"], "The scene has not been heard.");
  EXPECT_EQ(found["without"]["picture"], false);
  EXPECT_EQ(found["again"], found["first"]);
}

}  // namespace
}  // namespace planbench
