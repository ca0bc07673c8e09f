#pragma once
#include <string>
#include <vector>

#include "station/core/problem.hpp"

namespace turnpoint::protocol {

/// What becomes of a planned session that was begun but not completed, and is not resumed.
enum class Unfinished {
  repeat,  ///< the participant's next session is the same planned session, from its beginning
  count    ///< it counts: the next session is the next planned one
};

/// The sessions of each participant, on one day or on several.
struct SessionPlan {
  int count = 1;
  /// The least number of calendar days from one session to the next; 0: sessions may be on the same day.
  int min_days = 0;
  Unfinished incomplete = Unfinished::repeat;
  core::Place place;
};

/// The sessions and groups that have a part of the plan, such as a block. An empty list stands for all.
struct Audience {
  std::vector<int> sessions;  ///< numbers of the planned sessions, from 1
  std::vector<std::string>
      groups;  ///< groups of participants, by the name of the level that they were assigned
};

/// Which session of which participant is run. If only one number is given, it is the participant's place in
/// the counterbalancing, and the session is the first.
struct Visit {
  Visit(int place_in_design = 0, int number = 1) : place(place_in_design), session(number) {}
  int place;    ///< the participant's place in the counterbalancing, from 0
  int session;  ///< number of the planned session, from 1
  bool operator==(const Visit&) const = default;
};

}  // namespace turnpoint::protocol
