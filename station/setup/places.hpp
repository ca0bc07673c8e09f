#pragma once
#include <iosfwd>
#include <string>

namespace turnpoint::setup {

/// The rig file to use: the one named, else /etc/turnpoint/rig.toml, else the simulated rig that comes with
/// the program. What was chosen for the user is said on `messages`. Throws text::BadInput where there is
/// none.
std::string rig_or_default(const std::string& named, std::ostream& messages);

/// A folder that comes with the program ("protocols", "deploy/rigs"), in the source tree or as installed.
std::string shipped(const std::string& folder);

/// The station's own database: in the user's data folder ($XDG_DATA_HOME, else ~/.local/share).
std::string default_database();

/// The kernel's graphics card that a screen is connected to, "/dev/dri/card1"; without a screen the first
/// that has a connector, "" where none has: a board's first card may be one that only draws. `drm` is where
/// the kernel lists them.
std::string screen_card(const std::string& drm = "/sys/class/drm");

}  // namespace turnpoint::setup
