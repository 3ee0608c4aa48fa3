#include "benchmark_driver/supervisor.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <utility>

#include "benchmark_driver/machine.h"
#include "common/error.h"
#include "common/text.h"

namespace planbench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kExitPoll{20};
constexpr std::chrono::milliseconds kRestartDelay{200};
constexpr std::size_t kMostLastWords = 200;  // bytes
constexpr std::size_t kEndsKept = 8;

/// Of what a log holds from byte `begin` on: before it are others' words. Printable: a child may
/// have said anything.
std::string LastLine(const std::filesystem::path& log, off_t begin) {
  constexpr off_t kMostRead = 4096;
  std::ifstream file(log);
  file.seekg(0, std::ios::end);
  file.seekg(std::max(begin, static_cast<off_t>(file.tellg()) - kMostRead));
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) last = line;
  }
  return last.empty() ? "(it said nothing)" : Printable(last);
}

/// The log, to be appended to; where that cannot be, what takes anything: a child's words are not
/// for our terminal.
int OpenLog(const ChildSpec& spec) {
  const int log = open(spec.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (log >= 0) return log;
  spdlog::error("{} cannot be written, what {} says is lost: {}", spec.log.string(), spec.name,
                std::strerror(errno));
  return open("/dev/null", O_WRONLY | O_CLOEXEC);
}

std::string DescribeSignal(int number) {
  return fmt::format("signal {} ({})", number, strsignal(number));
}

std::string DescribeEnd(int status) {
  if (WIFSIGNALED(status)) return fmt::format("by {}", DescribeSignal(WTERMSIG(status)));
  const int code = WEXITSTATUS(status);
  // So a shell tells of what it runs, and by shells commands are run.
  const int number = code - 128;
  if (number < 1 || number >= SIGRTMIN) return fmt::format("with exit code {}", code);
  return fmt::format("with exit code {}, as by {}", code, DescribeSignal(number));
}

/// By somebody, as who ends a job tells all its processes: so end our programs, and whatever does
/// not handle the signal.
bool WasToldToEnd(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) == 0 : WTERMSIG(status) == SIGTERM;
}

}  // namespace

Supervisor::Supervisor(std::chrono::milliseconds most_silence)
    : most_silence_(most_silence), thread_([this] { Supervise(); }) {}

Supervisor::~Supervisor() {
  StopAll({});
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  thread_.join();
}

void Supervisor::Start(ChildSpec spec) {
  const std::scoped_lock lock(mutex_);
  Child child;
  child.spec = std::move(spec);
  child.restart_at = Clock::now();
  children_.push_back(std::move(child));
}

void Supervisor::StartAgain(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  Child* child = Find(name);
  if (child == nullptr || child->pid < 0) return;
  spdlog::error("killing {}, to start it again", name);
  Kill(child);
}

void Supervisor::Renew(const std::string& name, std::chrono::milliseconds patience) {
  const std::scoped_lock lock(mutex_);
  Child* child = Find(name);
  if (child == nullptr || child->pid < 0) return;
  kill(-child->pid, SIGTERM);
  child->time_to_end = patience;
}

int Supervisor::NumFailuresAtWork(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  const Child* child = Find(name);
  return child == nullptr ? 0 : child->num_failures_at_work;
}

std::string Supervisor::HowEnded(const std::string& name, Clock::time_point since) {
  const std::scoped_lock lock(mutex_);
  const Child* child = Find(name);
  if (child == nullptr) return "";
  const auto is_since = [&](const auto& end) { return end.first >= since; };
  const auto first = std::find_if(child->ends.begin(), child->ends.end(), is_since);
  return first == child->ends.end() ? "" : first->second;
}

void Supervisor::CameUp(const std::string& name, std::optional<pid_t> pid) {
  const std::scoped_lock lock(mutex_);
  Child* child = Find(name);
  if (child == nullptr || (pid && child->pid != *pid)) return;
  child->quick_deaths = 0;
  child->came_up = true;
}

void Supervisor::Heard(const std::string& name, pid_t pid) {
  const std::scoped_lock lock(mutex_);
  Child* child = Find(name);
  if (child != nullptr && child->pid == pid) child->silence.emplace(0);
}

void Supervisor::HeardMyself() {
  const std::scoped_lock lock(mutex_);
  own_silence_.emplace(0);
}

