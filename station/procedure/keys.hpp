#pragma once
#include "station/procedure/spec.hpp"
#include "station/text/reader.hpp"

// Keys of a [[procedure]] table that several kinds share. Each function reads its keys into the spec and
// reports problems.
namespace turnpoint::procedure {

inline constexpr text::Range any_level{-1e6, 1e6};

void read_scale(text::TableReader& reader, Spec& spec);
void read_stop(text::TableReader& reader, Spec& spec);
void read_tracks(text::TableReader& reader, Spec& spec);
/// Reads "repeats", "balance" and "order" of a list of levels.
void read_list(text::TableReader& reader, Spec& spec);
/// Reads "start", "min" and "max".
void read_span(text::TableReader& reader, Spec& spec);

/// Adds the problems of a start, its limits and its scale.
void validate_span(const Spec& spec, std::vector<Problem>& problems);

/// True if all values are above 0 and finite; also true for an empty list.
bool positive(const std::vector<double>& values);

}  // namespace turnpoint::procedure
