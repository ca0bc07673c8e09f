#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/text/reader.hpp"

namespace turnpoint::procedure {

/// Where a procedure's levels come from.
enum class Choice {
  listed,     ///< fixed before the session
  track,      ///< from the answers, one step at a time; the report prints its estimate
  posterior,  ///< from the answers and an assumed psychometric function, which the report fits again
};

/// All that the rest of the station knows of a kind of procedure. The file of each kind defines its own, and
/// the table in procedure.cpp lists them.
struct Description {
  Kind kind;
  const char* name;  ///< in a protocol: kind = "up-down"
  Choice choice;
  /// Reads the keys of its own; name, kind, level and copy are read already.
  void (*read)(text::TableReader& reader, Spec& spec);
  /// Adds what is wrong with a spec, whatever file it came from.
  void (*validate)(const Spec& spec, std::vector<Fault>& faults);
  std::unique_ptr<Procedure> (*make)(const Spec& spec, const Context& context, const random::Key& key);
  /// The share of ones where its levels settle, between the least and the most share that there is; none
  /// where they do not, or where it is not known.
  std::optional<double> (*settles_at)(const Spec& spec, double least, double most);
};

const Description& description(Kind kind);
/// Whether the answers choose the levels.
inline bool follows_answers(const Spec& spec) { return description(spec.kind).choice != Choice::listed; }

}  // namespace turnpoint::procedure
