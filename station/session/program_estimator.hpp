#pragma once
#include <map>
#include <string>
#include <vector>

#include "station/core/records.hpp"
#include "station/procedure/procedure.hpp"
#include "station/protocol/protocol.hpp"
#include "station/session/conversation.hpp"

namespace turnpoint::session {

/// What a separate program has estimated, and which program it was.
struct Estimated {
  Identity program;
  std::map<std::string, procedure::Estimate> estimates;
};

/// Reads the member "estimates" of a message. Throws core::ProgramFailed if it is not as it should be.
std::map<std::string, procedure::Estimate> estimates_in(const Json& message, const Conversation& from);

/// Gives the trials of a session to the program that the option `--estimator` names, and returns its
/// estimates. Experimental trials of the last attempt at each block count. Throws core::UsageError and
/// core::ProgramFailed.
Estimated estimated_by(const std::string& estimator, const protocol::Protocol& protocol,
                       const std::vector<core::BlockRecord>& blocks);

}  // namespace turnpoint::session
