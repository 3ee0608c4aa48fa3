#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

namespace planbench {

/// Starts a process that does nothing, without the files and sockets of this one, and returns its
/// id when it is rid of them.
inline pid_t StartProcess() {
  int rid[2];
  if (pipe(rid) != 0) throw std::runtime_error("pipe failed");
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("fork failed");
  if (pid == 0) {
    for (int file = STDERR_FILENO + 1; file < 1024; ++file) {
      if (file != rid[1]) close(file);
    }
    close(rid[1]);
    pause();
    _exit(0);
  }
  close(rid[1]);
  char unused = 0;
  while (read(rid[0], &unused, 1) > 0) {
  }
  close(rid[0]);
  return pid;
}

inline void EndProcess(pid_t pid) {
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
}

}  // namespace planbench
