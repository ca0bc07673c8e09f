#pragma once
#include <iosfwd>
#include <optional>
#include <string>

#include "station/session/session.hpp"

namespace turnpoint::session {

/// The options of `turnpoint resume`.
struct ResumeRequest {
  /// `session_id` is the session to continue; "" continues the newest interrupted one
  std::string database, session_id;
  std::string
      policy;  ///< resume | restart | block; "" uses the protocol's policy, and "ask" then means resume
  bool headless = false;
  /// continue the session although it is older than its protocol allows, for example because the clock was
  /// wrong
  bool any_age = false;
  bool self_test = false;  ///< run the self-test first, unless the session is simulated
  /// reason to continue although a check of the self-test failed; if "", the operator is asked
  std::string despite = {};
};

/// Returns the setup for continuing an interrupted session. Rig, protocol text, observer and language are
/// those stored with the session. Empty if no session was interrupted. Throws core::BadInput for a session
/// older than its protocol allows, and store::StoreError.
std::optional<Setup> prepare_resume(const ResumeRequest& request, std::ostream& messages);

}  // namespace turnpoint::session
