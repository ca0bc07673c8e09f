#pragma once
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "station/report/svg.hpp"

/// Finds the positions of elements in an SVG document of report::Svg by parsing its text.
namespace svg_geometry {

struct Box {
  double left, top, right, bottom;
};

/// A text that is not rotated, with a box that is at least as large as the drawn text.
struct Text {
  std::string words, colour;
  double size_px;
  Box box;
};

inline bool meet(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

inline std::string attribute(const std::string& element, const std::string& name) {
  const auto at = element.find(" " + name + "=\"");
  if (at == std::string::npos) return "";
  const auto from = at + name.size() + 3;
  return element.substr(from, element.find('"', from) - from);
}

inline double number(const std::string& element, const std::string& name) {
  const auto text = attribute(element, name);
  return text.empty() ? 0 : std::stod(text);
}

/// Returns all elements of one kind. Each is given as its attributes; a text also includes its words.
inline std::vector<std::string> elements(const std::string& svg, const std::string& kind) {
  std::vector<std::string> found;
  const auto start = "<" + kind + " ";
  for (auto at = svg.find(start); at != std::string::npos; at = svg.find(start, at + 1)) {
    const auto end = svg.find('>', at);
    found.push_back(svg.substr(at, (kind == "text" ? svg.find('<', end) : end + 1) - at));
  }
  return found;
}

inline std::vector<Text> texts(const std::string& svg) {
  std::vector<Text> found;
  for (const auto& element : elements(svg, "text")) {
    if (!attribute(element, "transform").empty()) continue;
    const auto words = element.substr(element.find('>') + 1);
    const double size = number(element, "font-size"), width = turnpoint::report::text_width(words, size);
    const auto anchor = attribute(element, "text-anchor");
    const double left = number(element, "x") - width * (anchor == "end" ? 1 : anchor == "middle" ? 0.5 : 0);
    const double base = number(element, "y");
    found.push_back({words,
                     attribute(element, "fill"),
                     size,
                     {left, base - 0.78 * size, left + width, base + 0.24 * size}});
  }
  return found;
}

/// Returns the area covered by curves, round markers, outlined rectangles and lines, as small boxes. Lines in
/// the colours of grid and axes are left out.
inline std::vector<Box> ink(const std::string& svg, const std::vector<std::string>& not_of_colour) {
  std::vector<Box> boxes;
  const auto stroke = [&](double x0, double y0, double x1, double y1, double half) {
    const int pieces = 1 + static_cast<int>(std::hypot(x1 - x0, y1 - y0));
    for (int i = 0; i <= pieces; ++i) {
      const double x = x0 + (x1 - x0) * i / pieces, y = y0 + (y1 - y0) * i / pieces;
      boxes.push_back({x - half, y - half, x + half, y + half});
    }
  };
  const auto counts = [&](const std::string& element) {
    const auto colour = attribute(element, "stroke");
    return std::find(not_of_colour.begin(), not_of_colour.end(), colour) == not_of_colour.end();
  };
  for (const auto& e : elements(svg, "line"))
    if (counts(e))
      stroke(number(e, "x1"), number(e, "y1"), number(e, "x2"), number(e, "y2"),
             0.5 * number(e, "stroke-width"));
  for (const auto& e : elements(svg, "circle")) {
    const double x = number(e, "cx"), y = number(e, "cy"),
                 r = number(e, "r") + 0.5 * number(e, "stroke-width");
    boxes.push_back({x - r, y - r, x + r, y + r});
  }
  for (const auto& e : elements(svg, "rect"))
    if (!attribute(e, "stroke").empty())
      boxes.push_back({number(e, "x"), number(e, "y"), number(e, "x") + number(e, "width"),
                       number(e, "y") + number(e, "height")});
  for (const auto& e : elements(svg, "polyline")) {
    std::istringstream points(attribute(e, "points"));
    double x = 0, y = 0, last_x = 0, last_y = 0;
    char comma = 0;
    for (bool first = true; points >> x >> comma >> y; first = false) {
      if (!first) stroke(last_x, last_y, x, y, 0.5 * number(e, "stroke-width"));
      last_x = x, last_y = y;
    }
  }
  return boxes;
}

}  // namespace svg_geometry
