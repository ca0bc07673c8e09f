#include "tests/support/fake_evdev.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <stdexcept>

namespace {

FakeEvdev* the_device = nullptr;

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
  axes = {{ABS_X, 0}, {ABS_Y, 0}};
  if (slot_count > 0)
    for (const int axis : {ABS_MT_SLOT, ABS_MT_TRACKING_ID, ABS_MT_POSITION_X, ABS_MT_POSITION_Y})
      axes[axis] = 0;
  slots.assign(static_cast<std::size_t>(slot_count),
               {{ABS_MT_TRACKING_ID, -1}, {ABS_MT_POSITION_X, 0}, {ABS_MT_POSITION_Y, 0}});
  the_device = this;
}

FakeEvdev::~FakeEvdev() {
  the_device = nullptr;
  ::close(ends_[1]);
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
    return std::strncpy(static_cast<char*>(argument), "fake panel", size), 11;
  if (number == _IOC_NR(EVIOCGPHYS(0)) || number == _IOC_NR(EVIOCGUNIQ(0))) return errno = ENOENT, -1;
  if (number == _IOC_NR(EVIOCGKEY(0))) return put_bits(touched ? Bits{BTN_TOUCH} : Bits{}, argument, size);
  if (number == _IOC_NR(EVIOCGBIT(0, 0))) return put_bits({EV_SYN, EV_KEY, EV_ABS}, argument, size);
  if (number == _IOC_NR(EVIOCGBIT(EV_KEY, 0))) return put_bits({BTN_TOUCH}, argument, size);
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
    info.maximum = axis == ABS_MT_SLOT          ? static_cast<int>(slots.size()) - 1
                   : axis == ABS_MT_TRACKING_ID ? 65535
                   : along_y                    ? 479
                                                : 799;
    std::memcpy(argument, &info, sizeof info);
    return 0;
  }
  if (number == _IOC_NR(EVIOCGMTSLOTS(0))) {
    auto* values = static_cast<int*>(argument);
    for (std::size_t k = 0; k < slots.size() && (k + 2) * sizeof(int) <= size; ++k)
      values[k + 1] = slots[k].count(values[0]) ? slots[k].at(values[0]) : 0;
    return 0;
  }
  std::memset(argument, 0, number == _IOC_NR(EVIOCSCLOCKID) ? 0 : size);
  return 0;
}

// Everything but the fake device's descriptor goes on to the kernel.
extern "C" int ioctl(int descriptor, unsigned long request, ...) {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (the_device != nullptr && descriptor == the_device->descriptor())
    return the_device->answer(request, argument);
  return static_cast<int>(::syscall(SYS_ioctl, descriptor, request, argument));
}
