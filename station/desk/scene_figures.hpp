#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/desk/preview.hpp"
#include "station/plot/chart.hpp"

namespace turnpoint::desk {

// Pictures of a planned scene, the same on the screen and in files. All throw std::invalid_argument for a
// look that has a problem instead of a plan.

/// A picture that lays itself out for the size at which it is shown: an SVG document of about that size, with
/// text of 12 px.
using Drawing = std::function<std::string(double width_px, double height_px)>;
Drawing drawing_of(plot::Figure figure);
/// The same of surface_svg().
Drawing drawing_of_surface(const SceneLook& look, const rig::Rig& rig);

/// The surface from above, to scale along its length: a heat map of the displacement, the boundary with its
/// model error, turning points of the tones, and a mark where one is asked about. An SVG document.
std::string surface_svg(const SceneLook& look, const rig::Rig& rig, double width_px = 860,
                        double height_px = 190);

/// Displacement and friction along the centre line, with the boundary; several scenes in the order presented,
/// numbered. Throws std::invalid_argument for no look at all.
plot::Figure profile_figure(const std::vector<SceneLook>& looks);

/// The drive's tones: displacement of the drive edge against frequency.
plot::Figure spectrum_figure(const SceneLook& look);

}  // namespace turnpoint::desk
