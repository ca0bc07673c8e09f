#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace turnpoint::io {

/// How a line will be used. Inputs report both edges.
enum class LineUse { input, output_low };

/// Asks for a GPIO line by its name. The line may be on any chip, however the chips are numbered.
struct LineRequest {
  std::string name;      ///< name in the board's device tree
  std::string consumer;  ///< name that the kernel shows to other programs, e.g. "turnpoint-amp-enable"
  LineUse use = LineUse::input;
};

/// A change of the level of an input line, with the kernel's time stamp.
struct Edge {
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC time at which the interrupt occurred
  int line = 0;              ///< index of the line in the requests
  bool rising = false;       ///< true if the level after the edge is high
  /// number of the edge on this line, from 1; after a gap in the numbers, edges were lost because the
  /// kernel's buffer was full
  std::uint32_t sequence = 0;
};

/// Lines that were requested together. Outputs start low. They go low when this object is destroyed, provided
/// that the kernel releases them. Use an object from one thread only.
class Lines {
 public:
  virtual ~Lines() = default;

  /// Waits for an edge, but at most `timeout_ns` (0: does not wait), and only until the descriptor `wake`
  /// (-1: none) is readable. The edges of each line come in the order of their time stamps. Throws
  /// std::system_error: ENODEV if the chip was removed.
  virtual std::optional<Edge> wait(std::int64_t timeout_ns, int wake = -1) = 0;
  /// The current level of line `index`. Throws std::system_error.
  virtual bool level(int index) = 0;
  /// Sets the level of output line `index`. Throws std::system_error. Safe on a real-time thread: one system
  /// call.
  virtual void drive(int index, int level) = 0;
  /// The actual level of output `index`; empty if the chip cannot tell. Throws std::system_error: ENODEV if
  /// the chip was removed.
  virtual std::optional<bool> read_back(int index) = 0;
};

/// Why a line is not available: no chip has it (ENOENT), another program uses it (EBUSY; the message says
/// which), or access is denied (EACCES).
class LineError : public std::system_error {
 public:
  using std::system_error::system_error;
};

/// A function that requests lines. It is called at the start. After the chip of the lines was lost, it is
/// called again and again until the lines are back.
using OpenLines = std::function<std::unique_ptr<Lines>()>;

/// Requests kernel lines by name (libgpiod 1 or 2, as built). Throws LineError naming the line.
std::unique_ptr<Lines> open_gpio_lines(const std::vector<LineRequest>& requests);

/// Output lines that change together, in one request to the kernel. They start low. Use an object from one
/// thread only.
class Outputs {
 public:
  virtual ~Outputs() = default;
  /// Sets all lines: bit k of `levels` is the level of line k. Throws std::system_error.
  virtual void drive(std::uint32_t levels) = 0;
};

/// Requests output lines by name, all of them on one chip. Throws LineError naming the line.
std::unique_ptr<Outputs> open_gpio_outputs(const std::vector<std::string>& names,
                                           const std::string& consumer);

/// What `doctor` can find out about a named line without requesting it.
struct LineState {
  std::string name, chip;
  int offset = -1;
  bool used = false;
  std::string consumer;
};
std::optional<LineState> find_line(const std::string& name);
std::vector<std::string> gpio_chips();  ///< paths of the chips that can be opened

}  // namespace turnpoint::io
