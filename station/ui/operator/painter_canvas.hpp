#pragma once
#include <QPainter>

#include "station/plot/canvas.hpp"

namespace turnpoint::ui {

/// Paints a figure as large as possible into the middle of a rectangle of the screen, in the pages' font.
class PainterCanvas : public plot::Canvas {
 public:
  /// How the colours of a figure are shown. In the dark, light and dark change places; hues stay.
  enum class Tone { paper, dark };

  PainterCanvas(QPainter& painter, const QRectF& into, Tone tone = Tone::paper)
      : painter_(painter), into_(into), tone_(tone) {}
  ~PainterCanvas() override;
  Q_DISABLE_COPY_MOVE(PainterCanvas)

  void begin(double width, double height, const std::string& title) override;
  void line(plot::Point from, plot::Point to, const plot::Paint& paint) override;
  void polyline(const std::vector<plot::Point>& points, const plot::Paint& paint) override;
  void polygon(const std::vector<plot::Point>& points, const plot::Paint& paint) override;
  void rectangle(plot::Point corner, double width, double height, const plot::Paint& paint) override;
  void circle(plot::Point centre, double radius, const plot::Paint& paint) override;
  void text(plot::Point at, const std::string& text, double size, plot::Anchor anchor,
            const std::string& colour, int weight, double degrees) override;
  void begin_clip(plot::Point corner, double width, double height) override;
  void end_clip() override;

 private:
  void use(const plot::Paint& paint);
  QColor shown(const std::string& colour) const;

  QPainter& painter_;
  QRectF into_;
  Tone tone_;
  int saved_ = 0;  ///< number of saved states of the painter that must be restored
};

}  // namespace turnpoint::ui
