#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/core/reader.hpp"
#include "station/procedure/spec.hpp"

namespace turnpoint::procedure {

inline constexpr int most_grid_points = 10001;

/// Reads a grid in one of the forms that are declared for the key `key` of `outer`, such as { from, to, step
/// }, and computes its values, which are the same on every machine.
Grid read_grid(const core::Value& table, core::TableReader& outer, const std::string& key);

/// Returns the smallest power of 10 by which all values become whole numbers, up to 10^9; 0 if none does.
double decimal_places(const std::vector<double>& values);

/// Returns from + steps * step. If `from` and `step` are decimal fractions, this is the number nearest to the
/// exact decimal, so that a level is the same to the last bit from wherever it was reached.
double at_step(double from, std::int64_t steps, double step);

/// Reads a prior in one of the forms { normal = { mean, sd } } or { weights = [...] }.
Prior read_prior(const core::Value& table, core::TableReader& outer, const std::string& key);

}  // namespace turnpoint::procedure
