#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace planbench {

/// Where the kernel tells of processes, and of devices.
struct KernelFolders {
  std::filesystem::path proc = "/proc";
  std::filesystem::path sys = "/sys";
};

/// What this machine is and does: its model of processor and the vector instructions that planbench
/// uses there ("cpu": "NAME [AVX2]"), number of processors, their frequency governors, the load
/// averages of the last 1, 5 and 15 minutes. What it does not tell is left out.
std::map<std::string, std::string> DescribeMachine(const KernelFolders& kernel);

/// What kept processes from working while something was measured, from construction on.
class DisturbanceMeter {
 public:
  /// `pids`: none if a process is on another machine: then it is not known what it waits for.
  DisturbanceMeter(std::vector<pid_t> pids, KernelFolders kernel);

  /// Puts in the place of what a planner may have said of it, as far as the kernel tells:
  ///   load_before: load average of the minute before, this session's own included;
  ///   waiting_time: s in which threads of the processes could have run and had no processor,
  ///   summed, of each no more than `run_s`, what the run took; steal_time: s that the hypervisor
  ///   took, mean over the processors, in steps of 10 ms.
  void Read(double run_s, std::map<std::string, double>* counters) const;

 private:
  std::map<std::string, double> WaitingByThread() const;
  std::optional<double> Steal() const;

  KernelFolders kernel_;
  std::vector<pid_t> pids_;
  std::optional<double> load_;
  std::map<std::string, double> waiting_s_;  // at the beginning, by thread
  std::optional<double> steal_s_;
};

/// True if the process could not work for more than `limit` of a run's time, and for more than 1
/// ms.
bool IsDisturbed(const std::map<std::string, double>& counters, double run_s, double limit);

/// Processors that this process may use, ascending.
std::vector<int> UsableProcessors();
/// Keeps this thread, and those and processes that it starts from now on, to processors. Safe
/// between fork and exec. False if that cannot be.
bool UseProcessors(const std::vector<int>& processors);

}  // namespace planbench
