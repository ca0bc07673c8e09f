#pragma once
#include <string>
#include <vector>

#include "physics/tone.hpp"

namespace turnpoint::cli {

/// Parses `HZ[:UM[:DEG]]`: frequency, peak displacement of the drive edge (default 1 um) and phase. Throws
/// UsageError naming the text and what is allowed.
physics::Tone parse_tone(const std::string& text);
std::vector<physics::Tone> parse_tones(const std::vector<std::string>& texts);

/// Parses numbers separated by commas, such as `1,2.5,3`. Throws UsageError naming the option.
std::vector<double> parse_list(const std::string& text, const std::string& option);

}  // namespace turnpoint::cli
