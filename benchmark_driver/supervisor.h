#pragma once

#include <sys/types.h>

#include <chrono>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace planbench {

/// A child process to keep running.
struct ChildSpec {
  std::string name;
  std::vector<std::string> arguments;              ///< arguments[0]: the program's path.
  std::map<std::string, std::string> environment;  ///< Added to ours.
  std::filesystem::path log;                       ///< Takes its stdout and stderr, appended.
  std::vector<std::string> when_again = {};        ///< Added when it is started again.
  std::vector<int> processors = {};                ///< That it may use; empty: as this process.
};

/// Starts child processes, restarts those that die, and stops all in the end. Children do not get
/// the terminal's Ctrl-C (each is a process group of its own), and are ended by the kernel if this
/// process dies. What a child has started itself is ended with it, if it stayed in its group.
class Supervisor {
 public:
  /// `most_silence`: after it a child that had been heard is killed, and started again.
  explicit Supervisor(std::chrono::milliseconds most_silence = kMostSilence);
  /// Stops what still runs.
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  void Start(ChildSpec spec);
  /// Asks the children to end (SIGTERM) in the given order, each waited for up to `patience`, then
  /// killed. Others follow, the last started first. What even then does not end within
  /// `death_patience`, as one that a debugger or a disk holds, is named and left behind.
  void StopAll(const std::vector<std::string>& order,
               std::chrono::milliseconds patience = std::chrono::seconds(10));
  /// That child's process does its work, so that it will not have died of its start: quick deaths
  /// until now do not count. `pid`: of who does it; nothing where that is not the child itself.
  void CameUp(const std::string& name, std::optional<pid_t> pid = std::nullopt);
  /// That child is heard, by the process of that id. One that is never heard may be silent.
  void Heard(const std::string& name, pid_t pid);
  /// This process is heard by the same ears. Once it was, nobody is silent while these do not hear
  /// it, be it that they wait for a disk.
  void HeardMyself();
  /// Why children, by name, are not started again: one ended with exit code 2 (bad input: a restart
  /// would not help), or died kMaxQuickDeaths times in a row within kQuick of its start.
  std::map<std::string, std::string> Hopeless() const;
  /// Throws for a hopeless child, but for the `spared`: InputError with its last words for bad
  /// input, else std::runtime_error.
  void ThrowIfHopeless(const std::set<std::string>& spared = {}) const;
  /// Kills that child, which is started again.
  void StartAgain(const std::string& name);
  /// Asks that child to end (SIGTERM), kills it after `patience`, and starts it anew as soon as it
  /// has ended: no failure of its, however it ends. Returns at once.
  void Renew(const std::string& name,
             std::chrono::milliseconds patience = std::chrono::seconds(10));
  /// How often that child, after it had come up, died, unless it was told to end, or fell silent.
  int NumFailuresAtWork(const std::string& name);
  /// How that child ended the first time since then (of the last times): "with exit code 3"; "" if
  /// it has not.
  std::string HowEnded(const std::string& name, std::chrono::steady_clock::time_point since);

  /// How long a child that was killed may take to be gone.
  std::chrono::milliseconds death_patience{10'000};

  static constexpr int kMaxQuickDeaths = 5;
  static constexpr std::chrono::seconds kQuick{5};
  static constexpr std::chrono::seconds kMostSilence{10};

 private:
  struct Child {
    ChildSpec spec;
    pid_t pid = -1;  // -1: not running
    bool wanted = true;
    bool was_started = false;
    int quick_deaths = 0;
    bool came_up = false;  // this process
    /// Since this process was last heard; nothing if it never was.
    std::optional<std::chrono::milliseconds> silence;
    bool killed_here = false;  // this process
    /// Until this process is killed if it has not ended, to be started anew; nothing if it is not.
    std::optional<std::chrono::milliseconds> time_to_end;
    int num_failures_at_work = 0;
    bool bad_input = false;
    std::string hopeless;  // why, if it is
    /// When and how it ended, the last times.
    std::deque<std::pair<std::chrono::steady_clock::time_point, std::string>> ends;
    off_t log_begin = 0;  // of the log, where this process began to write
    std::chrono::steady_clock::time_point started;
    std::chrono::steady_clock::time_point restart_at;
  };
  Child* Find(const std::string& name);
  void Supervise();
  void Reap(Child* child);
  void KillIfSilent(Child* child) const;
  static void KillIfItStays(Child* child);
  static void Kill(Child* child);
  void Spawn(Child* child);

  const std::chrono::milliseconds most_silence_;
  std::optional<std::chrono::milliseconds> own_silence_;  // nothing if this process was never heard
  mutable std::mutex mutex_;
  std::vector<Child> children_;
  bool stopping_ = false;
  std::thread
      thread_;  // starts every child: the kernel's death signal is tied to the starting thread
};

}  // namespace planbench
