// The clock of another host for one process and its children: preloaded (LD_PRELOAD), the time of
// day is an hour ahead.

#include <dlfcn.h>
#include <time.h>

extern "C" int clock_gettime(clockid_t clock, timespec* time) {
  using GetTime = int (*)(clockid_t, timespec*);
  static const auto real = reinterpret_cast<GetTime>(dlsym(RTLD_NEXT, "clock_gettime"));
  const int result = real(clock, time);
  if (result == 0 && clock == CLOCK_REALTIME) time->tv_sec += 3600;
  return result;
}
