#include "benchmark_driver/local_process.h"

#include <fmt/format.h>
#include <signal.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <system_error>

#include "messaging/node_announcer.h"

namespace planbench {
namespace {

namespace fs = std::filesystem;

/// Of the sockets of a UDP port, in the network that a process is in, what links to them say.
std::set<std::string> SocketsOf(std::uint16_t port, const fs::path& process) {
  std::set<std::string> sockets;
  // The second has those of Java, which speak IPv4 as well.
  for (const char* protocol : {"udp", "udp6"}) {
    std::ifstream table(process / "net" / protocol);
    std::string line;
    std::getline(table, line);  // names of the columns
    while (std::getline(table, line)) {
      // slot, local address, remote one, state, queues, timer, retransmissions, user, timeout,
      // inode
      std::string slot, local, skipped, inode;
      std::istringstream columns(line);
      columns >> slot >> local;
      for (int column = 2; column < 9; ++column) columns >> skipped;
      if (columns >> inode && local.ends_with(fmt::format(":{:04X}", port))) {
        sockets.insert(fmt::format("socket:[{}]", inode));
      }
    }
  }
  return sockets;
}

}  // namespace

bool IsRunning(std::int32_t pid) {
  return pid > 0 && (kill(static_cast<pid_t>(pid), 0) == 0 || errno != ESRCH);
}

bool IsSeenHere(const NodeRegistry::Node& node) {
  if (node.status.host != HostName() || !IsRunning(node.status.pid)) return false;
  if (node.sender == PacketSender()) return true;  // off no network: the bus is this process's own
  const fs::path process = fs::path("/proc") / fmt::format("{}", node.status.pid);
  const std::set<std::string> sockets = SocketsOf(node.sender.port, process);
  std::error_code error;
  for (fs::directory_iterator file(process / "fd", error), end; !error && file != end;
       file.increment(error)) {
    std::error_code closed;
    if (sockets.contains(fs::read_symlink(file->path(), closed).string())) return true;
  }
  return false;
}

}  // namespace planbench
