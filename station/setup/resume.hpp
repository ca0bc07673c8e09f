#pragma once
#include <iosfwd>
#include <optional>
#include <string>

#include "station/session/session.hpp"

namespace turnpoint::setup {

/// What `turnpoint resume` was asked for.
struct ResumeRequest {
  std::string database, session_id;  ///< session_id "": the newest interrupted one
  std::string
      policy;  ///< "" (the protocol's; being called is the answer to "ask") | resume | restart | block
  bool headless = false;
  bool any_age = false;  ///< also a session older than its protocol allows: the clock was wrong
};

/// The set-up that continues an interrupted session: rig, protocol text, observer and language from its
/// row. None where nothing was interrupted. Throws text::BadInput for a session older than its protocol
/// allows, and store::StoreError.
std::optional<session::Setup> prepare_resume(const ResumeRequest& request, std::ostream& messages);

}  // namespace turnpoint::setup
