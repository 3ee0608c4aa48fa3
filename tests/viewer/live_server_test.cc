#include "viewer/live_server.h"

#include <gtest/gtest.h>
#include <httplib.h>

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

  /// Listens until `wanted` stands in what was sent, for ten states at most.
  std::string Listen(const std::string& wanted) {
    httplib::Client client("127.0.0.1", port_);
    client.set_read_timeout(10, 0);
    std::string text;
    int num_pieces = 0;
    client.Get("/events", [&](const char* data, std::size_t size) {
      text.append(data, size);
      return ++num_pieces < 20 && text.find(wanted) == std::string::npos;
    });
    return text;
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
  const std::string text = Listen("\"title\":\"shelf 1\"");
  EXPECT_NE(text.find("event: state\ndata: {"), std::string::npos);
  EXPECT_NE(text.find("event: view\ndata: {"), std::string::npos);
  EXPECT_NE(Listen("\"runs\":1").find("\"run_id\":\"session\""), std::string::npos);
}

TEST_F(LiveServerTest, MeshesAreSentOnceAsLongAsTheyAreShown) {
  const TemporaryFolder folder;
  const auto file = folder.Write("arm/hand.obj", ObjText(BoxMesh({0.25, 0.1, 0.1})));
  const std::string left_out = "\"" + SharedMesh(LoadMesh(file)).id() + "\":null";
  const std::string content = "\"triangles\":\"";
  PlanarSession session;
  session.session.settings["robot"] = WriteMeshArm(folder, "hand.obj").string();
  session.record.request.collision_model = CollisionModel::kMeshes;
  bus_.Publish(channel::kSession, session.session);
  bus_.Publish(channel::kScene, session.scene);
  bus_.Publish(channel::kRunRecord, session.record);
  httplib::Client client("127.0.0.1", port_);
  client.set_read_timeout(10, 0);
  std::string text;
  int num_pieces = 0;
  bool is_first = true;
  const auto listen = [&](const char* data, std::size_t size) {
    text.append(data, size);
    if (is_first && text.find(content) != std::string::npos) {
      is_first = false;
      session.record.request_id = "another";
      bus_.Publish(channel::kRunRecord, session.record);
    }
    return ++num_pieces < 20 && text.find(left_out) == std::string::npos;
  };
  client.Get("/events", listen);
  EXPECT_NE(text.find(left_out), std::string::npos) << text;
  EXPECT_EQ(text.find(content), text.rfind(content)) << text;
}

TEST_F(LiveServerTest, APortInUseIsRefused) {
  ExpectInputError([&] { LiveServer(&bus_, "", port_); },
                   {"--port", "127.0.0.1:" + std::to_string(port_)});
}

}  // namespace
}  // namespace planbench
