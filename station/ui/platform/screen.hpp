#pragma once
#include <QScreen>

namespace turnpoint::ui {

/// Pixels per millimetre of a panel, so that targets have their size in the hand and not in pixels. The
/// environment variable TURNPOINT_DPI takes precedence (for panels that report no size, or a wrong one). A
/// reported density outside 60-500 dpi is replaced by 96 dpi. Throws terms::UsageError for a TURNPOINT_DPI
/// that is not a number within that range.
double pixels_per_mm(const QScreen& screen);

/// Sets the application's fonts: families for each language shipped, in order of preference, so that a text
/// that mixes scripts finds all of its glyphs.
void set_fonts();

}  // namespace turnpoint::ui
