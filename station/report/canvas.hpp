#pragma once
#include <string>
#include <utility>
#include <vector>

namespace turnpoint::report {

/// A point in px; y counts downward.
using Point = std::pair<double, double>;

/// Stroke and fill colour of a shape as "#rrggbb"; "" draws none. The dash pattern is written as in SVG ("6
/// 3", in px).
struct Paint {
  std::string stroke, fill;
  double width = 1;
  std::string dash;
  double opacity = 1;
};

enum class Anchor { start, middle, end };

/// Returns an upper estimate of a text's width in px at this size in common sans-serif fonts. Wide characters
/// (CJK) count as a full em, others as 0.62 em.
double text_width(const std::string& utf8, double size_px);

/// The surface on which a figure is drawn: a file (Svg) or a screen. Call begin() first, then draw shapes.
class Canvas {
 public:
  virtual ~Canvas() = default;

  /// Starts a figure of this size. Screen readers read the title aloud.
  virtual void begin(double width, double height, const std::string& title) = 0;

  virtual void line(Point from, Point to, const Paint& paint) = 0;
  virtual void polyline(const std::vector<Point>& points, const Paint& paint) = 0;
  virtual void polygon(const std::vector<Point>& points, const Paint& paint) = 0;
  virtual void rectangle(Point corner, double width, double height, const Paint& paint) = 0;
  virtual void circle(Point centre, double radius, const Paint& paint) = 0;
  /// Draws one line of text. `anchor` says which point of the baseline is at `at`: its start, middle or end.
  /// `weight` is 400 (normal) or 600 (bold). `degrees` turns the text counter-clockwise about `at`.
  virtual void text(Point at, const std::string& text, double size, Anchor anchor, const std::string& colour,
                    int weight = 400, double degrees = 0) = 0;
  /// Shapes drawn until end_clip() are clipped to this rectangle.
  virtual void begin_clip(Point corner, double width, double height) = 0;
  virtual void end_clip() = 0;
};

}  // namespace turnpoint::report
