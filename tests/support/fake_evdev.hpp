#pragma once
#include <linux/input.h>

#include <map>
#include <string>
#include <vector>

/// Simulates an input device. libevdev queries its properties and state by ioctl(), as with a real device,
/// and reads the events that the test sends. The test program defines its own ioctl(), which replaces that of
/// the C library. Up to four devices may exist at a time.
class FakeEvdev {
 public:
  /// Makes a panel of 800 x 480 with this many slots for fingers; with 0 slots it cannot tell fingers apart.
  explicit FakeEvdev(int slot_count);
  /// Makes the same panel for programs that open a device by its path.
  FakeEvdev(int slot_count, const std::string& path);
  FakeEvdev(const FakeEvdev&) = delete;
  FakeEvdev& operator=(const FakeEvdev&) = delete;
  ~FakeEvdev();

  /// A descriptor of the device. The caller owns and must close it. A device with a path has no descriptor
  /// here.
  int descriptor() const { return ends_[0]; }
  /// Removes a device that has a path; reading it then gives an error.
  void unplug();
  /// Sends an event; time in microseconds.
  void send(long time_us, int type, int code, int value);

  /// Whether the simulated kernel considers the panel touched now, even if no event has said so.
  bool touched = false;
  std::string name = "fake panel";
  std::vector<int> keys;                        ///< the buttons that the device has; BTN_TOUCH at first
  std::map<int, int> axes;                      ///< current value of each axis
  std::vector<std::map<int, int>> slot_values;  ///< current ABS_MT_... values of each slot

  int answer(unsigned long request, void* argument) const;
  bool is(int descriptor) const;

 private:
  void set_axes(int slot_count);

  int ends_[2] = {-1, -1};
  std::string path_;
};
