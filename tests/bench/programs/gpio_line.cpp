// gpio_line hold NAME VALUE   holds a line as an output until killed
//           watch NAME COUNT  prints the kernel's stamp (ns, CLOCK_MONOTONIC) and the direction of so many
//           edges press FILE MS     pulls a simulated input (its sysfs file) up for so long; prints, for
//           either edge,
//                             "BEFORE AFTER" (ns): the edge happened between these two
// By the kernel's own interface, so that the bench does not depend on a version of libgpiod.
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

int press(const char* file, int ms) {
  for (const std::string pull : {"pull-up", "pull-down"}) {
    const int fd = ::open(file, O_WRONLY | O_CLOEXEC);
    const auto before = now_ns();
    if (::write(fd, pull.data(), pull.size()) < 0) return std::perror(file), 1;
    std::printf("%lld %lld\n", before, now_ns());
    ::close(fd);
    ::usleep(static_cast<useconds_t>(ms) * 1000);
  }
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
  if (what != "hold" && what != "watch" && what != "press")
    return std::fprintf(stderr, "gpio_line hold NAME VALUE | watch NAME COUNT | press FILE MS\n"), 2;
  const int number = std::atoi(argv[3]);
  if (what == "press") return press(argv[2], number);
  const auto flags = what == "hold" ? std::uint64_t{GPIO_V2_LINE_FLAG_OUTPUT}
                                    : GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_EDGE_RISING |
                                          GPIO_V2_LINE_FLAG_EDGE_FALLING;
  const int fd = request(argv[2], flags, number);
  if (fd < 0) return 1;
  std::puts("ready");
  std::fflush(stdout);
  return what == "hold" ? ::pause() : watch(fd, number);
}
