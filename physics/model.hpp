#pragma once
// The models, from the cheapest to the most exact.
#include <array>
#include <string_view>

namespace turnpoint::physics {

// edge     gives positions only, x = W0/d - C/f in closed form, or from a table
// airy     equations 21-22 of the 1998 paper, Ai(k0 (x - x0)); without loss
// seed     equation 11 of the 1998 paper, solved to rounding accuracy
// uniform  Langer & Olver's uniform Airy approximation of the flux-corrected equation; without loss
// mode     flux-corrected first transverse mode with loss, bending and any taper, solved to rounding accuracy
// modes    coupled transverse modes with a straight drive edge, that is, the two-dimensional field (not for
// the
//          plate theory elastic, and for the theory mindlin only with the drive cosine)
enum class Model { edge, airy, seed, uniform, mode, modes };

inline constexpr std::array all_models{Model::edge,    Model::airy, Model::seed,
                                       Model::uniform, Model::mode, Model::modes};

// The names "edge" ... "modes". `parse_model` throws std::invalid_argument listing them.
std::string_view name(Model model);
Model parse_model(std::string_view text);

}  // namespace turnpoint::physics
