#pragma once
#include <string>
#include <vector>

#include "station/core/reader.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::rig {

/// Reads the key "uri" of a table, whose allowed forms are declared, such as "sim:" and "alsa:DEVICE". Text
/// must follow the scheme if the form has text after it.
std::string read_uri(core::TableReader& reader);

/// Checks a URI `gpio:name=LINE,name=LINE`; other schemes are accepted. It must contain all names in
/// `needed`, may contain those in `optional`, and must contain no others.
void check_gpio(core::TableReader& reader, const std::string& uri, const std::vector<std::string>& needed,
                const std::vector<std::string>& optional);

/// Reads [amplifier], [buttons], [contact], [trigger_lines] and [touch] of the file.
void read_devices(core::TableReader& file, Rig& rig);

}  // namespace turnpoint::rig
