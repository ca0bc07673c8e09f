#include "tests/support/fake_evdev.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace {

std::array<std::atomic<FakeEvdev*>, 4> devices{};

void add(FakeEvdev* device) {
  for (auto& place : devices)
    if (FakeEvdev* none = nullptr; place.compare_exchange_strong(none, device)) return;
  throw std::runtime_error("too many simulated devices");
}

void remove(const FakeEvdev* device) {
  for (auto& place : devices)
    if (place.load() == device) place = nullptr;
}

using Bits = std::vector<int>;

int put_bits(const Bits& bits, void* argument, std::size_t size) {
  auto* bytes = static_cast<unsigned char*>(argument);
  std::memset(bytes, 0, size);
  for (const int bit : bits)
    if (static_cast<std::size_t>(bit) / 8 < size) bytes[bit / 8] |= static_cast<unsigned char>(1 << bit % 8);
  return static_cast<int>(size);
}

}  // namespace

FakeEvdev::FakeEvdev(int slot_count) {
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends_) != 0)
    throw std::runtime_error("socketpair");
  set_axes(slot_count);
  add(this);
}

FakeEvdev::FakeEvdev(int slot_count, const std::string& path) : path_(path) {
  if (::mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("mkfifo " + path);
  ends_[1] = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (ends_[1] < 0) throw std::runtime_error("open " + path);
  set_axes(slot_count);
  add(this);
}

void FakeEvdev::set_axes(int slot_count) {
  keys = {BTN_TOUCH};
  axes = {{ABS_X, 0}, {ABS_Y, 0}};
  if (slot_count > 0)
    for (const int axis : {ABS_MT_SLOT, ABS_MT_TRACKING_ID, ABS_MT_POSITION_X, ABS_MT_POSITION_Y})
      axes[axis] = 0;
  slot_values.assign(static_cast<std::size_t>(slot_count),
                     {{ABS_MT_TRACKING_ID, -1}, {ABS_MT_POSITION_X, 0}, {ABS_MT_POSITION_Y, 0}});
}

FakeEvdev::~FakeEvdev() {
  unplug();
  remove(this);
  if (ends_[1] >= 0) ::close(ends_[1]);
}

// Replaces the descriptor of the program that has opened the path by one that cannot be read, and wakes this
// program so that it notices. dup3() is not used, because a sanitizer would report it as an error of the
// reader.
void FakeEvdev::unplug() {
  if (path_.empty() || ends_[1] < 0) return;
  const int unreadable = ::open("/", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int descriptor = std::stoi(entry.path().filename());
    if (descriptor != ends_[1] && is(descriptor)) ::syscall(SYS_dup3, unreadable, descriptor, O_CLOEXEC);
  }
  ::close(unreadable);
  std::filesystem::remove(path_);
  ::close(std::exchange(ends_[1], -1));
}

bool FakeEvdev::is(int descriptor) const {
  struct stat mine {
  }, found{};
  if (path_.empty()) return descriptor == ends_[0];
  // Use stat() with the path, because a sanitizer would report fstat() as a use of the reader's descriptor.
  const auto path = "/proc/self/fd/" + std::to_string(descriptor);
  return ::fstat(ends_[1], &mine) == 0 && ::stat(path.c_str(), &found) == 0 && found.st_dev == mine.st_dev &&
         found.st_ino == mine.st_ino;
}

void FakeEvdev::send(long time_us, int type, int code, int value) {
  input_event event{};
  event.input_event_sec = time_us / 1'000'000;
  event.input_event_usec = time_us % 1'000'000;
  event.type = static_cast<unsigned short>(type);
  event.code = static_cast<unsigned short>(code);
  event.value = value;
  if (::write(ends_[1], &event, sizeof event) != sizeof event) throw std::runtime_error("write");
}

int FakeEvdev::answer(unsigned long request, void* argument) const {
  const unsigned number = _IOC_NR(request);
  const std::size_t size = _IOC_SIZE(request);
  if (number == _IOC_NR(EVIOCGNAME(0)))
    return std::strncpy(static_cast<char*>(argument), name.c_str(), size), static_cast<int>(name.size()) + 1;
  if (number == _IOC_NR(EVIOCGPHYS(0)) || number == _IOC_NR(EVIOCGUNIQ(0))) return errno = ENOENT, -1;
  if (number == _IOC_NR(EVIOCGKEY(0))) return put_bits(touched ? Bits{BTN_TOUCH} : Bits{}, argument, size);
  if (number == _IOC_NR(EVIOCGBIT(0, 0))) return put_bits({EV_SYN, EV_KEY, EV_ABS}, argument, size);
  if (number == _IOC_NR(EVIOCGBIT(EV_KEY, 0))) return put_bits(keys, argument, size);
  if (number == _IOC_NR(EVIOCGBIT(EV_ABS, 0))) {
    Bits all;
    for (const auto& [axis, value] : axes) all.push_back(axis);
    return put_bits(all, argument, size);
  }
  if (number >= _IOC_NR(EVIOCGABS(0)) && number < _IOC_NR(EVIOCGABS(ABS_CNT))) {
    const int axis = static_cast<int>(number - _IOC_NR(EVIOCGABS(0)));
    const bool along_y = axis == ABS_Y || axis == ABS_MT_POSITION_Y;
    input_absinfo info{};
    info.value = axes.at(axis);
    info.maximum = axis == ABS_MT_SLOT          ? static_cast<int>(slot_values.size()) - 1
                   : axis == ABS_MT_TRACKING_ID ? 65535
                   : along_y                    ? 479
                                                : 799;
    std::memcpy(argument, &info, sizeof info);
    return 0;
  }
  if (number == _IOC_NR(EVIOCGMTSLOTS(0))) {
    auto* values = static_cast<int*>(argument);
    for (std::size_t k = 0; k < slot_values.size() && (k + 2) * sizeof(int) <= size; ++k)
      values[k + 1] = slot_values[k].count(values[0]) ? slot_values[k].at(values[0]) : 0;
    return 0;
  }
  std::memset(argument, 0, number == _IOC_NR(EVIOCSCLOCKID) ? 0 : size);
  return 0;
}

// Replaces the C library's ioctl(). Requests for other descriptors are passed on to the kernel.
extern "C" int ioctl(int descriptor, unsigned long request, ...) {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (_IOC_TYPE(request) == 'E')
    for (const auto& place : devices)
      if (const auto* device = place.load(); device != nullptr && device->is(descriptor))
        return device->answer(request, argument);
  return static_cast<int>(::syscall(SYS_ioctl, descriptor, request, argument));
}
