#pragma once
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "station/report/canvas.hpp"

namespace turnpoint::report {

/// The outline of a character: how far the next character is from it, and its path. Both are in units of the
/// font size, with y upwards. The path is written in the operators of PDF: "x y m", "x y l", "x y x y x y c",
/// "h". A character without a shape has no path.
using Outline = std::pair<double, std::string>;
using Outlines = std::function<Outline(char32_t character, bool bold)>;

/// Thrown for letters that a Pdf cannot draw, because their shape depends on their neighbours or they are
/// written from right to left: Arabic, Hebrew, and the scripts of India.
class JoinedLetters : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Builds one PDF document of one page, as large as the figure. It embeds a font (CFF, Adobe Technical Note
/// 5176) of the letters that it has, so that its text can be selected and searched, and edited in a drawing
/// program. The same calls give the same bytes. Throws std::invalid_argument for a coordinate that is not
/// finite.
class Pdf : public Canvas {
 public:
  explicit Pdf(Outlines outlines) : outlines_(std::move(outlines)) {}

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
  struct Letter {
    char32_t character = 0;
    double advance = 0;   ///< in units of the font size
    std::string drawing;  ///< as a Type 2 charstring
  };
  /// The place in `letters_`: a font has kLettersOfFont of them.
  std::size_t letter(char32_t character, bool bold);
  void paint(const std::string& path, const Paint& paint, bool closed);

  Outlines outlines_;
  std::map<std::pair<char32_t, bool>, std::size_t> places_;
  std::vector<Letter> letters_;
  std::map<std::string, std::string> opacities_;  ///< name in the page's resources, by the opacity
  std::string body_, title_;
  double width_ = 0, height_ = 0;
};

}  // namespace turnpoint::report
