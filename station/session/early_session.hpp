#pragma once
#include <string>
#include <utility>

#include "station/text/problem.hpp"

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

/// A session that is possible, except that it would begin too early.
class TooEarly : public text::BadInput {
 public:
  TooEarly(text::Problem problem, EarlySession early)
      : BadInput({std::move(problem)}), early_(std::move(early)) {}
  const EarlySession& early() const { return early_; }

 private:
  EarlySession early_;
};

}  // namespace turnpoint::session
