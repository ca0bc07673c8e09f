// clock: CLOCK_MONOTONIC in ns.
#include <time.h>

#include <cstdio>

int main() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  std::printf("%lld\n", now.tv_sec * 1'000'000'000LL + now.tv_nsec);
}
