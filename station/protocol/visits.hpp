#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/core/records.hpp"
#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// True if the factor is drawn per participant.
bool is_group(const Factor& factor);

/// Number of groups: 1 if no factor is drawn per participant, otherwise the number of combinations of their
/// levels.
int group_count(const Protocol& protocol);

/// The levels that the participant at this place in the counterbalancing has in all sessions. Neighbouring
/// places belong to different groups.
Factors group_of(const Protocol& protocol, int place);

/// The names of all groups: the participant at place p belongs to group number p modulo their count. Empty if
/// there are no groups.
std::vector<std::string> group_names(const Protocol& protocol);

/// Number of different places: participants whose places differ by a multiple of it have the same group and
/// the same orders of blocks in all sessions. This can be more than needed if a sequence with one level per
/// session has more levels than there are sessions.
int place_count(const Protocol& protocol);

/// The rows of the design and what a participant does to complete; if nobody is replaced, with an infinite
/// time.
core::Assignment design(const Protocol& protocol);

/// How the protocol replaces participants who drop out; empty if it does not.
std::optional<core::Assignment> assignment(const Protocol& protocol);

/// Number of planned sessions; 1 if the protocol plans none.
int session_count(const Protocol& protocol);

/// True if a part of the plan for this audience belongs to the session of this visit.
bool is_for(const Audience& audience, const Protocol& protocol, const Visit& visit);

/// Each planned session of each group. The blocks of other visits differ from these only in their order.
std::vector<Visit> different_visits(const Protocol& protocol);

/// The name of the group to which a visit's place in the counterbalancing belongs; "" if the protocol has no
/// groups.
std::string group_name(const Protocol& protocol, const Visit& visit);

/// How people call a visit: "session 2", "session 2, group trained", "group trained"; "" if the protocol has
/// neither planned sessions nor groups.
std::string in_words(const Protocol& protocol, const Visit& visit);

}  // namespace turnpoint::protocol
