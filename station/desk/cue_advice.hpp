#pragma once
#include <string>

#include "station/texts/texts.hpp"

namespace turnpoint::desk {

/// What a page says about a cue that could give answers away: its name, and what the researcher can do about
/// it.
struct CueAdvice {
  texts::Phrase name, advice;
};
/// Returns what a page says about a cue. `cue` is the name of a simulation::CueReport. Throws
/// std::logic_error for any other name.
CueAdvice cue_advice(const std::string& cue);

}  // namespace turnpoint::desk
