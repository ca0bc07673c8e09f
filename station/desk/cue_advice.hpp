#pragma once
#include <string>

namespace turnpoint::desk {

/// What a researcher can do about a cue that gives answers away. `cue` is the name of a
/// simulation::CueReport. Throws std::logic_error for any other name.
std::string cue_advice(const std::string& cue);

}  // namespace turnpoint::desk
