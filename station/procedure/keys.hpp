#pragma once
#include "station/core/reader.hpp"
#include "station/procedure/spec.hpp"

// Readers for keys of a [[procedure]] table that several kinds of procedures share. The functions read_...()
// read these keys into the specification and report problems.
namespace turnpoint::procedure {

inline constexpr core::Range any_level{-1e6, 1e6};

void read_scale(core::TableReader& reader, Spec& spec);
void read_stop(core::TableReader& reader, Spec& spec);
/// Reads "right" and "of_last" of a table `stop`.
void read_right_of_last(core::TableReader& stop, Spec& spec);
void read_tracks(core::TableReader& reader, Spec& spec);
/// Reads "repeats", "balance" and "order" of a list of levels.
void read_list(core::TableReader& reader, Spec& spec);
/// Reads "max_run" of "order", for procedures that have no list.
void read_runs(core::TableReader& reader, Spec& spec);
/// Reads "start", "min" and "max".
void read_span(core::TableReader& reader, Spec& spec);

/// Reports problems with the starting level, its limits and its scale.
void validate_span(const Spec& spec, std::vector<Problem>& problems);

/// True if all values are finite and above 0; also true for an empty list.
bool positive(const std::vector<double>& values);

}  // namespace turnpoint::procedure
