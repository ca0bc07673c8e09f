#pragma once
#include <string>

namespace turnpoint::desk {

/// Returns advice for the researcher about a cue that gives answers away. `cue` is the name of a
/// simulation::CueReport. Throws std::logic_error for any other name.
std::string cue_advice(const std::string& cue);

}  // namespace turnpoint::desk