std::map<std::string, std::string> Supervisor::Hopeless() const {
  const std::scoped_lock lock(mutex_);
  std::map<std::string, std::string> reasons;
  for (const Child& child : children_) {
    if (!child.hopeless.empty()) reasons[child.spec.name] = child.hopeless;
  }
  return reasons;
}

void Supervisor::ThrowIfHopeless(const std::set<std::string>& spared) const {
  const std::scoped_lock lock(mutex_);
  for (const Child& child : children_) {
    if (child.hopeless.empty() || spared.contains(child.spec.name)) continue;
    if (child.bad_input) throw InputError(child.hopeless);
    throw std::runtime_error(child.hopeless);
  }
}

void Supervisor::Supervise() {
  while (true) {
    {
      const std::scoped_lock lock(mutex_);
      if (stopping_) return;
      if (own_silence_) *own_silence_ += kExitPoll;
      for (Child& child : children_) {
        if (child.pid > 0) Reap(&child);
        if (child.pid > 0) KillIfSilent(&child);
        if (child.pid > 0) KillIfItStays(&child);
        if (child.pid < 0 && child.wanted && Clock::now() >= child.restart_at) Spawn(&child);
      }
    }
    std::this_thread::sleep_for(kExitPoll);
  }
}

void Supervisor::Reap(Child* child) {
  siginfo_t end = {};
  if (waitid(P_PID, static_cast<id_t>(child->pid), &end, WEXITED | WNOHANG | WNOWAIT) != 0 ||
      end.si_pid != child->pid) {
    return;
  }
  // Before its id can be given to another: what is left of its group, say the program that a shell
  // script runs.
  kill(-child->pid, SIGKILL);
  int status = 0;
  waitpid(child->pid, &status, 0);
  child->pid = -1;
  child->silence.reset();
  if (!child->wanted) return;
  const bool was_at_work = std::exchange(child->came_up, false);
  const bool was_killed = std::exchange(child->killed_here, false);
  child->ends.emplace_back(Clock::now(),
                           DescribeEnd(status) + (was_killed ? ", sent by the driver" : ""));
  if (child->ends.size() > kEndsKept) child->ends.pop_front();
  if (std::exchange(child->time_to_end, std::nullopt)) {
    child->restart_at = Clock::now();
    return;
  }
  child->num_failures_at_work += was_at_work && !was_killed && !WasToldToEnd(status);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 2) {
    child->wanted = false;
    child->bad_input = true;
    // Several contestants may have one program, which names itself.
    const bool is_named = child->spec.arguments.front().ends_with(child->spec.name);
    child->hopeless = fmt::format("{}{}", is_named ? "" : child->spec.name + ": ",
                                  LastLine(child->spec.log, child->log_begin));
    return;
  }
  const std::string last_words =
      fmt::format("its last words in {}: {}", child->spec.log.string(),
                  Abridged(LastLine(child->spec.log, child->log_begin), kMostLastWords));
  const auto now = Clock::now();
  child->quick_deaths = now - child->started < kQuick ? child->quick_deaths + 1 : 0;
  if (child->quick_deaths >= kMaxQuickDeaths) {
    child->wanted = false;
    const bool ended_well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    child->hopeless = fmt::format(
        "{} ended {} again and again{}; {}", child->spec.name, DescribeEnd(status),
        ended_well ? ": a command must run as long as its planner, which ends with it" : "",
        last_words);
    return;
  }
  spdlog::error("{} ended {}; starting it again; {}", child->spec.name, DescribeEnd(status),
                last_words);
  child->restart_at = now + kRestartDelay;
}

void Supervisor::KillIfSilent(Child* child) const {
  if (!child->wanted || !child->silence) return;
  if (own_silence_ && *own_silence_ >= most_silence_ / 4) return;
  // No clock is asked: while this process itself is stopped, nobody is silent.
  if ((*child->silence += kExitPoll) < most_silence_) return;
  spdlog::error("{} has been silent for {:g} s; killing it", child->spec.name,
                std::chrono::duration<double>(most_silence_).count());
  child->num_failures_at_work += child->came_up;
  Kill(child);
}

void Supervisor::KillIfItStays(Child* child) {
  if (!child->wanted || !child->time_to_end || child->killed_here) return;
  // No clock is asked here either.
  if ((*child->time_to_end -= kExitPoll) > std::chrono::milliseconds(0)) return;
  spdlog::error("{} does not end, to be started anew; killing it", child->spec.name);
  Kill(child);
}

