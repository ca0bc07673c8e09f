#pragma once
#include <iosfwd>
#include <string>

namespace turnpoint::session {

/// Returns the rig file to use: `named` if it is not ""; otherwise /etc/turnpoint/rig.toml; otherwise the
/// simulated rig that comes with the program. If `named` is "", prints the choice on `messages`. Throws
/// core::BadInput if no file is found.
std::string rig_or_default(const std::string& named, std::ostream& messages);

/// Returns the path of a TOML file: `named` if it exists or contains a "/", otherwise the file of this name
/// in the shipped `folder` ("protocols", "deploy/rigs"), with or without ".toml". Returns "" if `named` is
/// "". Throws core::UsageError if there is neither.
std::string file_or_shipped(const std::string& named, const std::string& folder);

/// Returns the path of a folder that comes with the program ("protocols", "deploy/rigs"), installed or in the
/// source tree.
std::string shipped(const std::string& folder);

/// Returns the path of the station's own database, in the user's data folder ($XDG_DATA_HOME or
/// ~/.local/share). Throws core::UsageError if neither variable is set.
std::string default_database();

/// Returns the graphics card to which a screen is connected, such as "/dev/dri/card1". Without a screen,
/// returns the first card with a connector, or "" if there is none. (On some boards the first card has no
/// connector.) `drm` is the folder in which the kernel lists cards.
std::string screen_card(const std::string& drm = "/sys/class/drm");

}  // namespace turnpoint::session
