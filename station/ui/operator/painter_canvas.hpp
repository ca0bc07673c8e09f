#pragma once
#include <QPainter>

#include "station/report/canvas.hpp"

namespace turnpoint::ui {

/// Paints a figure as large as possible into the middle of a rectangle of the screen, in the pages' font.
class PainterCanvas : public report::Canvas {
 public:
  /// How the colours of a figure are shown. In the dark, light and dark change places; hues stay.
  enum class Tone { paper, dark };

  PainterCanvas(QPainter& painter, const QRectF& into, Tone tone = Tone::paper)
      : painter_(painter), into_(into), tone_(tone) {}
  ~PainterCanvas() override;
  Q_DISABLE_COPY_MOVE(PainterCanvas)

  void begin(double width, double height, const std::string& title) override;
  void line(report::Point from, report::Point to, const report::Paint& paint) override;
  void polyline(const std::vector<report::Point>& points, const report::Paint& paint) override;
  void polygon(const std::vector<report::Point>& points, const report::Paint& paint) override;
  void rectangle(report::Point corner, double width, double height, const report::Paint& paint) override;
  void circle(report::Point centre, double radius, const report::Paint& paint) override;
  void text(report::Point at, const std::string& text, double size, report::Anchor anchor,
            const std::string& colour, int weight, double degrees) override;
  void begin_clip(report::Point corner, double width, double height) override;
  void end_clip() override;

 private:
  void use(const report::Paint& paint);
  QColor shown(const std::string& colour) const;

  QPainter& painter_;
  QRectF into_;
  Tone tone_;
  int saved_ = 0;  ///< number of saved states of the painter that must be restored
};

}  // namespace turnpoint::ui
