#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/desk/preview.hpp"
#include "station/plot/chart.hpp"

namespace turnpoint::desk {

// Figures of a planned scene, for the screen and for files. All functions throw std::invalid_argument for a
// look that has a problem instead of a plan.

/// A figure that is laid out for the size at which it is shown: draws at about that size, with text of 12 px.
using Drawing = std::function<void(plot::Canvas& canvas, double width_px, double height_px)>;
Drawing drawing_of(plot::Figure figure);
/// The figure of surface_svg() as a Drawing.
Drawing drawing_of_surface(const SceneLook& look, const rig::Rig& rig);

/// The surface from above, to scale along its length: a heat map of the displacement, the boundary with its
/// model error, the turning points of the tones, and the mark that a question refers to, if any. An SVG
/// document.
std::string surface_svg(const SceneLook& look, const rig::Rig& rig, double width_px = 860,
                        double height_px = 190);

/// Displacement and friction along the centre line, with the boundary. Several scenes are numbered in the
/// order of presentation. Throws std::invalid_argument if there is no look.
plot::Figure profile_figure(const std::vector<SceneLook>& looks);

/// The drive's tones: displacement of the drive edge against frequency.
plot::Figure spectrum_figure(const SceneLook& look);

}  // namespace turnpoint::desk
