#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace planbench {

/// Starts a process that does nothing, without the files and sockets of this one.
inline pid_t StartProcess() {
  const pid_t pid = fork();
  if (pid == 0) {
    for (int file = STDERR_FILENO + 1; file < 1024; ++file) close(file);
    pause();
    _exit(0);
  }
  return pid;
}

inline void EndProcess(pid_t pid) {
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
}

}  // namespace planbench
