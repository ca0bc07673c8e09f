#pragma once
#include "station/text/keys.hpp"

namespace turnpoint::procedure {

/// The keys of a [[procedure]] table with which a procedure chooses its levels. Which of them have an effect
/// depends on its kind.
text::Keys procedure_keys();

}  // namespace turnpoint::procedure
