#pragma once

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

namespace planbench {

/// What `f` returns in a network without interfaces that are up, in a process of its own; nothing
/// if this process may not make one.
inline std::optional<std::string> InOwnNetwork(const std::function<std::string()>& f) {
  int channel[2];
  if (pipe(channel) != 0) throw std::runtime_error("pipe failed");
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("fork failed");
  if (pid == 0) {
    if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) _exit(77);
    const std::string said = f();
    _exit(write(channel[1], said.data(), said.size()) == static_cast<ssize_t>(said.size()) ? 0 : 1);
  }
  close(channel[1]);
  std::string said;
  char buffer[4096];
  for (ssize_t n = 0; (n = read(channel[0], buffer, sizeof(buffer))) > 0;) {
    said.append(buffer, static_cast<std::size_t>(n));
  }
  close(channel[0]);
  int status = 0;
  waitpid(pid, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) return std::nullopt;
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  return said;
}

/// Runs commands of the shell, as for such a network; false if one failed, as where the user may
/// not use `ip`.
inline bool RunsInShell(const std::string& commands) {
  return std::system(("exec 2>/dev/null; " + commands).c_str()) == 0;
}

/// Makes an interface 'wire' that leads out of the machine, up and with an address.
inline constexpr char kMakeWire[] =
    "ip link add wire type veth peer name end && ip address add 10.9.8.1/24 dev wire && "
    "ip link set wire up && ip link set end up";
/// The multicast route by it.
inline constexpr char kRouteByWire[] = "ip route replace 224.0.0.0/4 dev wire";

}  // namespace planbench
