#include "station/panel/touch_reader.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

namespace turnpoint::panel {

namespace {

constexpr int kPriority = 60;
constexpr int kLookAgain_ms = 1000;

/// A file descriptor that is closed when it goes.
class File {
 public:
  explicit File(int fd = -1) : fd_(fd) {}
  File(File&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  File& operator=(File&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~File() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), "touch panel: " + what);
}

std::string name_of(int fd) {
  std::array<char, 256> name{};
  return ::ioctl(fd, EVIOCGNAME(name.size() - 1), name.data()) >= 0 ? name.data() : "";
}

/// The device of that path or name; an empty file where there is none now.
File find(const std::string& device) {
  if (device.rfind('/', 0) == 0) return File(::open(device.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/input", none)) {
    if (entry.path().filename().string().rfind("event", 0) != 0) continue;
    File file(::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file && name_of(file.get()) == device) return file;
  }
  return File();
}

AxisRange range_of(int fd, int axis) {
  input_absinfo info{};
  if (::ioctl(fd, EVIOCGABS(axis), &info) < 0)
    fail("no axis " + std::to_string(axis) + "; not a touch panel");
  return {info.minimum, info.maximum};
}

bool speaks_slots(int fd) {
  std::array<unsigned char, ABS_CNT / 8 + 1> axes{};
  if (::ioctl(fd, EVIOCGBIT(EV_ABS, axes.size()), axes.data()) < 0) fail("its axes cannot be read");
  return (axes[ABS_MT_SLOT / 8] >> (ABS_MT_SLOT % 8) & 1) != 0;
}

/// Sets the clock and asks what the device can do.
TouchDecoder decoder_of(int fd) {
  int clock = CLOCK_MONOTONIC;
  if (::ioctl(fd, EVIOCSCLOCKID, &clock) < 0) fail("no CLOCK_MONOTONIC time stamps");
  if (speaks_slots(fd))
    return {TouchProtocol::slots, range_of(fd, ABS_MT_POSITION_X), range_of(fd, ABS_MT_POSITION_Y)};
  return {TouchProtocol::single, range_of(fd, ABS_X), range_of(fd, ABS_Y)};
}

}  // namespace

class TouchReader::Thread {
 public:
  Thread(const std::string& device, OnState on_state, TouchTimes& times)
      : device_(device),
        on_state_(std::move(on_state)),
        times_(times),
        file_(find(device)),
        wake_(::eventfd(0, EFD_CLOEXEC)) {
    if (!wake_) fail("eventfd");
    if (!file_ && device.rfind('/', 0) == 0) fail("cannot open " + device);
    if (!file_)
      throw std::invalid_argument("touch panel: no device is called \"" + device +
                                  "\"; see /proc/bus/input/devices");
    decoder_.emplace(decoder_of(file_.get()));
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  ~Thread() {
    thread_.request_stop();
    const std::uint64_t one = 1;
    // The eventfd's counter cannot overflow by one write, which is all that could fail here.
    [[maybe_unused]] const auto written = ::write(wake_.get(), &one, sizeof one);
  }

 private:
  void run(const std::stop_token& stop) {
    const sched_param priority{kPriority};
    ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &priority);  // without the right to: as it is
    while (!stop.stop_requested()) {
      pollfd files[] = {{wake_.get(), POLLIN, 0}, {file_.get(), POLLIN, 0}};
      ::poll(files, file_ ? 2 : 1, file_ ? -1 : kLookAgain_ms);
      if (!file_) {
        look_again();
      } else if (files[1].revents != 0 && !read()) {
        file_ = File();
        on_state_(TouchPanelState::lost);
      }
    }
  }

  /// False when the device is gone.
  bool read() {
    std::array<input_event, 64> events;
    const auto bytes = ::read(file_.get(), events.data(), sizeof events);
    if (bytes < 0) return errno == EAGAIN || errno == EINTR;
    for (std::size_t i = 0; i < static_cast<std::size_t>(bytes) / sizeof(input_event); ++i)
      for (const auto& touch : decoder_->handle(events[i])) times_.add(touch);
    return bytes > 0;
  }

  void look_again() {
    auto found = find(device_);
    if (!found) return;
    try {
      decoder_.emplace(decoder_of(found.get()));
    } catch (const std::exception&) {
      return;  // half attached: the next look will tell
    }
    file_ = std::move(found);
    on_state_(TouchPanelState::back);
  }

  std::string device_;
  OnState on_state_;
  TouchTimes& times_;
  File file_, wake_;
  std::optional<TouchDecoder> decoder_;
  std::jthread thread_;
};

TouchReader::TouchReader(const std::string& device, OnState on_state)
    : thread_(std::make_unique<Thread>(device, std::move(on_state), times_)) {}

TouchReader::~TouchReader() = default;

}  // namespace turnpoint::panel
