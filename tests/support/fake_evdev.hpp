#pragma once
#include <linux/input.h>

#include <map>
#include <string>
#include <vector>

/// An input device for one test: libevdev asks it by ioctl what it is and what its state is, as it asks the
/// kernel, and reads the events that the test sends. (The test program's own ioctl() comes before the
/// library's.)
class FakeEvdev {
 public:
  /// A panel of 800 x 480 with so many slots for fingers; 0: one that does not tell fingers apart.
  explicit FakeEvdev(int slot_count);
  /// The same, for programs that open it by this path.
  FakeEvdev(int slot_count, const std::string& path);
  FakeEvdev(const FakeEvdev&) = delete;
  FakeEvdev& operator=(const FakeEvdev&) = delete;
  ~FakeEvdev();

  /// Who takes this over closes it. None for a device with a path.
  int descriptor() const { return ends_[0]; }
  /// A device with a path goes, and who reads it gets an error.
  void unplug();
  /// An event waits to be read; time in microseconds.
  void send(long time_us, int type, int code, int value);

  /// What the kernel knows now, whether or not it told.
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
