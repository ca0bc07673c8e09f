#pragma once
#include <linux/input.h>

#include <map>
#include <string>
#include <vector>

/// An input device for one test. libevdev queries its properties and state by ioctl, as it queries the
/// kernel, and reads the events that the test sends. (The test program's own ioctl() takes precedence over
/// the library's.)
class FakeEvdev {
 public:
  /// A panel of 800 x 480 with this many slots for fingers; 0: a panel that cannot tell fingers apart.
  explicit FakeEvdev(int slot_count);
  /// The same, for programs that open it by this path.
  FakeEvdev(int slot_count, const std::string& path);
  FakeEvdev(const FakeEvdev&) = delete;
  FakeEvdev& operator=(const FakeEvdev&) = delete;
  ~FakeEvdev();

  /// The caller owns it and must close it. A device with a path has none.
  int descriptor() const { return ends_[0]; }
  /// Removes a device with a path; its reader gets an error.
  void unplug();
  /// Sends an event; time in microseconds.
  void send(long time_us, int type, int code, int value);

  /// The kernel's current state, whether or not events reported it.
  bool touched = false;
  std::map<int, int> axes;                      ///< value of each axis
  std::vector<std::map<int, int>> slot_values;  ///< ABS_MT_... of each slot

  int answer(unsigned long request, void* argument) const;
  bool is(int descriptor) const;

 private:
  void set_axes(int slot_count);

  int ends_[2] = {-1, -1};
  std::string path_;
};
