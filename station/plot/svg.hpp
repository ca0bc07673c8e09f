#pragma once
#include <string>
#include <utility>
#include <vector>

namespace turnpoint::plot {

/// Escapes text for an SVG or HTML document: replaces & < > and quotes.
std::string escaped(const std::string& text);

/// An upper estimate of a text's width in px at this size in common sans-serif fonts. Wide characters (CJK)
/// count as a full em, others as 0.62.
double text_width(const std::string& utf8, double size_px);

/// Stroke and fill of a shape; "" is none. Dash as in SVG ("6 3").
struct Paint {
  std::string stroke, fill;
  double width = 1;
  std::string dash;
  double opacity = 1;
};

enum class Anchor { start, middle, end };

/// Builds one SVG document. Coordinates are in px, y downward, written with two decimals, so that equal input
/// gives equal bytes.
class Svg {
 public:
  Svg(double width, double height, const std::string& title);

  using Point = std::pair<double, double>;
  void line(Point from, Point to, const Paint& paint);
  void polyline(const std::vector<Point>& points, const Paint& paint);
  void polygon(const std::vector<Point>& points, const Paint& paint);
  void rectangle(Point corner, double width, double height, const Paint& paint);
  void circle(Point centre, double radius, const Paint& paint);
  /// The baseline starts at `at`; weight is 400 or 600; degrees turn counter-clockwise about `at`.
  void text(Point at, const std::string& text, double size, Anchor anchor, const std::string& colour,
            int weight = 400, double degrees = 0);
  /// Until end_clip(), shapes are clipped to this rectangle.
  void begin_clip(Point corner, double width, double height);
  void end_clip();

  std::string finish() const;

 private:
  void points(const char* element, const std::vector<Point>& list, const Paint& paint);
  std::string body_, prefix_;
  int clips_ = 0;
};

}  // namespace turnpoint::plot
