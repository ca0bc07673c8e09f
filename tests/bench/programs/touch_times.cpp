// touch_times DEVICE COUNT: waits for COUNT new touches and prints the kernel's CLOCK_MONOTONIC time (ns) at
// which each began.
#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "touch_times DEVICE COUNT\n"), 2;
  const int fd = ::open(argv[1], O_RDONLY | O_CLOEXEC);
  if (fd < 0) return std::perror(argv[1]), 1;
  int clock = CLOCK_MONOTONIC;
  if (::ioctl(fd, EVIOCSCLOCKID, &clock) < 0) return std::perror("EVIOCSCLOCKID"), 1;
  std::printf("ready\n");
  std::fflush(stdout);
  for (int left = std::atoi(argv[2]); left > 0;) {
    input_event event{};
    if (::read(fd, &event, sizeof event) != sizeof event)
      return std::printf("lost %s\n", std::strerror(errno)), 3;
    if (event.type != EV_KEY || event.code != BTN_TOUCH || event.value != 1) continue;
    std::printf("%lld\n", event.input_event_sec * 1'000'000'000LL + event.input_event_usec * 1000LL);
    std::fflush(stdout);
    --left;
  }
}
