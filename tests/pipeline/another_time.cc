// The clock of another host for one process and its children: preloaded (LD_PRELOAD), the time of
// day is an hour ahead; or one that is set: an hour back once there is the file that
// PLANBENCH_SET_BACK_BY names.

#include <dlfcn.h>
#include <time.h>
#include <unistd.h>

#include <cstdlib>

extern "C" int clock_gettime(clockid_t clock, timespec* time) {
  using GetTime = int (*)(clockid_t, timespec*);
  static const auto real = reinterpret_cast<GetTime>(dlsym(RTLD_NEXT, "clock_gettime"));
  const int result = real(clock, time);
  if (result != 0 || clock != CLOCK_REALTIME) return result;
  if (const char* file = std::getenv("PLANBENCH_SET_BACK_BY"); file == nullptr) {
    time->tv_sec += 3600;
  } else if (access(file, F_OK) == 0) {
    time->tv_sec -= 3600;
  }
  return result;
}
