#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace turnpoint::lines {

/// What a line is wanted for. Inputs report both edges.
enum class LineUse { input, output_low };

/// A GPIO line is found by its name, whatever chip it is on and however the chips are numbered.
struct LineRequest {
  std::string name;      ///< as the board's device tree names it
  std::string consumer;  ///< shown by the kernel to others, e.g. "turnpoint-amp-enable"
  LineUse use = LineUse::input;
};

/// A change of an input with the kernel's own time stamp.
struct Edge {
  std::int64_t time_ns = 0;    ///< CLOCK_MONOTONIC, when the interrupt was taken
  int line = 0;                ///< index into the requests
  bool rising = false;         ///< level after the edge
  std::uint32_t sequence = 0;  ///< of this line, from 1; a gap means that the kernel's buffer overflowed
};

/// Lines requested together. Outputs start low and go low when this is destroyed, as far as the kernel
/// releases them. One thread uses them.
class Lines {
 public:
  virtual ~Lines() = default;

  /// Waits at most `timeout_ns` (0: not at all) for an edge, and no longer than until the descriptor `wake`
  /// (-1: none) can be read. Edges come in the order of their time stamps per line. Throws std::system_error:
  /// ENODEV when the chip has gone.
  virtual std::optional<Edge> wait(std::int64_t timeout_ns, int wake = -1) = 0;
  /// The level of line `index` now. Throws std::system_error.
  virtual bool level(int index) = 0;
  /// Drives output `index`. Throws std::system_error. Safe on a real-time thread: one system call.
  virtual void drive(int index, int level) = 0;
  /// The level that output `index` really has; none where the chip cannot tell. Throws std::system_error:
  /// ENODEV when the chip has gone.
  virtual std::optional<bool> read_back(int index) = 0;
};

/// Why a line could not be had: it is on no chip (ENOENT), in use by another (EBUSY; the message says by
/// whom), or the kernel denies it (EACCES).
class LineError : public std::system_error {
 public:
  using std::system_error::system_error;
};

/// Requests lines: at the start, and again once their chip has gone, until it is back.
using OpenLines = std::function<std::unique_ptr<Lines>()>;

/// Requests kernel lines by name (libgpiod 1 or 2, as built). Throws LineError naming the line.
std::unique_ptr<Lines> open_gpio_lines(const std::vector<LineRequest>& requests);

/// Which kernel interface this build uses: "libgpiod 1.6.3".
std::string gpio_library();

/// What is known about a named line without requesting it: for `doctor`.
struct LineState {
  std::string name, chip;
  int offset = -1;
  bool used = false;
  std::string consumer;
};
std::optional<LineState> find_line(const std::string& name);
std::vector<std::string> gpio_chips();  ///< paths of the chips that can be opened

}  // namespace turnpoint::lines
