#pragma once
#include <cstdlib>
#include <sstream>

#include "tests/support/catch.hpp"

namespace turnpoint::sensing {

/// How often simulated studies are repeated. With TURNPOINT_STUDIES=400, each study is repeated 400 times and
/// prints its figures. Otherwise it is repeated `everyday` times.
inline const char* const wanted_studies = std::getenv("TURNPOINT_STUDIES");
inline int repetitions(int everyday) {
  return wanted_studies != nullptr ? std::atoi(wanted_studies) : everyday;
}

template <typename... Parts>
void say(const Parts&... parts) {
  if (wanted_studies == nullptr) return;
  std::ostringstream text;
  (text << ... << parts);
  WARN(text.str());
}

}  // namespace turnpoint::sensing
