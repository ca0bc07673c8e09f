#include "station/report/pdf.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "station/core/letters.hpp"
#include "station/core/number.hpp"

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

std::string hex(unsigned value, int digits) {
  static const char* const all = "0123456789ABCDEF";
  std::string text;
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) text += all[(value >> shift) & 15U];
  return text;
}

std::string utf16_units(const std::u32string& text) {
  std::string units;
  for (const char32_t c : text) {
    if (c < 0x10000)
      units += hex(c, 4);
    else
      units += hex(0xD800 + ((c - 0x10000) >> 10), 4) + hex(0xDC00 + ((c - 0x10000) & 0x3FFU), 4);
  }
  return units;
}

/// A text as a hexadecimal string in UTF-16, which every reader of PDF understands.
std::string utf16(const std::u32string& text) { return "<FEFF" + utf16_units(text) + ">"; }

constexpr std::size_t kLettersOfFont = 255;
constexpr double kUnits = 1000;  ///< of the font's coordinates, in its size

std::string bytes_of(unsigned value, int count) {
  std::string text;
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8)
    text += static_cast<char>((value >> shift) & 255U);
  return text;
}

/// A number of a charstring.
std::string operand(int value) {
  if (value >= -107 && value <= 107) return bytes_of(static_cast<unsigned>(value + 139), 1);
  return "\x1C" + bytes_of(static_cast<unsigned>(value) & 0xFFFFU, 2);
}

/// A path in the operators of PDF as a Type 2 charstring (Adobe Technical Note 5177), which begins with its
/// advance.
std::string charstring(const std::string& path, double advance) {
  constexpr char move = 21, straight = 5, curve = 8, end = 14;
  std::string drawing = operand(static_cast<int>(std::lround(kUnits * advance)));
  int x = 0, y = 0;
  std::vector<int> coordinates;
  std::istringstream words(path);
  for (std::string word; words >> word;) {
    const char last = word.back();
    // what is not an operator is a number
    if (last != 'm' && last != 'l' && last != 'c' && last != 'h') {
      coordinates.push_back(static_cast<int>(std::lround(kUnits * core::read_number(word).value())));
      continue;
    }
    for (std::size_t i = 0; i + 1 < coordinates.size(); i += 2) {
      drawing += operand(coordinates[i] - x) + operand(coordinates[i + 1] - y);
      x = coordinates[i], y = coordinates[i + 1];
    }
    if (!coordinates.empty()) drawing += last == 'm' ? move : last == 'l' ? straight : curve;
    coordinates.clear();
  }
  return drawing + end;
}

/// The list of a CFF font, with 4 bytes for each offset.
std::string index_of(const std::vector<std::string>& entries) {
  std::string list = bytes_of(static_cast<unsigned>(entries.size()), 2);
  if (entries.empty()) return list;
  list += "\x04";
  unsigned at = 1;
  list += bytes_of(at, 4);
  for (const auto& entry : entries) list += bytes_of(at += static_cast<unsigned>(entry.size()), 4);
  for (const auto& entry : entries) list += entry;
  return list;
}

/// A font of these letters, whose codes are 1, 2, ...; the first has no code.
std::string cff(const std::string& name, const std::vector<std::string>& drawings) {
  const auto letters = static_cast<unsigned>(drawings.size() - 1);
  constexpr unsigned first_own_name = 391;
  std::vector<std::string> names;
  std::string codes = bytes_of(0, 1) + bytes_of(letters, 1), charset = bytes_of(0, 1);
  for (unsigned i = 0; i < letters; ++i) {
    names.push_back("letter" + std::to_string(i + 1));
    codes += bytes_of(i + 1, 1);
    charset += bytes_of(first_own_name + i, 2);
  }
  const std::string widths("\x8B\x14\x8B\x15", 4);  // both widths of the private dictionary are 0
  const auto start = bytes_of(0x01000404, 4) + index_of({name});
  const auto list = index_of(drawings), strings = index_of(names) + index_of({});
  const auto top = [&](std::size_t from) {
    const auto number = [](std::size_t value) { return "\x1D" + bytes_of(static_cast<unsigned>(value), 4); };
    const auto encoding = from + charset.size(), drawn = encoding + codes.size(), own = drawn + list.size();
    return number(from) + "\x0F" + number(encoding) + "\x10" + number(drawn) + "\x11" +
           number(widths.size()) + number(own) + "\x12";
  };
  const auto from = start.size() + index_of({top(0)}).size() + strings.size();
  return start + index_of({top(from)}) + strings + charset + codes + list + widths;
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
  this->paint(pair({x + r, y}) + "m " + pair({x + r, y + k}) + pair({x + k, y + r}) + pair({x, y + r}) +
                  "c " + pair({x - k, y + r}) + pair({x - r, y + k}) + pair({x - r, y}) + "c " +
                  pair({x - r, y - k}) + pair({x - k, y - r}) + pair({x, y - r}) + "c " +
                  pair({x + k, y - r}) + pair({x + r, y - k}) + pair({x + r, y}) + "c ",
              paint, true);
}

