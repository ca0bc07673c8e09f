#pragma once
#include <iosfwd>
#include <string>

namespace turnpoint::setup {

/// The rig file to use: the named one, else /etc/turnpoint/rig.toml, else the simulated rig that comes with
/// the program. Prints its own choice on `messages`. Throws text::BadInput if there is none.
std::string rig_or_default(const std::string& named, std::ostream& messages);

/// A folder that comes with the program ("protocols", "deploy/rigs"), in the source tree or as installed.
std::string shipped(const std::string& folder);

/// The station's own database: in the user's data folder ($XDG_DATA_HOME, else ~/.local/share).
std::string default_database();

/// The graphics card to which a screen is connected, "/dev/dri/card1". Without a screen, the first card with
/// a connector; "" if there is none. A board's first card may have no connector. `drm` is where the kernel
/// lists cards.
std::string screen_card(const std::string& drm = "/sys/class/drm");

}  // namespace turnpoint::setup
