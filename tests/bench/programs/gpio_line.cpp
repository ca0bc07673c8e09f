// gpio_line hold NAME VALUE       holds a line as an output until killed
//           watch NAME COUNT      prints kernel stamp (ns, CLOCK_MONOTONIC) and direction of COUNT edges
//           press FILE MS         pulls a simulated input (its sysfs file) up for MS (0 means 0.1 ms); prints
//                                 "BEFORE AFTER" (ns) for each edge, which happened between these two times
//           bounce FILE MS        the same, with a contact that bounces at either end
//           until-low FILE VALUE  pulls a simulated input up, and prints how long (ns) it took until the line
//                                 with the sysfs file VALUE was low
// Uses the kernel's own interface, so that the bench does not depend on a version of libgpiod.
#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>

namespace {

int request(const std::string& name, std::uint64_t flags, int value) {
  for (const auto& entry : std::filesystem::directory_iterator("/dev")) {
    if (entry.path().filename().string().rfind("gpiochip", 0) != 0) continue;
    const int chip = ::open(entry.path().c_str(), O_RDWR | O_CLOEXEC);
    gpiochip_info info{};
    if (chip < 0 || ::ioctl(chip, GPIO_GET_CHIPINFO_IOCTL, &info) < 0) continue;
    for (unsigned offset = 0; offset < info.lines; ++offset) {
      gpio_v2_line_info line{};
      line.offset = offset;
      if (::ioctl(chip, GPIO_V2_GET_LINEINFO_IOCTL, &line) < 0 || name != line.name) continue;
      gpio_v2_line_request wanted{};
      wanted.offsets[0] = offset;
      wanted.num_lines = 1;
      std::strcpy(wanted.consumer, "bench");
      wanted.config.flags = flags;
      if (flags & GPIO_V2_LINE_FLAG_OUTPUT) {
        wanted.config.num_attrs = 1;
        wanted.config.attrs[0].mask = 1;
        wanted.config.attrs[0].attr.id = GPIO_V2_LINE_ATTR_ID_OUTPUT_VALUES;
        wanted.config.attrs[0].attr.values = value ? 1 : 0;
      }
      if (::ioctl(chip, GPIO_V2_GET_LINE_IOCTL, &wanted) < 0) return std::perror("request"), -1;
      return wanted.fd;
    }
    ::close(chip);
  }
  return std::fprintf(stderr, "gpio_line: no line named %s\n", name.c_str()), -1;
}

long long now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

/// Waits without sleeping. In a guest on a busy host, even a short sleep can take far too long.
void busy_wait_ns(long long length_ns) {
  for (const auto end = now_ns() + length_ns; now_ns() < end;) {
  }
}

/// Makes one press. The contact bounces this many times, for 0.5 ms each, at the press and at the release.
int press(const char* file, int ms, int bounces) {
  const int fd = ::open(file, O_WRONLY | O_CLOEXEC);
  const auto drive = [fd](const std::string& pull) { return ::write(fd, pull.data(), pull.size()) > 0; };
  std::string now = "pull-up", other = "pull-down";
  for (int end = 0; end < 2; ++end, std::swap(now, other)) {
    const auto before = now_ns();
    if (!drive(now)) return std::perror(file), 1;
    std::printf("%lld %lld\n", before, now_ns());
    for (int i = 0; i < bounces; ++i) {
      busy_wait_ns(500'000);
      drive(other);
      busy_wait_ns(500'000);
      drive(now);
    }
    if (ms > 0)
      ::usleep(static_cast<useconds_t>(ms) * 1000);
    else
      busy_wait_ns(100'000);
  }
  return 0;
}

/// Pulls an input up and measures how long it takes until another line is low.
int until_low(const char* pull_file, const char* value_file) {
  const int pull = ::open(pull_file, O_WRONLY | O_CLOEXEC), value = ::open(value_file, O_RDONLY | O_CLOEXEC);
  const auto start = now_ns();
  if (pull < 0 || value < 0 || ::write(pull, "pull-up", 7) < 0) return std::perror("until-low"), 1;
  for (char level = '1'; level != '0';) {
    if (::pread(value, &level, 1, 0) != 1) return std::perror(value_file), 1;
    if (now_ns() - start > 1'000'000'000) return std::printf("never\n"), 1;
  }
  std::printf("%lld\n", now_ns() - start);
  return 0;
}

int watch(int fd, int count) {
  while (count-- > 0) {
    gpio_v2_line_event event{};
    if (::read(fd, &event, sizeof event) != sizeof event) return std::perror("read"), 1;
    std::printf("%llu %s\n", static_cast<unsigned long long>(event.timestamp_ns),
                event.id == GPIO_V2_LINE_EVENT_RISING_EDGE ? "rising" : "falling");
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc == 4 ? argv[1] : "";
  if (what != "hold" && what != "watch" && what != "press" && what != "bounce" && what != "until-low")
    return std::fprintf(stderr, "gpio_line hold|watch|press|bounce|until-low A B\n"), 2;
  if (what == "until-low") return until_low(argv[2], argv[3]);
  const int number = std::atoi(argv[3]);
  if (what == "press" || what == "bounce") return press(argv[2], number, what == "press" ? 0 : 3);
  const auto flags = what == "hold" ? std::uint64_t{GPIO_V2_LINE_FLAG_OUTPUT}
                                    : GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_EDGE_RISING |
                                          GPIO_V2_LINE_FLAG_EDGE_FALLING;
  const int fd = request(argv[2], flags, number);
  if (fd < 0) return 1;
  std::puts("ready");
  std::fflush(stdout);
  return what == "hold" ? ::pause() : watch(fd, number);
}
