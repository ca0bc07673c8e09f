#include "station/session/early_session.hpp"

#include <fmt/format.h>

namespace turnpoint::session {

std::string describe(const EarlySession& early) {
  return fmt::format(
      "participant {} had session {} on {}, and the protocol asks for at least {} day{} between sessions: "
      "session {} is allowed from {}",
      early.participant, early.last_number, early.last_day, early.min_days, early.min_days == 1 ? "" : "s",
      early.number, early.allowed_from);
}

}  // namespace turnpoint::session
