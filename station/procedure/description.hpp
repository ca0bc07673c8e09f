#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/text/reader.hpp"

namespace turnpoint::procedure {

/// How a procedure chooses its levels.
enum class Choice {
  listed,  ///< levels are fixed before the session
  track,   ///< answers move the level, one step at a time; the report prints the procedure's own estimate
  /// levels are chosen from the answers and an assumed psychometric function, which the report fits again
  posterior,
};

/// Everything that the rest of the station needs to know about a kind of procedure. Each kind defines its own
/// description, and the table in procedure.cpp lists them.
struct Description {
  Kind kind;
  const char* name;  ///< name of the kind in a protocol, such as "up-down"
  Choice choice;
  /// Reads the keys of this kind from a [[procedure]] table; name, kind, level and copy have been read
  /// already.
  void (*read)(text::TableReader& reader, Spec& spec);
  /// Adds the problems of a spec, whatever file it came from.
  void (*validate)(const Spec& spec, std::vector<Problem>& problems);
  std::unique_ptr<Procedure> (*make)(const Spec& spec, const Context& context, const random::Key& key);
  /// The share of ones on which the levels converge, given the smallest and largest possible share; empty if
  /// they do not converge or it is unknown.
  std::optional<double> (*settles_at)(const Spec& spec, double least, double most);
};

const Description& description(Kind kind);
/// True if the answers determine the levels.
inline bool follows_answers(const Spec& spec) { return description(spec.kind).choice != Choice::listed; }

}  // namespace turnpoint::procedure
