#pragma once
#include <string>

namespace turnpoint::session {

/// What the station itself says to a participant, beside the protocol's own texts.
enum class Word {
  practice,
  practice_again,
  get_ready,
  right,
  wrong,
  too_early,
  too_late,
  rest,
  rest_text,
  fault,
  paused,
  thanks,
  thanks_early
};

/// In the language asked for (two-letter code), or in English where the station does not speak it.
std::string word(Word word, const std::string& language);

}  // namespace turnpoint::session
