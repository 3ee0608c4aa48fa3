#include "common/standard_output.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace planbench {
namespace {

/// Of a pipe, a socket or a terminal. Asked now, since the error of an earlier write is forgotten.
bool ReaderHasGone() {
  pollfd out = {STDOUT_FILENO, POLLOUT, 0};
  return poll(&out, 1, 0) > 0 && (out.revents & (POLLERR | POLLHUP)) != 0;
}

}  // namespace

void WriteOut(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); }

std::string StandardOutputFault() {
  const int error = std::fflush(stdout) == 0 ? 0 : errno;
  std::cout.flush();  // second: it writes by way of stdout and would hide the error
  if (error == 0 && std::ferror(stdout) == 0 && std::cout.good()) return "";
  if (ReaderHasGone()) return "";
  const std::string fault = "standard output could not be written";
  return error == 0 ? fault : fault + ": " + std::strerror(error);
}

}  // namespace planbench
