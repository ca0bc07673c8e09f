#include "station/panel/wake_up.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>

namespace turnpoint::panel {

WakeUp::WakeUp() : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

WakeUp::~WakeUp() { ::close(descriptor_); }

void WakeUp::ring() noexcept {
  const std::uint64_t one = 1;  // fails only when the counter is full, and then the waiter is awake anyway
  [[maybe_unused]] const auto written = ::write(descriptor_, &one, sizeof one);
}

void WakeUp::clear() noexcept {
  std::uint64_t rings = 0;
  [[maybe_unused]] const auto read = ::read(descriptor_, &rings, sizeof rings);
}

}  // namespace turnpoint::panel
