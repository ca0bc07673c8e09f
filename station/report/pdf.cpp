#include "station/report/pdf.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "station/core/letters.hpp"

namespace turnpoint::report {

namespace {

constexpr double kPointsPerPixel = 72.0 / 96;

std::string decimal(double value, int places = 3) {
  if (!std::isfinite(value)) throw std::invalid_argument("plot: a coordinate is not finite");
  char buffer[400];  // the largest number has 309 digits before the point
  const auto written = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, places);
  std::string text(buffer, written.ptr);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string pair(Point at) { return decimal(at.first) + " " + decimal(at.second) + " "; }

/// The red, green and blue of "#rrggbb", from 0 to 1.
std::string rgb(const std::string& colour) {
  std::string text;
  for (std::size_t i = 1; i + 1 < colour.size(); i += 2)
    text += decimal(std::stoi(colour.substr(i, 2), nullptr, 16) / 255.0) + " ";
  return text;
}

/// A text as a hexadecimal string in UTF-16, which every reader of PDF understands.
std::string utf16(const std::u32string& text) {
  static const char* const digits = "0123456789ABCDEF";
  std::string hex = "<FEFF";
  const auto unit = [&hex](unsigned value) {
    for (int shift = 12; shift >= 0; shift -= 4) hex += digits[(value >> shift) & 15U];
  };
  for (const char32_t c : text) {
    if (c < 0x10000) {
      unit(c);
    } else {
      unit(0xD800 + ((c - 0x10000) >> 10));
      unit(0xDC00 + ((c - 0x10000) & 0x3FFU));
    }
  }
  return hex + ">";
}

bool is_joined(char32_t c) {
  return (c >= 0x590 && c <= 0x8FF) || (c >= 0x900 && c <= 0xDFF) || (c >= 0xFB1D && c <= 0xFDFF) ||
         (c >= 0xFE70 && c <= 0xFEFE);
}

std::string path_of(const std::vector<Point>& points) {
  std::string path;
  for (std::size_t i = 0; i < points.size(); ++i) path += pair(points[i]) + (i == 0 ? "m " : "l ");
  return path;
}

}  // namespace

void Pdf::begin(double width, double height, const std::string& title) {
  width_ = width * kPointsPerPixel, height_ = height * kPointsPerPixel;
  title_ = title;
  // y counts downwards, in px
  body_ = decimal(kPointsPerPixel) + " 0 0 " + decimal(-kPointsPerPixel) + " 0 " + decimal(height_) + " cm\n";
}

void Pdf::paint(const std::string& path, const Paint& paint, bool closed) {
  const bool strokes = !paint.stroke.empty() && paint.width > 0, fills = closed && !paint.fill.empty();
  if (!strokes && !fills) return;
  body_ += "q 1 j ";
  if (paint.opacity < 1) {
    const auto opacity = decimal(paint.opacity);
    const auto name = opacities_.emplace(opacity, "a" + std::to_string(opacities_.size())).first->second;
    body_ += "/" + name + " gs ";
  }
  if (strokes) body_ += rgb(paint.stroke) + "RG " + decimal(paint.width) + " w ";
  if (strokes && !paint.dash.empty()) body_ += "[" + paint.dash + "] 0 d ";
  if (fills) body_ += rgb(paint.fill) + "rg ";
  body_ += path + (closed ? "h " : "") + (strokes && fills ? "B" : strokes ? "S" : "f") + " Q\n";
}

void Pdf::line(Point from, Point to, const Paint& paint) {
  this->paint(pair(from) + "m " + pair(to) + "l ", paint, false);
}

void Pdf::polyline(const std::vector<Point>& points, const Paint& paint) {
  this->paint(path_of(points), paint, false);
}

void Pdf::polygon(const std::vector<Point>& points, const Paint& paint) {
  this->paint(path_of(points), paint, true);
}

void Pdf::rectangle(Point corner, double width, double height, const Paint& paint) {
  this->paint(pair(corner) + pair({width, height}) + "re ", paint, true);
}

void Pdf::circle(Point centre, double radius, const Paint& paint) {
  const double k = 0.5523 * radius;  // a quarter of a circle as a Bezier curve
  const auto [x, y] = centre;
  const double r = radius;
  this->paint(pair({x + r, y}) + "m " + pair({x + r, y + k}) + pair({x + k, y + r}) + pair({x, y + r}) + "c " +
                  pair({x - k, y + r}) + pair({x - r, y + k}) + pair({x - r, y}) + "c " +
                  pair({x - r, y - k}) + pair({x - k, y - r}) + pair({x, y - r}) + "c " +
                  pair({x + k, y - r}) + pair({x + r, y - k}) + pair({x + r, y}) + "c ",
              paint, true);
}

const Pdf::Letter& Pdf::letter(char32_t character, bool bold) {
  const auto found = letters_.find({character, bold});
  if (found != letters_.end()) return found->second;
  Letter letter{"g" + std::to_string(letters_.size()), outlines_(character, bold)};
  return letters_.emplace(std::pair(character, bold), std::move(letter)).first->second;
}

void Pdf::text(Point at, const std::string& text, double size, Anchor anchor, const std::string& colour,
               int weight, double degrees) {
  std::vector<const Letter*> letters;
  double width = 0;
  for (const char32_t c : core::code_points(text)) {
    if (is_joined(c))
      throw JoinedLetters("\"" + text + "\" has letters whose shape depends on their neighbours");
    letters.push_back(&letter(c, weight >= 600));
    width += letters.back()->outline.first;
  }
  const double turn = degrees * std::acos(-1.0) / 180, c = std::cos(turn), s = std::sin(turn);
  body_ += "q " + rgb(colour) + "rg " + decimal(size * c, 5) + " " + decimal(-size * s, 5) + " " +
           decimal(-size * s, 5) + " " + decimal(-size * c, 5) + " " + pair(at) + "cm\n";
  double x = anchor == Anchor::start ? 0 : anchor == Anchor::middle ? -width / 2 : -width;
  double moved = 0;
  for (const auto* one : letters) {
    if (!one->outline.second.empty()) {
      body_ += "1 0 0 1 " + decimal(x - moved, 5) + " 0 cm /" + one->name + " Do ";
      moved = x;
    }
    x += one->outline.first;
  }
  body_ += "Q\n";
}

void Pdf::begin_clip(Point corner, double width, double height) {
  body_ += "q " + pair(corner) + pair({width, height}) + "re W n\n";
}

void Pdf::end_clip() { body_ += "Q\n"; }

std::string Pdf::finish() const {
  std::string pdf = "%PDF-1.4\n%\xC3\xA4\xC3\xB6\n";
  std::vector<std::size_t> starts;
  const auto object = [&](const std::string& content) {
    starts.push_back(pdf.size());
    pdf += std::to_string(starts.size()) + " 0 obj\n" + content + "\nendobj\n";
  };
  const auto stream = [](const std::string& entries, const std::string& bytes) {
    return "<<" + entries + "/Length " + std::to_string(bytes.size()) + ">>\nstream\n" + bytes + "\nendstream";
  };
  constexpr int first_letter = 6;
  std::string forms, states;
  int number = first_letter;
  for (const auto& [key, one] : letters_)
    if (!one.outline.second.empty()) forms += "/" + one.name + " " + std::to_string(number++) + " 0 R ";
  for (const auto& [opacity, name] : opacities_)
    states += "/" + name + " <</ca " + opacity + "/CA " + opacity + ">> ";
  object("<</Type/Catalog/Pages 2 0 R>>");
  object("<</Type/Pages/Kids[3 0 R]/Count 1>>");
  object("<</Type/Page/Parent 2 0 R/MediaBox[0 0 " + decimal(width_) + " " + decimal(height_) +
         "]/Contents 4 0 R/Resources<</XObject<<" + forms + ">>/ExtGState<<" + states + ">>>>>>");
  object(stream("", body_));
  object("<</Title " + utf16(core::code_points(title_)) + "/Creator(turnpoint)>>");
  for (const auto& [key, one] : letters_)
    if (!one.outline.second.empty())
      object(stream("/Type/XObject/Subtype/Form/BBox[-1 -1 3 2]", one.outline.second + "f"));
  const auto table = pdf.size();
  pdf += "xref\n0 " + std::to_string(starts.size() + 1) + "\n0000000000 65535 f \n";
  for (const auto start : starts) {
    const auto digits = std::to_string(start);
    pdf += std::string(10 - digits.size(), '0') + digits + " 00000 n \n";
  }
  return pdf + "trailer\n<</Size " + std::to_string(starts.size() + 1) +
         "/Root 1 0 R/Info 5 0 R>>\nstartxref\n" + std::to_string(table) + "\n%%EOF\n";
}

}  // namespace turnpoint::report
