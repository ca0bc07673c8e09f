#pragma once
// The wave models of the surface, from the cheapest to the most exact.
#include <array>
#include <string_view>

namespace turnpoint::physics {

// edge  gives positions only: in closed form (linear taper: x = W0/d - C/f, with W0 the half-width at the
//       drive edge, d the slope and C a constant), or from a table
// mode  flux-corrected first transverse mode with loss, bending and any taper, solved to rounding accuracy
// modes coupled transverse modes with a straight drive edge, that is, the two-dimensional field; not for
//       the plate theory elastic, and for the theory mindlin only with the drive cosine
enum class Model { edge, mode, modes };

inline constexpr std::array all_models{Model::edge, Model::mode, Model::modes};

// Converts a model to its name, "edge" ... "modes", and back. `parse_model` throws std::invalid_argument with
// a list of the names.
std::string_view name(Model model);
Model parse_model(std::string_view text);

}  // namespace turnpoint::physics
