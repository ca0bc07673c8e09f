#pragma once
#include <string>
#include <utility>

#include "station/terms/usage_error.hpp"

namespace turnpoint::session {

/// A planned session that would begin before the protocol's minimum number of days has passed. Dates look
/// like 2026-11-24.
struct EarlySession {
  std::string participant;
  int number = 0;            ///< the session that would begin
  std::string allowed_from;  ///< the first day on which it may begin
  int last_number = 0;       ///< the participant's last session
  std::string last_day;
  int min_days = 0;  ///< the protocol's minimum number of days between sessions
};

/// Describes it in English, for the command line and the log.
std::string describe(const EarlySession& early);

/// A session that does not begin because it would be too early.
class TooEarly : public terms::UsageError {
 public:
  TooEarly(const std::string& what, EarlySession early) : UsageError(what), early_(std::move(early)) {}
  const EarlySession& early() const { return early_; }

 private:
  EarlySession early_;
};

}  // namespace turnpoint::session
