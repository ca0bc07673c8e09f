#pragma once
#include <string>

#include "station/procedure/spec.hpp"
#include "station/text/reader.hpp"

namespace turnpoint::procedure {

/// Whether an axis contains levels to present, or a parameter (which may be tied to another one).
enum class Axis { stimuli, parameter };

/// Reads { from, to, step }, { from, to, count }, { log_from, log_to, count }, { values } or { tied = "lapse"
/// } and computes all values, with the same result on every machine.
Grid read_grid(const text::Value& table, const std::string& name, Axis axis, text::Findings& findings);

/// Reads { normal = { mean, sd } } or { weights = [...] }.
Prior read_prior(const text::Value& table, const std::string& name, text::Findings& findings);

}  // namespace turnpoint::procedure