std::size_t Pdf::letter(char32_t character, bool bold) {
  const auto [found, is_new] = places_.emplace(std::pair(character, bold), letters_.size());
  if (is_new) {
    const auto [advance, path] = outlines_(character, bold);
    letters_.push_back({character, advance, charstring(path, advance)});
  }
  return found->second;
}

void Pdf::text(Point at, const std::string& text, double size, Anchor anchor, const std::string& colour,
               int weight, double degrees) {
  std::vector<std::size_t> letters;
  double width = 0;
  for (const char32_t c : core::code_points(text)) {
    if (is_joined(c))
      throw JoinedLetters("\"" + text + "\" has letters whose shape depends on their neighbours");
    letters.push_back(letter(c, weight >= 600));
    width += letters_[letters.back()].advance;
  }
  if (letters.empty()) return;
  const double turn = degrees * std::acos(-1.0) / 180, c = std::cos(turn), s = std::sin(turn);
  const double back = size * width * (anchor == Anchor::start ? 0 : anchor == Anchor::middle ? 0.5 : 1);
  body_ += "BT " + rgb(colour) + "rg " + decimal(size * c, 5) + " " + decimal(-size * s, 5) + " " +
           decimal(-size * s, 5) + " " + decimal(-size * c, 5) + " " +
           pair({at.first - back * c, at.second + back * s}) + "Tm ";
  for (std::size_t i = 0; i < letters.size();) {
    const auto font = letters[i] / kLettersOfFont;
    body_ += "/F" + std::to_string(font) + " 1 Tf <";
    for (; i < letters.size() && letters[i] / kLettersOfFont == font; ++i)
      body_ += hex(static_cast<unsigned>(letters[i] % kLettersOfFont + 1), 2);
    body_ += "> Tj ";
  }
  body_ += "ET\n";
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
    return "<<" + entries + "/Length " + std::to_string(bytes.size()) + ">>\nstream\n" + bytes +
           "\nendstream";
  };
  constexpr std::size_t first_font = 6, objects_of_font = 4;
  const auto fonts = (letters_.size() + kLettersOfFont - 1) / kLettersOfFont;
  const auto reference = [](std::size_t number) { return std::to_string(number) + " 0 R"; };
  std::string names, states;
  for (std::size_t i = 0; i < fonts; ++i)
    names += "/F" + std::to_string(i) + " " + reference(first_font + objects_of_font * i) + " ";
  for (const auto& [opacity, name] : opacities_)
    states += "/" + name + " <</ca " + opacity + "/CA " + opacity + ">> ";
  object("<</Type/Catalog/Pages 2 0 R>>");
  object("<</Type/Pages/Kids[3 0 R]/Count 1>>");
  object("<</Type/Page/Parent 2 0 R/MediaBox[0 0 " + decimal(width_) + " " + decimal(height_) +
         "]/Contents 4 0 R/Resources<</Font<<" + names + ">>/ExtGState<<" + states + ">>>>>>");
  object(stream("", body_));
  object("<</Title " + utf16(core::code_points(title_)) + "/Creator(turnpoint)>>");
  for (std::size_t i = 0; i < fonts; ++i) {
    std::vector<std::string> drawings{"\x0E"};  // the letter that stands for those that are missing
    std::string widths, meanings;
    const auto last = std::min(letters_.size(), (i + 1) * kLettersOfFont);
    for (auto at = i * kLettersOfFont; at < last; ++at) {
      drawings.push_back(letters_[at].drawing);
      widths += decimal(kUnits * letters_[at].advance) + " ";
      meanings += "1 beginbfchar <" + hex(static_cast<unsigned>(drawings.size() - 1), 2) + "> <" +
                  utf16_units(std::u32string(1, letters_[at].character)) + "> endbfchar\n";
    }
    const auto name = "AAAAA" + std::string(1, static_cast<char>('A' + i % 26)) + "+TurnpointFigure";
    const auto number = first_font + objects_of_font * i;
    object("<</Type/Font/Subtype/Type1/BaseFont/" + name + "/FirstChar 1/LastChar " +
           std::to_string(drawings.size() - 1) + "/Widths[" + widths + "]/FontDescriptor " +
           reference(number + 1) + "/ToUnicode " + reference(number + 3) + ">>");
    object(
        "<</Type/FontDescriptor/FontName/" + name +
        "/Flags 4/FontBBox[-1000 -1000 3000 2000]/ItalicAngle 0/Ascent 950/Descent -250/CapHeight 700/StemV "
        "80/FontFile3 " +
        reference(number + 2) + ">>");
    object(stream("/Subtype/Type1C", cff(name, drawings)));
    object(stream(
        "",
        "/CIDInit /ProcSet findresource begin 12 dict begin begincmap\n/CMapName /Letters def /CMapType 2 "
        "def\n1 begincodespacerange <00> <FF> endcodespacerange\n" +
            meanings + "endcmap CMapName currentdict /CMap defineresource pop end end\n"));
  }
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
