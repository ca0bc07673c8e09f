#pragma once
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// The word for an event in files and records: "trial", "onset", "change" or "response".
const char* name(TriggerEvent event);
/// The names of all events, in the order of TriggerEvent.
std::vector<std::string> trigger_event_names();

/// All codes of the protocol: those that the file states, and the default codes of the other events. With k
/// events to send, event e (from 0, in the order of `send`) in condition c (from 0, in the order of
/// conditions()) has the code 1 + e + k c. Trials that belong to no condition, such as practice, come after
/// the last condition. Codes above 255 mean that the protocol has too many conditions.
std::vector<TriggerCode> trigger_codes(const Protocol& protocol);

/// Returns the trigger code of an event in a trial with these factors; 0 if the event has no code.
int trigger_code(const Protocol& protocol, TriggerEvent event, const Factors& factors);

}  // namespace turnpoint::protocol
