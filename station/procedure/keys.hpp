#pragma once
#include "station/core/reader.hpp"
#include "station/procedure/spec.hpp"

// Keys of a [[procedure]] table that several kinds of procedures share. The functions ..._key() and
// ..._keys() declare them; read_...() read them into the specification and report problems.
namespace turnpoint::procedure {

inline constexpr core::Range any_level{-1e6, 1e6};
inline constexpr core::Range positive_step{0, 1e6, core::Range::Ends::open_low};

core::Key scale_key();
void read_scale(core::TableReader& reader, Spec& spec);
/// "stop"; that of a track also ends it at the end of its range.
core::Key stop_key();
core::Key track_stop_key();
void read_stop(core::TableReader& reader, Spec& spec);
/// "right" and "of_last" of a table `stop`.
core::Keys right_of_last_keys();
void read_right_of_last(core::TableReader& stop, Spec& spec);
core::Key tracks_key();
void read_tracks(core::TableReader& reader, Spec& spec);
/// "repeats", "balance" and "order" of a list of levels.
core::Keys list_keys();
void read_list(core::TableReader& reader, Spec& spec);
/// "order" with "max_run" only, for procedures that have no list.
core::Key runs_key();
void read_runs(core::TableReader& reader, Spec& spec);
/// "min" and "max".
core::Keys range_keys();
/// "start", "min" and "max".
core::Keys span_keys();
void read_span(core::TableReader& reader, Spec& spec);
core::Key step_key();    ///< "step", one size
core::Key target_key();  ///< "target"

/// Reports problems with the starting level, its limits and its scale.
void validate_span(const Spec& spec, std::vector<Problem>& problems);

/// True if all values are finite and above 0; also true for an empty list.
bool positive(const std::vector<double>& values);

}  // namespace turnpoint::procedure
