#pragma once
#include <string>
#include <vector>

#include "station/report/canvas.hpp"

namespace turnpoint::report {

/// Replaces & < > and quotes by their entities, for text in an SVG or HTML document.
std::string escaped(const std::string& text);

/// Builds one SVG document. Coordinates have two decimals, so that the same calls give the same bytes. Throws
/// std::invalid_argument for a coordinate that is not finite.
class Svg : public Canvas {
 public:
  /// What the size of the document is given in: px for a page, mm for a paper.
  enum class Unit { px, mm };
  explicit Svg(Unit unit = Unit::px) : unit_(unit) {}

  void begin(double width, double height, const std::string& title) override;
  void line(Point from, Point to, const Paint& paint) override;
  void polyline(const std::vector<Point>& points, const Paint& paint) override;
  void polygon(const std::vector<Point>& points, const Paint& paint) override;
  void rectangle(Point corner, double width, double height, const Paint& paint) override;
  void circle(Point centre, double radius, const Paint& paint) override;
  void text(Point at, const std::string& text, double size, Anchor anchor, const std::string& colour,
            int weight, double degrees) override;
  void begin_clip(Point corner, double width, double height) override;
  void end_clip() override;

  std::string finish() const;

 private:
  void points(const char* element, const std::vector<Point>& list, const Paint& paint);
  std::string body_, prefix_;
  int clips_ = 0;
  Unit unit_;
};

}  // namespace turnpoint::report
