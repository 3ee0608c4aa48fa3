#include "viewer/live_server.h"

#include <gtest/gtest.h>
#include <httplib.h>

#include <functional>
#include <string>

#include "geometry/mesh_loader.h"
#include "geometry/polyhedra.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/mesh_arm.h"
#include "tests/support/obj_text.h"
#include "tests/support/planar_session.h"
#include "tests/support/temporary_folder.h"

namespace planbench {
namespace {

class LiveServerTest : public testing::Test {
 protected:
  LiveServerTest() {
    bus_.Start();
    const std::string url = server_.url();
    port_ = std::stoi(url.substr(url.rfind(':') + 1));
  }

  static int Count(const std::string& text, const std::string& part) {
    int count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  }

  /// Listens until `is_done` with the events that were sent, or to 20 states, which are 10 s.
  std::string Listen(const std::function<bool(const std::string&)>& is_done) {
    httplib::Client client("127.0.0.1", port_);
    client.set_read_timeout(10, 0);
    std::string text;
    client.Get("/events", [&](const char* data, std::size_t size) {
      text.append(data, size);
      const bool is_whole = text.ends_with("\n\n");
      return !is_whole || (Count(text, "event: state\n") < 20 && !is_done(text));
    });
    return text;
  }
  std::string ListenFor(const std::string& wanted) {
    return Listen([&](const std::string& text) { return text.find(wanted) != std::string::npos; });
  }

  Bus bus_{"memq://"};
  LiveServer server_{&bus_, "", 0};
  int port_ = 0;
};

TEST_F(LiveServerTest, ServesThePageToThisMachineAlone) {
  EXPECT_TRUE(server_.url().starts_with("http://127.0.0.1:"));
  httplib::Client client("127.0.0.1", port_);
  const auto page = client.Get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_NE(page->body.find("connect-src 'self'"), std::string::npos);
  EXPECT_NE(page->body.find("makeViewer"), std::string::npos);
  const auto other = client.Get("/", {{"Host", "evil.example"}});
  ASSERT_TRUE(other);
  EXPECT_EQ(other->status, 403);
  EXPECT_EQ(client.Get("/nothing")->status, 404);
}

TEST_F(LiveServerTest, SendsWhatHappensOnTheBus) {
  const PlanarSession session;
  bus_.Publish(channel::kSession, session.session);
  bus_.Publish(channel::kScene, session.scene);
  bus_.Publish(channel::kRunRecord, session.record);
  const std::string text = ListenFor("\"title\":\"shelf 1\"");
  EXPECT_NE(text.find("event: state\ndata: {"), std::string::npos);
  EXPECT_NE(text.find("event: view\ndata: {"), std::string::npos);
  EXPECT_NE(ListenFor("\"runs\":1").find("\"run_id\":\"session\""), std::string::npos);
}

TEST_F(LiveServerTest, MeshesAreSentOnceAlsoIfViewsWithoutThemComeBetween) {
  const TemporaryFolder folder;
  const auto file = folder.Write("arm/hand.obj", ObjText(BoxMesh({0.25, 0.1, 0.1})));
  const std::string id = SharedMesh(LoadMesh(file)).id();
  PlanarSession session;
  session.session.settings["robot"] = WriteMeshArm(folder, "hand.obj").string();
  bus_.Publish(channel::kSession, session.session);
  bus_.Publish(channel::kScene, session.scene);
  int num_published = 0;
  const auto publish = [&](CollisionModel model) {
    session.record.request_id = "request " + std::to_string(++num_published);
    session.record.request.collision_model = model;
    bus_.Publish(channel::kRunRecord, session.record);
  };
  publish(CollisionModel::kMeshes);
  const std::string text = Listen([&](const std::string& heard) {
    if (Count(heard, "event: view\n") < num_published) return false;
    if (num_published == 4) return true;
    publish(num_published == 1 ? CollisionModel::kSpheres : CollisionModel::kMeshes);
    return false;
  });
  EXPECT_EQ(Count(text, "\"mesh\":\"" + id + "\""), 3) << "views by meshes: " << text;
  EXPECT_EQ(Count(text, "\"triangles\":\""), 1) << text;
  EXPECT_EQ(Count(text, "\"" + id + "\":null"), 3) << text;
}

TEST_F(LiveServerTest, APortInUseIsRefused) {
  ExpectInputError([&] { LiveServer(&bus_, "", port_); },
                   {"--port", "127.0.0.1:" + std::to_string(port_)});
}

}  // namespace
}  // namespace planbench
