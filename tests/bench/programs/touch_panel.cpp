// touch_panel WIDTH HEIGHT: a multitouch panel by uinput that obeys commands on standard input, one per line:
//   tap X Y | down SLOT X Y | move SLOT X Y | up SLOT | sleep MS | mouse DX DY | gone
// "mouse" moves the pointer of a mouse, which is plugged in at the first move.
// Prints "device /dev/input/eventN" once, and "tapped BEFORE AFTER" (ns, CLOCK_MONOTONIC) for each tap: the
// touch was injected between these two times.
#include <fcntl.h>
#include <linux/uinput.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>

namespace {

int panel = -1, mouse = -1;

void emit_to(int device, int type, int code, int value) {
  input_event event{};
  event.type = static_cast<unsigned short>(type);
  event.code = static_cast<unsigned short>(code);
  event.value = value;
  if (::write(device, &event, sizeof event) != sizeof event) std::perror("uinput write"), std::exit(1);
}

void emit(int type, int code, int value) { emit_to(panel, type, code, value); }

void axis(int code, int maximum) {
  uinput_abs_setup setup{};
  setup.code = static_cast<unsigned short>(code);
  setup.absinfo.maximum = maximum;
  ::ioctl(panel, UI_ABS_SETUP, &setup);
}

// Also sends single-finger events, as the kernel's drivers do for programs that know only one finger.
void one_finger(int slot, int x, int y) {
  if (slot != 0) return;
  emit(EV_ABS, ABS_X, x);
  emit(EV_ABS, ABS_Y, y);
}

int fingers = 0;

void down(int slot, int x, int y) {
  static int id = 1;
  ++fingers;
  emit(EV_ABS, ABS_MT_SLOT, slot);
  emit(EV_ABS, ABS_MT_TRACKING_ID, id++);
  emit(EV_ABS, ABS_MT_POSITION_X, x);
  emit(EV_ABS, ABS_MT_POSITION_Y, y);
  one_finger(slot, x, y);
  emit(EV_KEY, BTN_TOUCH, 1);
  emit(EV_SYN, SYN_REPORT, 0);
}

void up(int slot) {
  emit(EV_ABS, ABS_MT_SLOT, slot);
  emit(EV_ABS, ABS_MT_TRACKING_ID, -1);
  if (--fingers == 0) emit(EV_KEY, BTN_TOUCH, 0);
  emit(EV_SYN, SYN_REPORT, 0);
}

void sleep_ms(int ms) { ::usleep(static_cast<useconds_t>(ms) * 1000); }

int open_uinput() {
  const int device = ::open("/dev/uinput", O_WRONLY | O_CLOEXEC);
  if (device < 0) std::perror("/dev/uinput"), std::exit(1);
  return device;
}

void create(int device, const char* name) {
  uinput_setup setup{};
  setup.id.bustype = BUS_USB;
  std::strcpy(setup.name, name);
  ::ioctl(device, UI_DEV_SETUP, &setup);
  if (::ioctl(device, UI_DEV_CREATE) < 0) std::perror("uinput"), std::exit(1);
}

void plug_in_mouse() {
  mouse = open_uinput();
  for (const int type : {EV_SYN, EV_KEY, EV_REL}) ::ioctl(mouse, UI_SET_EVBIT, type);
  for (const int button : {BTN_LEFT, BTN_RIGHT}) ::ioctl(mouse, UI_SET_KEYBIT, button);
  for (const int axis : {REL_X, REL_Y}) ::ioctl(mouse, UI_SET_RELBIT, axis);
  create(mouse, "bench mouse");
  sleep_ms(1000);  // allow programs that watch for new devices to find this one
}

void move_mouse(int dx, int dy) {
  if (mouse < 0) plug_in_mouse();
  emit_to(mouse, EV_REL, REL_X, dx);
  emit_to(mouse, EV_REL, REL_Y, dy);
  emit_to(mouse, EV_SYN, SYN_REPORT, 0);
}

long long now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

std::string device_path() {
  char name[64] = {};
  ::ioctl(panel, UI_GET_SYSNAME(sizeof name), name);
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string("/sys/devices/virtual/input/") + name))
    if (const auto file = entry.path().filename().string(); file.rfind("event", 0) == 0)
      return "/dev/input/" + file;
  return "";
}

void obey(std::istringstream words) {
  std::string what;
  int a = 0, b = 0, c = 0;
  words >> what >> a >> b >> c;
  if (what == "tap") {
    const auto before = now_ns();
    down(0, a, b);
    const auto after = now_ns();
    std::cout << "tapped " << before << ' ' << after << std::endl;
    sleep_ms(60);
    up(0);
  } else if (what == "down") {
    down(a, b, c);
  } else if (what == "move") {
    emit(EV_ABS, ABS_MT_SLOT, a);
    emit(EV_ABS, ABS_MT_POSITION_X, b);
    emit(EV_ABS, ABS_MT_POSITION_Y, c);
    one_finger(a, b, c);
    emit(EV_SYN, SYN_REPORT, 0);
  } else if (what == "up") {
    up(a);
  } else if (what == "sleep") {
    sleep_ms(a);
  } else if (what == "mouse") {
    move_mouse(a, b);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "touch_panel WIDTH HEIGHT\n"), 2;
  panel = open_uinput();
  for (const int type : {EV_SYN, EV_KEY, EV_ABS}) ::ioctl(panel, UI_SET_EVBIT, type);
  ::ioctl(panel, UI_SET_KEYBIT, BTN_TOUCH);
  ::ioctl(panel, UI_SET_PROPBIT, INPUT_PROP_DIRECT);
  axis(ABS_X, std::atoi(argv[1]) - 1);
  axis(ABS_Y, std::atoi(argv[2]) - 1);
  axis(ABS_MT_SLOT, 9);
  axis(ABS_MT_TRACKING_ID, 65535);
  axis(ABS_MT_POSITION_X, std::atoi(argv[1]) - 1);
  axis(ABS_MT_POSITION_Y, std::atoi(argv[2]) - 1);
  create(panel, "bench touch panel");
  sleep_ms(100);
  std::cout << "device " << device_path() << std::endl;
  for (std::string line; std::getline(std::cin, line) && line != "gone";) obey(std::istringstream(line));
  ::ioctl(panel, UI_DEV_DESTROY);
}
