#pragma once
#include <map>
#include <string>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/programs/conversation.hpp"
#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"

namespace turnpoint::programs {

/// What a separate program has estimated, and which program it was.
struct Estimated {
  Identity program;
  std::map<std::string, procedure::Estimate> estimates;
};

/// Reads the member "estimates" of a message. Throws terms::ProgramFailed if it is not as it should be.
std::map<std::string, procedure::Estimate> estimates_in(const Json& message, const Conversation& from);

/// Gives the trials of a session to the program that the option `--estimator` names, and returns its
/// estimates. Experimental trials of the last attempt at each block count. Throws terms::UsageError and
/// terms::ProgramFailed.
Estimated estimated_by(const std::string& estimator, const protocol::Protocol& protocol,
                       const std::vector<records::BlockRecord>& blocks);

}  // namespace turnpoint::programs
