#include "viewer/live_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <thread>

#include "common/error.h"
#include "viewer/live_page.h"

namespace planbench {

struct LiveServer::Http {
  httplib::Server server;
  std::atomic<bool> stopping = false;
  int port = 0;
  std::thread thread;
};

namespace {

constexpr char kAddress[] = "127.0.0.1";
constexpr std::chrono::milliseconds kLookPeriod{100};
constexpr int kLooksPerState = 5;

std::string Event(const char* name, const Json& data) {
  return fmt::format("event: {}\ndata: {}\n\n", name,
                     data.dump(-1, ' ', false, Json::error_handler_t::replace));
}

/// The meshes that a page holds, by id: in how many more views they may be missing. Contestants
/// take turns, and not all are checked by meshes.
using HeldMeshes = std::map<std::string, int>;
constexpr int kViewsHeld = 16;

/// Leaves null of the meshes that the page holds, and names all that it is to hold on to: those of
/// a robot can be megabytes, and requests take milliseconds.
void LeaveOutMeshes(HeldMeshes* held, Json* view) {
  if (!view->contains("meshes")) return;
  for (auto& [id, views_left] : *held) --views_left;
  Json& meshes = (*view)["meshes"];
  for (auto& [id, mesh] : meshes.items()) {
    if (!held->insert_or_assign(id, kViewsHeld).second) mesh = nullptr;
  }
  std::erase_if(*held, [](const auto& one) { return one.second == 0; });
  for (const auto& [id, views_left] : *held) {
    if (!meshes.contains(id)) meshes[id] = nullptr;
  }
}

}  // namespace

LiveServer::LiveServer(Bus* bus, const std::filesystem::path& robot_folder, int port,
                       const std::map<std::string, std::filesystem::path>& packages)
    : bus_(bus), session_(robot_folder, packages), http_(std::make_unique<Http>()) {
  httplib::Server& server = http_->server;
  // cpp-httplib would share the port with whoever has it.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  // Every page that is open holds a connection.
  server.new_task_queue = [] { return new httplib::ThreadPool(32); };
  server.set_pre_routing_handler(
      [this](const httplib::Request& request, httplib::Response& response) {
        // Another site's name that resolves to this machine must not read the bus.
        const std::string host = request.get_header_value("Host");
        const std::string suffix = fmt::format(":{}", http_->port);
        if (host == kAddress + suffix || host == "localhost" + suffix) {
          return httplib::Server::HandlerResponse::Unhandled;
        }
        response.status = 403;
        return httplib::Server::HandlerResponse::Handled;
      });
  server.Get("/", [page = LivePage()](const httplib::Request&, httplib::Response& response) {
    response.set_content(page, "text/html; charset=utf-8");
  });
  server.Get("/events", [this](const httplib::Request&, httplib::Response& response) {
    response.set_header("Cache-Control", "no-store");
    response.set_chunked_content_provider(
        "text/event-stream", [this, shown = std::int64_t{-1}, look = 0, held = HeldMeshes()](
                                 std::size_t, httplib::DataSink& sink) mutable {
          std::optional<Json> state, view;
          {
            const std::scoped_lock lock(mutex_);
            if (look++ % kLooksPerState == 0) {
              state = session_.State(std::chrono::steady_clock::now(), bus_->counters());
            }
            if (session_.view_number() != shown) {
              shown = session_.view_number();
              view = session_.View();
            }
          }
          std::string text;
          if (state) text += Event("state", *state);
          if (view) {
            LeaveOutMeshes(&held, &*view);
            text += Event("view", *view);
          }
          if (!text.empty() && !sink.write(text.data(), text.size())) return false;
          std::this_thread::sleep_for(kLookPeriod);
          return !http_->stopping.load();
        });
  });
  if (port == 0) {
    http_->port = server.bind_to_any_port(kAddress);
  } else if (server.bind_to_port(kAddress, port)) {
    http_->port = port;
  }
  if (http_->port <= 0) {
    throw InputError(fmt::format("--port: cannot listen on {}:{}; is it in use?", kAddress, port));
  }
  constexpr int kUnbounded = 0;
  everything_ = bus->SubscribeToAll(
      [this](const ReceivedMessage& message) {
        const std::scoped_lock lock(mutex_);
        session_.Hear(message, std::chrono::steady_clock::now());
      },
      kUnbounded);
  http_->thread = std::thread([this] { http_->server.listen_after_bind(); });
  while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

LiveServer::~LiveServer() {
  everything_ = Subscription();
  http_->stopping = true;
  http_->server.stop();
  http_->thread.join();
}

std::string LiveServer::url() const { return fmt::format("http://{}:{}/", kAddress, http_->port); }

}  // namespace planbench
