#include "station/io/gpio_common.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>

namespace turnpoint::io {

std::vector<std::string> chip_paths() {
  std::vector<std::string> paths;
  std::error_code ignored;
  // Skip links: Raspberry Pi OS has a link to a chip under a second name, so each of its lines would be found
  // twice.
  for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored))
    if (entry.path().filename().string().starts_with("gpiochip") && !entry.is_symlink(ignored))
      paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return paths;
}

std::optional<std::size_t> wait_readable(std::vector<pollfd>& descriptors, std::int64_t timeout_ns,
                                         int wake) {
  const timespec timeout{timeout_ns / 1'000'000'000, timeout_ns % 1'000'000'000};
  descriptors.push_back({wake, POLLIN, 0});  // poll ignores a negative descriptor
  const int ready = ::ppoll(descriptors.data(), descriptors.size(), &timeout, nullptr);
  const int error = errno;
  descriptors.pop_back();
  if (ready < 0 && error == EINTR) return std::nullopt;
  if (ready < 0)
    throw std::system_error(error, std::generic_category(), "gpio lines: waiting for an edge (poll)");
  for (std::size_t k = 0; ready > 0 && k < descriptors.size(); ++k) {
    if (descriptors[k].revents & (POLLHUP | POLLERR | POLLNVAL))
      throw std::system_error(ENODEV, std::generic_category(), "gpio lines: the GPIO chip was removed");
    if (descriptors[k].revents & POLLIN) return k;
  }
  return std::nullopt;
}

void throw_line_error(int error, const std::string& name, const std::string& what) {
  throw LineError(error, std::generic_category(), "gpio line " + name + ": " + what);
}

}  // namespace turnpoint::io
