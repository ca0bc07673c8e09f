#include "station/panel/evdev_contact.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <filesystem>
#include <system_error>

namespace turnpoint::panel {

std::optional<Touch> ContactReader::take(const input_event& event) noexcept {
  if (event.type == EV_SYN && event.code == SYN_DROPPED) dropped_ = true;
  if (event.type == EV_KEY && event.code == BTN_TOUCH) on_ = event.value != 0;
  if (event.type == EV_ABS && event.code == axis_) raw_ = event.value;
  if (event.type != EV_SYN || event.code != SYN_REPORT || dropped_) return std::nullopt;
  const double range = maximum_ > minimum_ ? maximum_ - minimum_ : 1;
  const double position = (raw_ - minimum_) / range;
  const bool moved = on_ && std::abs(position - told_) >= 0.01;
  if (on_ == told_on_ && !moved) return std::nullopt;
  told_on_ = on_;
  told_ = position;
  Touch touch;
  touch.time_ns =
      std::int64_t{1'000'000'000} * event.input_event_sec + std::int64_t{1000} * event.input_event_usec;
  touch.on = on_;
  touch.position = position;
  return touch;
}

void ContactReader::recovered(bool on, int position) noexcept {
  dropped_ = false;
  on_ = on;
  raw_ = position;
}

namespace {

int open_named(const std::string& name) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/input", ignored)) {
    if (!entry.path().filename().string().starts_with("event")) continue;
    const int descriptor = ::open(entry.path().c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    char found[256] = {};
    if (::ioctl(descriptor, EVIOCGNAME(sizeof found - 1), found) >= 0 && name == found) return descriptor;
    ::close(descriptor);
  }
  throw std::system_error(ENOENT, std::generic_category(),
                          "touch sensor '" + name + "': no input device of this name");
}

}  // namespace

EvdevContact::EvdevContact(const std::string& name, int axis)
    : descriptor_(open_named(name)), axis_(axis), name_(name) {
  int clock = CLOCK_MONOTONIC;
  input_absinfo range{};
  int error = 0;
  if (::ioctl(descriptor_, EVIOCSCLOCKID, &clock) < 0) error = errno;
  if (error == 0 && ::ioctl(descriptor_, EVIOCGABS(static_cast<unsigned>(axis)), &range) < 0) error = ENOTSUP;
  if (error != 0) {
    ::close(descriptor_);
    throw std::system_error(error, std::generic_category(), "touch sensor '" + name + "'");
  }
  reader_.emplace(axis, range.minimum, range.maximum);
}

EvdevContact::~EvdevContact() { ::close(descriptor_); }

// After the kernel had to drop events: its state now.
void EvdevContact::resynchronise() {
  unsigned char keys[KEY_MAX / 8 + 1] = {};
  input_absinfo now{};
  ::ioctl(descriptor_, EVIOCGKEY(sizeof keys), keys);
  ::ioctl(descriptor_, EVIOCGABS(static_cast<unsigned>(axis_)), &now);
  reader_->recovered((keys[BTN_TOUCH / 8] >> (BTN_TOUCH % 8) & 1) != 0, now.value);
}

std::optional<Touch> EvdevContact::wait(std::int64_t timeout_ns) {
  for (;;) {
    input_event event{};
    const ssize_t size = ::read(descriptor_, &event, sizeof event);
    if (size == sizeof event) {
      const auto touch = reader_->take(event);
      if (reader_->dropped() && event.type == EV_SYN && event.code == SYN_REPORT) resynchronise();
      if (touch) return touch;
      continue;
    }
    if (size < 0 && errno != EAGAIN && errno != EINTR)
      throw std::system_error(errno, std::generic_category(), "touch sensor '" + name_ + "'");
    pollfd wanted{descriptor_, POLLIN, 0};
    const timespec timeout{timeout_ns / 1'000'000'000, timeout_ns % 1'000'000'000};
    if (::ppoll(&wanted, 1, &timeout, nullptr) <= 0) return std::nullopt;
    if (wanted.revents & (POLLERR | POLLHUP))
      throw std::system_error(ENODEV, std::generic_category(), "touch sensor '" + name_ + "'");
  }
}

}  // namespace turnpoint::panel