void Supervisor::Kill(Child* child) {
  kill(-child->pid, SIGKILL);
  child->killed_here = true;
  child->silence.reset();
}

void Supervisor::Spawn(Child* child) {
  std::vector<char*> arguments;
  for (std::string& argument : child->spec.arguments) arguments.push_back(argument.data());
  if (child->was_started) {
    for (std::string& argument : child->spec.when_again) arguments.push_back(argument.data());
  }
  arguments.push_back(nullptr);
  // All that allocates is done before fork: other threads may hold the allocator's lock.
  std::vector<std::string> environment_text;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    if (child->spec.environment.count(text.substr(0, text.find('='))) == 0) {
      environment_text.push_back(text);
    }
  }
  for (const auto& [key, value] : child->spec.environment) {
    environment_text.push_back(key + "=" + value);
  }
  std::vector<char*> environment;
  for (std::string& entry : environment_text) environment.push_back(entry.data());
  environment.push_back(nullptr);
  const int output = OpenLog(child->spec);
  child->log_begin = std::max<off_t>(0, lseek(output, 0, SEEK_END));
  const pid_t parent = getpid();

  // Until the child has put its signal handling in order it must not take a signal: it would run
  // our handler, and the signal that was to end it would be lost.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t pid = fork();
  if (pid == 0) {
    setpgid(0, 0);
    for (const int handled : {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ}) signal(handled, SIG_DFL);
    // What is to outlive its terminal (nohup) is to do so with its children.
    if (signal(SIGHUP, SIG_DFL) == SIG_IGN) signal(SIGHUP, SIG_IGN);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    sigprocmask(SIG_SETMASK, &before, nullptr);
    if (getppid() != parent) _exit(1);  // the parent died before the death signal was set
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    close_range(3, ~0U, 0);  // our connection to the bus among others
    const int input = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (input >= 0) dup2(input, STDIN_FILENO);
    if (!child->spec.processors.empty()) UseProcessors(child->spec.processors);
    execve(arguments[0], arguments.data(), environment.data());
    dprintf(STDERR_FILENO, "%s: cannot be started: %s\n", arguments[0], strerror(errno));
    _exit(2);
  }
  const int fork_error = errno;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  close(output);
  if (pid < 0) {
    spdlog::error("cannot start {}: {}", child->spec.name, strerror(fork_error));
    child->restart_at = Clock::now() + std::chrono::seconds(1);
    return;
  }
  setpgid(pid, pid);  // here too: it must be done before anybody signals the group
  child->pid = pid;
  child->was_started = true;
  child->started = Clock::now();
}

Supervisor::Child* Supervisor::Find(const std::string& name) {
  const auto child = std::find_if(children_.begin(), children_.end(),
                                  [&](const Child& c) { return c.spec.name == name; });
  return child == children_.end() ? nullptr : &*child;
}

void Supervisor::StopAll(const std::vector<std::string>& order,
                         std::chrono::milliseconds patience) {
  std::vector<std::string> names = order;
  {
    const std::scoped_lock lock(mutex_);
    for (auto child = children_.rbegin(); child != children_.rend(); ++child) {
      child->wanted = false;
      if (std::find(names.begin(), names.end(), child->spec.name) == names.end()) {
        names.push_back(child->spec.name);
      }
    }
  }
  for (const std::string& name : names) {
    std::optional<Clock::time_point> asked, killed;
    while (true) {
      {
        const std::scoped_lock lock(mutex_);
        Child* child = Find(name);
        if (child == nullptr || child->pid < 0) break;
        if (!asked) {
          kill(-child->pid, SIGTERM);
          asked = Clock::now();
        } else if (!killed && Clock::now() - *asked > patience) {
          spdlog::error("{} does not end; killing it", name);
          kill(-child->pid, SIGKILL);
          killed = Clock::now();
        } else if (killed && Clock::now() - *killed > death_patience) {
          spdlog::error(
              "{} (pid {}) was killed and has not ended: a debugger or a disk may hold it", name,
              child->pid);
          child->pid = -1;
        }
      }
      std::this_thread::sleep_for(kExitPoll);
    }
  }
}

}  // namespace planbench
