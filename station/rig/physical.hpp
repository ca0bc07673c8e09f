#pragma once
#include "physics/friction.hpp"
#include "physics/surface.hpp"
#include "physics/warning.hpp"
#include "station/core/texts.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::rig {

/// Converts the rig's surface and friction map to the types of the physics library. Throws
/// std::invalid_argument for values that the library does not accept.
physics::Surface surface_of(const Rig& rig);
physics::FrictionMap friction_of(const Rig& rig);

/// The outline of a rig's surface, for a drawing.
struct Outline {
  double length_mm = 0, wide_half_width_mm = 0, narrow_half_width_mm = 0;
  bool wide_end_left = true;
  bool operator==(const Outline&) const = default;
};
Outline outline_of(const Rig& rig);

/// Says a warning or a refusal of the physics library in a language that is chosen later.
core::Phrase phrase_of(const physics::Warning& warning);
core::Phrase phrase_of(const physics::Refused& refused);

}  // namespace turnpoint::rig
