#pragma once
#include <iosfwd>
#include <optional>
#include <string>

#include "station/session/session.hpp"

namespace turnpoint::setup {

/// The options of `turnpoint resume`.
struct ResumeRequest {
  std::string database, session_id;  ///< session_id "": the newest interrupted one
  std::string
      policy;  ///< "" (the protocol's; being called is the answer to "ask") | resume | restart | block
  bool headless = false;
  /// continue even a session older than its protocol allows, for example because the clock was wrong
  bool any_age = false;
};

/// The setup for continuing an interrupted session: rig, protocol text, observer and language are taken from
/// its row. Empty if no session was interrupted. Throws text::BadInput for a session older than its protocol
/// allows, and store::StoreError.
std::optional<session::Setup> prepare_resume(const ResumeRequest& request, std::ostream& messages);

}  // namespace turnpoint::setup
