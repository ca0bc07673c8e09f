#include "station/report/svg.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "station/core/number.hpp"

namespace turnpoint::report {

namespace {

std::string px(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("plot: a coordinate is not finite");
  char buffer[400];  // the largest number has 309 digits before the point
  const auto written = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, 2);
  std::string text(buffer, written.ptr);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string attributes(const Paint& paint) {
  std::string text = " fill=\"" + (paint.fill.empty() ? "none" : paint.fill) + "\"";
  if (!paint.stroke.empty())
    text += " stroke=\"" + paint.stroke + "\" stroke-width=\"" + px(paint.width) + "\"";
  if (!paint.dash.empty()) text += " stroke-dasharray=\"" + paint.dash + "\"";
  if (paint.opacity < 1) text += " opacity=\"" + px(paint.opacity) + "\"";
  return text;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  return result;
}

void Svg::begin(double width, double height, const std::string& title) {
  // One HTML page may contain several SVG documents. A hash of title and size at the beginning of each id
  // keeps ids unique.
  prefix_ = "c" + core::sha256(title + px(width) + px(height)).substr(0, 8);
  const auto size = [this](double value_px) {
    return unit_ == Unit::px ? px(value_px) : px(value_px * 25.4 / 96) + "mm";
  };
  body_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + size(width) + "\" height=\"" + size(height) +
          "\" viewBox=\"0 0 " + px(width) + " " + px(height) +
          "\" role=\"img\" font-family=\"Inter, 'DejaVu Sans', Helvetica, Arial, sans-serif\">\n<title>" +
          escaped(title) + "</title>\n";
}

void Svg::line(Point from, Point to, const Paint& paint) {
  body_ += "<line x1=\"" + px(from.first) + "\" y1=\"" + px(from.second) + "\" x2=\"" + px(to.first) +
           "\" y2=\"" + px(to.second) + "\"" + attributes(paint) + "/>\n";
}

void Svg::points(const char* element, const std::vector<Point>& list, const Paint& paint) {
  body_ += std::string("<") + element + " points=\"";
  for (const auto& [x, y] : list) body_ += px(x) + "," + px(y) + " ";
  if (!list.empty()) body_.pop_back();
  body_ += "\"" + attributes(paint) + " stroke-linejoin=\"round\"/>\n";
}

void Svg::polyline(const std::vector<Point>& list, const Paint& paint) { points("polyline", list, paint); }
void Svg::polygon(const std::vector<Point>& list, const Paint& paint) { points("polygon", list, paint); }

void Svg::rectangle(Point corner, double width, double height, const Paint& paint) {
  body_ += "<rect x=\"" + px(corner.first) + "\" y=\"" + px(corner.second) + "\" width=\"" + px(width) +
           "\" height=\"" + px(height) + "\"" + attributes(paint) + "/>\n";
}

void Svg::circle(Point centre, double radius, const Paint& paint) {
  body_ += "<circle cx=\"" + px(centre.first) + "\" cy=\"" + px(centre.second) + "\" r=\"" + px(radius) +
           "\"" + attributes(paint) + "/>\n";
}

void Svg::text(Point at, const std::string& text, double size, Anchor anchor, const std::string& colour,
               int weight, double degrees) {
  const char* anchors[] = {"start", "middle", "end"};
  body_ += "<text x=\"" + px(at.first) + "\" y=\"" + px(at.second) + "\" font-size=\"" + px(size) +
           "\" text-anchor=\"" + anchors[static_cast<int>(anchor)] + "\" fill=\"" + colour + "\"";
  if (weight != 400) body_ += " font-weight=\"" + std::to_string(weight) + "\"";
  if (degrees != 0)
    body_ += " transform=\"rotate(" + px(-degrees) + " " + px(at.first) + " " + px(at.second) + ")\"";
  body_ += ">" + escaped(text) + "</text>\n";
}

void Svg::begin_clip(Point corner, double width, double height) {
  const auto id = prefix_ + "-" + std::to_string(clips_++);
  body_ += "<clipPath id=\"" + id + "\"><rect x=\"" + px(corner.first) + "\" y=\"" + px(corner.second) +
           "\" width=\"" + px(width) + "\" height=\"" + px(height) + "\"/></clipPath>\n<g clip-path=\"url(#" +
           id + ")\">\n";
}

void Svg::end_clip() { body_ += "</g>\n"; }

std::string Svg::finish() const { return body_ + "</svg>\n"; }

}  // namespace turnpoint::report
