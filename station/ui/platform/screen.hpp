#pragma once
#include <QScreen>

namespace turnpoint::ui {

/// Pixels per millimetre of a panel, with which buttons get a size in millimetres. The environment variable
/// TURNPOINT_DPI takes precedence, for panels that report no size or a wrong one. A reported density outside
/// 60-500 dpi is replaced by 96 dpi. Throws core::UsageError for a TURNPOINT_DPI that is not a number within
/// that range.
double pixels_per_mm(const QScreen& screen);

/// The angle by which all pages are turned clockwise, for a panel that is not mounted upright: 0 or what the
/// environment variable TURNPOINT_ROTATION says, 90, 180 or 270 degrees. Throws core::UsageError for any
/// other value.
int panel_rotation_deg();

/// Sets the application's font and, for each script, the fonts to fall back on, in order of preference. A
/// text that mixes scripts then finds all of its glyphs. Catalogue::family says which languages need a
/// different first font.
void set_fonts();

}  // namespace turnpoint::ui
