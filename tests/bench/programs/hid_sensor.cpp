// hid_sensor RATE_HZ: a sensor by uhid. The kernel's drivers for HID sensors make of it an IIO device
// "accel_3d" with three channels, a trigger and a buffer. Sample n, counted from when a program turned the
// sensor on, is n, -n / 2 and 7 thousandths; its time stamp is n / RATE_HZ after the start on
// CLOCK_MONOTONIC, but up to 0.1 ms early or late. Prints "on START" with the time of sample 0 in ns whenever
// a program turns the sensor on. SIGUSR1 leaves out the next five samples and prints "left out N", the number
// of the first of them. SIGTERM unplugs the sensor.
#include <fcntl.h>
#include <linux/uhid.h>
#include <poll.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

// HID usage page 0x20 (sensors), usage 0x73 (accelerometer with three axes). The lists of states are those of
// the HID usage tables; the driver looks up the places of "all events" and "full power" in them.
constexpr unsigned char descriptor[] = {
    0x05, 0x20, 0x09, 0x73, 0xa1, 0x00, 0x85, 0x01,  // collection of the sensor, report 1
    // state of reporting, one byte
    0x05, 0x20, 0x0a, 0x16, 0x03, 0x15, 0x00, 0x25, 0x05, 0x75, 0x08, 0x95, 0x01, 0xa1, 0x02, 0x0a, 0x40,
    0x08, 0x0a, 0x41, 0x08, 0xb1, 0x00, 0xc0,
    // state of power, one byte
    0x0a, 0x19, 0x03, 0x15, 0x00, 0x25, 0x05, 0x75, 0x08, 0x95, 0x01, 0xa1, 0x02, 0x0a, 0x50, 0x08, 0x0a,
    0x51, 0x08, 0x0a, 0x52, 0x08, 0x0a, 0x53, 0x08, 0x0a, 0x54, 0x08, 0x0a, 0x55, 0x08, 0xb1, 0x00, 0xc0,
    // interval between two reports in ms, four bytes
    0x0a, 0x0e, 0x03, 0x15, 0x00, 0x27, 0xff, 0xff, 0xff, 0x7f, 0x75, 0x20, 0x95, 0x01, 0x65, 0x19, 0x55,
    0x00, 0xb1, 0x02,
    // three axes in units of 1e-6 m/s2, each a field of its own, because the driver looks for fields
    0x17, 0x00, 0x00, 0x00, 0x80, 0x27, 0xff, 0xff, 0xff, 0x7f, 0x75, 0x20, 0x95, 0x01, 0x66, 0xe0, 0x11,
    0x55, 0x0a, 0x0a, 0x53, 0x04, 0x81, 0x02, 0x0a, 0x54, 0x04, 0x81, 0x02, 0x0a, 0x55, 0x04, 0x81, 0x02,
    // time stamp in units of 1e-6 ms, eight bytes
    0x0a, 0x29, 0x05, 0x15, 0x00, 0x75, 0x20, 0x95, 0x02, 0x65, 0x19, 0x55, 0x0a, 0x81, 0x02, 0xc0};

int device = -1;
unsigned char feature[7] = {1, 1, 5, 1, 0, 0, 0};  // report, state of reporting, state of power, interval
long long start_ns = 0, next = 0;
double rate_Hz = 1000;
volatile std::sig_atomic_t leave_out = 0, unplug = 0;

long long now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

void send(const uhid_event& event) {
  if (::write(device, &event, sizeof event) < 0) std::perror("/dev/uhid"), std::exit(1);
}

void create() {
  uhid_event event{};
  event.type = UHID_CREATE2;
  auto& made = event.u.create2;
  std::strcpy(reinterpret_cast<char*>(made.name), "bench force sensor");
  made.rd_size = sizeof descriptor;
  made.bus = 3;  // USB
  made.vendor = 0x1209;
  made.product = 1;
  std::memcpy(made.rd_data, descriptor, sizeof descriptor);
  send(event);
}

long long due_ns(long long n) {
  return start_ns + static_cast<long long>(static_cast<double>(n) * 1e9 / rate_Hz);
}

void report(long long n) {
  const std::int32_t axes[3] = {static_cast<std::int32_t>(1000 * n), static_cast<std::int32_t>(-500 * n),
                                7000};
  const std::int64_t stamp_ns = due_ns(n) + (n * 7919 % 201 - 100) * 1000;
  uhid_event event{};
  event.type = UHID_INPUT2;
  event.u.input2.size = 21;
  event.u.input2.data[0] = 1;
  std::memcpy(event.u.input2.data + 1, axes, sizeof axes);
  std::memcpy(event.u.input2.data + 13, &stamp_ns, sizeof stamp_ns);
  send(event);
}

bool reporting() { return feature[1] == 2; }

// The driver asks for the states and sets them; without an answer it waits for 5 s and fails.
void answer() {
  uhid_event event{}, reply{};
  if (::read(device, &event, sizeof event) < 0) return;
  if (event.type == UHID_GET_REPORT) {
    reply.type = UHID_GET_REPORT_REPLY;
    auto& got = reply.u.get_report_reply;
    got.id = event.u.get_report.id;
    got.err = event.u.get_report.rtype == UHID_FEATURE_REPORT ? 0 : EIO;
    got.size = sizeof feature;
    std::memcpy(got.data, feature, sizeof feature);
    send(reply);
  } else if (event.type == UHID_SET_REPORT) {
    const bool was = reporting();
    const auto& set = event.u.set_report;
    if (set.rtype == UHID_FEATURE_REPORT && set.size >= sizeof feature)
      std::memcpy(feature, set.data, sizeof feature);
    if (reporting() && !was) {
      start_ns = now_ns(), next = 0;
      std::printf("on %lld\n", start_ns), std::fflush(stdout);
    }
    reply.type = UHID_SET_REPORT_REPLY;
    reply.u.set_report_reply.id = set.id;
    send(reply);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "hid_sensor RATE_HZ\n"), 2;
  rate_Hz = std::atof(argv[1]);
  std::signal(SIGUSR1, [](int) { leave_out = 1; });
  std::signal(SIGTERM, [](int) { unplug = 1; });
  device = ::open("/dev/uhid", O_RDWR | O_CLOEXEC);
  if (device < 0) return std::perror("/dev/uhid"), 1;
  create();
  while (!unplug) {
    pollfd wait{device, POLLIN, 0};
    const long long left_ns =
        reporting() ? std::clamp(due_ns(next) - now_ns(), 0LL, 20'000'000LL) : 20'000'000;
    const timespec left{0, static_cast<long>(left_ns)};
    if (::ppoll(&wait, 1, &left, nullptr) > 0) {
      answer();
      continue;
    }
    if (leave_out) {
      leave_out = 0;
      std::printf("left out %lld\n", next), std::fflush(stdout);
      next += 5;
    }
    while (reporting() && now_ns() >= due_ns(next)) report(next++);
  }
}
