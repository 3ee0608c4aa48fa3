#include "benchmark_driver/machine.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "collision/collision_checker.h"
#include "common/lookup.h"

namespace planbench {
namespace {

/// Below, what a run waited is what every thread waits when it is woken.
constexpr double kLeastDisturbance = 1e-3;  // s

std::string FirstLine(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

std::string CpuName(const std::filesystem::path& proc) {
  std::ifstream info(proc / "cpuinfo");
  // ARM's processors have numbers in the place of a name, and may be of several kinds.
  std::string implementer;
  std::set<std::string> parts;
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    const std::string value = line.substr(colon + 2);
    if (line.starts_with("model name")) return value;
    if (line.starts_with("CPU implementer")) implementer = value;
    if (line.starts_with("CPU part")) {
      parts.insert(fmt::format("ARM implementer {} part {}", implementer, value));
    }
  }
  return parts.empty() ? "unknown" : fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

std::map<std::string, std::string> DescribeMachine(const KernelFolders& kernel) {
  std::map<std::string, std::string> machine = {
      {"cpu", fmt::format("{} [{}]", CpuName(kernel.proc), VectorInstructions())},
      {"processors", fmt::format("{}", sysconf(_SC_NPROCESSORS_ONLN))}};
  std::istringstream load(FirstLine(kernel.proc / "loadavg"));
  std::string minutes, five_minutes, quarter;
  if (load >> minutes >> five_minutes >> quarter) {
    machine["load"] = fmt::format("{} {} {}", minutes, five_minutes, quarter);
  }
  std::set<std::string> governors;
  std::error_code none;
  for (const auto& cpu :
       std::filesystem::directory_iterator(kernel.sys / "devices/system/cpu", none)) {
    const std::string governor = FirstLine(cpu.path() / "cpufreq/scaling_governor");
    if (!governor.empty()) governors.insert(governor);
  }
  if (!governors.empty()) machine["governor"] = fmt::format("{}", fmt::join(governors, ", "));
  return machine;
}

DisturbanceMeter::DisturbanceMeter(std::vector<pid_t> pids, KernelFolders kernel)
    : kernel_(std::move(kernel)), pids_(std::move(pids)) {
  double load = 0;
  if (std::istringstream(FirstLine(kernel_.proc / "loadavg")) >> load) load_ = load;
  waiting_s_ = WaitingByThread();
  steal_s_ = Steal();
}

void DisturbanceMeter::Read(double run_s, std::map<std::string, double>* counters) const {
  for (const char* name : {"load_before", "waiting_time", "steal_time", "disturbed", "repeats"}) {
    counters->erase(name);
  }
  if (load_) (*counters)["load_before"] = *load_;
  const std::map<std::string, double> waiting_s = WaitingByThread();
  if (!waiting_s.empty()) {
    double sum = 0;
    for (const auto& [thread, now] : waiting_s) {
      // The kernel books a wait when it ends: one that began long before the run ends in it.
      sum += std::min(now - Lookup(waiting_s_, thread).value_or(0), run_s);
    }
    (*counters)["waiting_time"] = sum;
  }
  const std::optional<double> steal_s = Steal();
  if (steal_s && steal_s_) (*counters)["steal_time"] = *steal_s - *steal_s_;
}

std::map<std::string, double> DisturbanceMeter::WaitingByThread() const {
  std::map<std::string, double> waiting;
  std::error_code none;
  for (const pid_t pid : pids_) {
    const auto threads = kernel_.proc / fmt::format("{}", pid) / "task";
    for (const auto& thread : std::filesystem::directory_iterator(threads, none)) {
      double running_ns = 0, waiting_ns = 0;
      std::istringstream line(FirstLine(thread.path() / "schedstat"));
      if (line >> running_ns >> waiting_ns) {
        waiting[thread.path().filename().string()] = waiting_ns * 1e-9;
      }
    }
  }
  return waiting;
}

std::optional<double> DisturbanceMeter::Steal() const {
  // cpu  user nice system idle iowait irq softirq steal ..., of all processors, in ticks.
  std::istringstream line(FirstLine(kernel_.proc / "stat"));
  std::string name;
  line >> name;
  double steal = 0;
  for (int i = 0; i < 8; ++i) line >> steal;
  if (!line || name != "cpu") return std::nullopt;
  return steal / static_cast<double>(sysconf(_SC_CLK_TCK) * sysconf(_SC_NPROCESSORS_ONLN));
}

bool IsDisturbed(const std::map<std::string, double>& counters, double run_s, double limit) {
  double lost_s = 0;
  for (const char* name : {"waiting_time", "steal_time"}) {
    lost_s += Lookup(counters, name).value_or(0);
  }
  return lost_s > kLeastDisturbance && lost_s > limit * run_s;
}

std::vector<int> UsableProcessors() {
  cpu_set_t set;
  std::vector<int> processors;
  if (sched_getaffinity(0, sizeof(set), &set) != 0) return processors;
  for (int i = 0; i < CPU_SETSIZE; ++i) {
    if (CPU_ISSET(i, &set)) processors.push_back(i);
  }
  return processors;
}

bool UseProcessors(const std::vector<int>& processors) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int processor : processors) CPU_SET(processor, &set);
  return sched_setaffinity(0, sizeof(set), &set) == 0;
}

}  // namespace planbench
