#include "station/ui/platform/screen.hpp"

#include <QFont>
#include <QGuiApplication>

#include "station/core/usage_error.hpp"

namespace turnpoint::ui {

namespace {
constexpr double kLowest_dpi = 60, kHighest_dpi = 500, kFallback_dpi = 96, kInch_mm = 25.4;

bool believable(double dpi) { return dpi >= kLowest_dpi && dpi <= kHighest_dpi; }
}  // namespace

double pixels_per_mm(const QScreen& screen) {
  const QString stated = qEnvironmentVariable("TURNPOINT_DPI");
  if (!stated.isEmpty()) {
    bool is_number = false;
    const double dpi = stated.toDouble(&is_number);
    if (!is_number || !believable(dpi)) {
      throw core::UsageError("TURNPOINT_DPI: " + stated.toStdString() + " dpi; allowed are 60 to 500 dpi");
    }
    return dpi / kInch_mm;
  }
  const double reported = screen.physicalDotsPerInch();
  return (believable(reported) ? reported : kFallback_dpi) / kInch_mm;
}

int panel_rotation_deg() {
  const QString stated = qEnvironmentVariable("TURNPOINT_ROTATION", "0");
  for (const int degrees : {0, 90, 180, 270})
    if (stated == QString::number(degrees)) return degrees;
  throw core::UsageError("TURNPOINT_ROTATION: \"" + stated.toStdString() +
                         "\"; allowed are 0, 90, 180 and 270 degrees");
}

void set_fonts() {
  QFont::insertSubstitutions(
      "Inter", {"Noto Sans Arabic UI", "Noto Sans Hebrew", "Noto Sans Devanagari UI", "DejaVu Sans",
                "M PLUS 1", "VL PGothic", "VL Gothic", "Noto Sans CJK JP"});
  QGuiApplication::setFont(QFont("Inter"));
}

}  // namespace turnpoint::ui
