// gpio_line hold NAME VALUE | watch NAME COUNT: holds a line as an output until killed, or prints the
// kernel's time stamp (ns, CLOCK_MONOTONIC) and direction of edges. By the kernel's own interface, so that
// any libgpiod will do.
#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <unistd.h>

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

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "gpio_line hold NAME VALUE | watch NAME COUNT\n"), 2;
  const bool hold = std::string(argv[1]) == "hold";
  const auto flags =
      hold ? std::uint64_t{GPIO_V2_LINE_FLAG_OUTPUT}
           : GPIO_V2_LINE_FLAG_INPUT | GPIO_V2_LINE_FLAG_EDGE_RISING | GPIO_V2_LINE_FLAG_EDGE_FALLING;
  const int fd = request(argv[2], flags, std::atoi(argv[3]));
  if (fd < 0) return 1;
  std::printf("ready\n");
  std::fflush(stdout);
  if (hold) return ::pause();
  for (int left = std::atoi(argv[3]); left > 0; --left) {
    gpio_v2_line_event event{};
    if (::read(fd, &event, sizeof event) != sizeof event) return std::perror("read"), 1;
    std::printf("%llu %s\n", static_cast<unsigned long long>(event.timestamp_ns),
                event.id == GPIO_V2_LINE_EVENT_RISING_EDGE ? "rising" : "falling");
    std::fflush(stdout);
  }
}
