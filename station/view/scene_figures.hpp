#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/report/chart.hpp"
#include "station/view/preview.hpp"

namespace turnpoint::view {

// Figures of a planned scene, for the screen and for files, in a language such as "de". All functions throw
// std::invalid_argument if the scene has a problem instead of a plan.

/// Draws a figure at about the given size, with text of 12 px. The layout of the figure depends on that size.
using Drawing = std::function<void(report::Canvas& canvas, double width_px, double height_px)>;
Drawing drawing_of(report::Figure figure);
/// Returns the picture of surface_svg() as a Drawing, for the screen.
Drawing drawing_of_surface(const SceneLook& look, const rig::Rig& rig, const std::string& language = "en");

/// Returns an SVG document that shows the surface from above, to scale along its length. It contains a heat
/// map of the displacement, the boundary with its model error, the turning points of the tones, and the mark,
/// if a question refers to one.
std::string surface_svg(const SceneLook& look, const rig::Rig& rig, double width_px = 860,
                        double height_px = 190);

/// Plots displacement and friction along the centre line, with the boundary. Several scenes are numbered in
/// the order of presentation. Throws std::invalid_argument if `looks` is empty.
report::Figure profile_figure(const std::vector<SceneLook>& looks, const std::string& language = "en");

/// Plots the drive's tones: displacement of the drive edge against frequency.
report::Figure spectrum_figure(const SceneLook& look, const std::string& language = "en");

}  // namespace turnpoint::view
