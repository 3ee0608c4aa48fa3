// A scene server that fails at one thing, however often it is started again: preloaded
// (LD_PRELOAD), the process stops (SIGSTOP) where it is to send a datagram that holds the text in
// the file PLANBENCH_FAILS_AT, while there is one. With PLANBENCH_FAILS_BY=silence it goes on
// instead, as if that had been sent.

#include <dlfcn.h>
#include <signal.h>
#include <string.h>
#include <sys/socket.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace {

using SendMessage = ssize_t (*)(int, const msghdr*, int);

/// The text, "" if there is none.
std::string FailsAt() {
  const char* file = std::getenv("PLANBENCH_FAILS_AT");
  std::string text;
  if (file != nullptr) std::getline(std::ifstream(file), text);
  return text;
}

}  // namespace

// In the place of the system's, for LCM, which sends by it.
extern "C" ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  static const auto original = reinterpret_cast<SendMessage>(dlsym(RTLD_NEXT, "sendmsg"));
  const std::string text = FailsAt();
  ssize_t size = 0;
  bool fails = false;
  for (std::size_t i = 0; i < message->msg_iovlen; ++i) {
    const iovec& part = message->msg_iov[i];
    size += static_cast<ssize_t>(part.iov_len);
    fails = fails || (!text.empty() &&
                      memmem(part.iov_base, part.iov_len, text.data(), text.size()) != nullptr);
  }
  const char* by = std::getenv("PLANBENCH_FAILS_BY");
  if (fails && by != nullptr && std::string(by) == "silence") return size;
  if (fails) raise(SIGSTOP);  // this thread's, so that it is not sent first
  return original(socket, message, flags);
}
