#pragma once
#include <string>

namespace turnpoint::session {

/// The station's own words for participants, in addition to the protocol's texts.
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

/// The word in this language (two-letter code), or in English if the station does not have the language.
std::string word(Word word, const std::string& language);

}  // namespace turnpoint::session
