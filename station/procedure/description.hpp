#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "station/core/reader.hpp"
#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// How a procedure chooses its levels.
enum class Choice {
  listed,  ///< levels are fixed before the session
  /// the level moves up and down in steps that depend on the answers; the report prints the procedure's own
  /// estimate
  track,
  /// the level runs from a starting level in one direction until the answer changes, and this is repeated;
  /// the report prints the procedure's own estimates
  series,
  /// the answers update a posterior for an assumed psychometric function, and the posterior determines the
  /// levels; the report prints the procedure's own estimate and fits the psychometric function again
  posterior,
  program,  ///< a separate program chooses the levels; the report prints the estimates that it gave
};

/// Everything that the rest of the station needs to know about one kind of procedure. Each kind defines its
/// own description; the list in spec.hpp has all of them.
struct Description {
  const char* name;  ///< name of the kind in a protocol, such as "up-down"
  Choice choice;
  /// Declares the keys with which this kind chooses its levels, in the order of a form. Declarations that
  /// several kinds share are in keys.hpp. If the answers determine the levels, "order" is added for all of
  /// them.
  core::Keys (*keys)();
  /// Reads these keys from a [[procedure]] table. The keys name, kind, level and copy have already been read.
  void (*read)(core::TableReader& reader, Spec& spec);
  /// Appends all problems of a specification to `problems`.
  void (*validate)(const Spec& spec, std::vector<Problem>& problems);
  std::unique_ptr<Procedure> (*make)(const Spec& spec, const Context& context, const core::DrawKey& key);
  /// Returns the proportion of answers of 1 at the level on which the procedure converges. `least` and `most`
  /// are the participant's lowest and highest probability of an answer of 1. Empty if the procedure does not
  /// converge, or if the proportion is unknown.
  std::optional<double> (*settles_at)(const Spec& spec, double least, double most);
};

const Description& description(Kind kind);
/// The keys of a [[procedure]] table with which procedures of all kinds choose their levels, each with the
/// kinds that declare it.
core::Keys procedure_keys();
/// True if the answers determine the levels.
inline bool follows_answers(const Spec& spec) { return description(spec.kind).choice != Choice::listed; }

}  // namespace turnpoint::procedure
