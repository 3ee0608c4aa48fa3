#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "messaging/bus.h"
#include "viewer/live_session.h"

namespace planbench {

/// Serves LivePage on this machine alone (127.0.0.1), and at /events what happens on a bus as
/// server-sent events: `state` (LiveSession::State) twice a second, `view` (LiveSession::View) when
/// it has changed. A view's meshes name all that the page is to hold for it and for later ones;
/// null stands for those that the view before it named.
class LiveServer {
 public:
  /// `port` 0: any that is free; `robot_folder`, `packages`: LiveSession's. Throws InputError if
  /// the port cannot be had, or for a robot folder that is none.
  LiveServer(Bus* bus, const std::filesystem::path& robot_folder, int port,
             const std::map<std::string, std::filesystem::path>& packages = {});
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// "http://127.0.0.1:8080/"
  std::string url() const;

 private:
  struct Http;
  Bus* bus_;
  std::mutex mutex_;
  LiveSession session_;
  std::unique_ptr<Http> http_;
  Subscription everything_;
};

}  // namespace planbench
