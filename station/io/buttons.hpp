#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/io/contact.hpp"

namespace turnpoint::io {

/// A press of a response button that lasted long enough to count. Its time stamp is that of the first edge of
/// the bouncing.
struct Press {
  std::int64_t time_ns = 0;  ///< kernel's time stamp of the first edge (CLOCK_MONOTONIC)
  int button = 0;            ///< index of the button in the order of the URI
};

/// Interference on a line: the level changed and changed back before it could count as a press or a touch.
struct Glitch {
  std::int64_t time_ns = 0;    ///< kernel's time stamp of the first edge (CLOCK_MONOTONIC)
  std::string line;            ///< name of the line: "left", "right", "contact"
  int edges = 0;               ///< number of edges that the kernel reported
  std::int64_t length_ns = 0;  ///< time from the first to the last edge
  int untold = 0;              ///< number of earlier glitches of this line that were not reported
};

/// A fault of the buttons or of the finger contact.
struct ButtonsFault {
  enum class Kind {
    edges_lost,  ///< edges came faster than they were read, and the kernel's buffer overflowed
    gone,        ///< a GPIO chip or a touch sensor was lost; the station looks for it until it is back
  };
  std::int64_t time_ns = 0;
  Kind kind = Kind::gone;
  std::string what;
};

/// Functions called on the thread that watches the buttons; they must return quickly.
struct ButtonsHandlers {
  std::function<void(const Press&)> press;
  std::function<void(const Contact&)> contact;
  std::function<void(const Glitch&)> glitch;  ///< called at most once per second for each line
  std::function<void(const ButtonsFault&)> fault;
  /// called when the lost device is back; a button that is held down at that time does not count as a press
  std::function<void(std::int64_t time_ns)> back;
};

/// The URI of the buttons: `sim:` or `gpio:left=BTN_L,right=BTN_R`, with `active=low` for buttons that
/// connect to ground. `hold_ms` (default 1.5) is how long a level must last to count. `refractory_ms`
/// (default 50) is the dead time after a press or release; see EdgeFilter.
struct ButtonsConfig {
  std::string uri = "sim:";
};

/// The URI of the finger contact: `sim:`, `gpio:line=FINGER` (with the keys of ButtonsConfig) or
/// `evdev:NAME[,axis=x|y]` (a touch sensor on the surface; NAME is the name of its input device).
struct ContactConfig {
  std::string uri = "sim:";
};

/// Response buttons and finger contact, watched by a separate thread during the lifetime of this object.
class Buttons {
 public:
  virtual ~Buttons() = default;
  /// Names of the buttons in the order of the URI ("left", "right"); empty without buttons.
  virtual const std::vector<std::string>& names() const = 0;
  /// Which device is lost at present, and why; "" if none.
  virtual std::string missing() const = 0;

  /// Simulates this event, for simulated buttons only. Throws std::logic_error on real ones.
  virtual void simulate(const Press& press) = 0;
  virtual void simulate(const Contact& touch) = 0;
};

/// Opens the rig's buttons and contact; either may be absent. Throws core::UsageError for a URI that is not
/// understood, and LineError or std::system_error for a device that does not exist.
std::unique_ptr<Buttons> open_buttons(const std::optional<ButtonsConfig>& buttons,
                                      const std::optional<ContactConfig>& contact, ButtonsHandlers handlers);

}  // namespace turnpoint::io
