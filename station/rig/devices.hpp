#pragma once
#include <string>
#include <vector>

#include "station/rig/rig.hpp"
#include "station/text/reader.hpp"

namespace turnpoint::rig {

/// Reads the key "uri" of a table. `schemes` lists the allowed schemes; "*" at the end of one means that text
/// must follow it.
std::string read_uri(text::TableReader& reader, const std::vector<std::string>& schemes,
                     const std::string& allowed);

/// Reads [amplifier], [buttons], [contact] and [touch] of the file.
void read_devices(text::TableReader& file, Rig& rig);

}  // namespace turnpoint::rig
