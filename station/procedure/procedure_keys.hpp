#pragma once
#include "station/core/keys.hpp"

namespace turnpoint::procedure {

/// The keys of a [[procedure]] table with which a procedure chooses its levels. Which of them have an effect
/// depends on its kind.
core::Keys procedure_keys();

}  // namespace turnpoint::procedure
