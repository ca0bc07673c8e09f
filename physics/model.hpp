#pragma once
// The models, from the cheapest to the most exact.
#include <array>
#include <string_view>

namespace turnpoint::physics {

// edge     positions only, closed form x = W0/d - C/f or a table
// airy     the seed's equations 21-22: Ai(k0 (x - x0)); lossless
// seed     the seed's equation 11 solved to rounding
// uniform  Langer-Olver uniform Airy approximation of the flux-corrected equation; lossless
// mode     flux-corrected first transverse mode: loss, bending, any taper; solved to rounding
// modes    coupled transverse modes, straight drive edge: the two-dimensional field (membranes and simply
//          supported plates)
enum class Model { edge, airy, seed, uniform, mode, modes };

inline constexpr std::array all_models{Model::edge,    Model::airy, Model::seed,
                                       Model::uniform, Model::mode, Model::modes};

// The names "edge" ... "modes". `parse_model` throws std::invalid_argument listing them.
std::string_view name(Model model);
Model parse_model(std::string_view text);

}  // namespace turnpoint::physics
