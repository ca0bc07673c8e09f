#include "station/system/fonts.hpp"

#include <fmt/format.h>
#include <fontconfig/fontconfig.h>
#include <ft2build.h>

#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include FT_FREETYPE_H
#include FT_OUTLINE_H

namespace turnpoint::system {

namespace {

struct Destroy {
  void operator()(FcConfig* config) const { FcConfigDestroy(config); }
  void operator()(FcPattern* pattern) const { FcPatternDestroy(pattern); }
  void operator()(FcCharSet* set) const { FcCharSetDestroy(set); }
  void operator()(FcObjectSet* set) const { FcObjectSetDestroy(set); }
  void operator()(FcFontSet* set) const { FcFontSetDestroy(set); }
  void operator()(FT_Library library) const { FT_Done_FreeType(library); }
  void operator()(FT_Face face) const { FT_Done_Face(face); }
};
template <typename T>
using Owned = std::unique_ptr<T, Destroy>;

/// A configuration of our own, which is freed at exit. The global one is never freed.
FcConfig* config() {
  static const Owned<FcConfig> own(FcInitLoadConfigAndFonts());
  return own.get();
}

bool has_font(FcPattern* pattern) {
  const Owned<FcObjectSet> no_properties(FcObjectSetCreate());
  const Owned<FcFontSet> fonts(FcFontList(config(), pattern, no_properties.get()));
  return fonts && fonts->nfont > 0;
}

Owned<FcPattern> with_character(char32_t character) {
  Owned<FcPattern> pattern(FcPatternCreate());
  const Owned<FcCharSet> set(FcCharSetCreate());
  FcCharSetAddChar(set.get(), character);
  FcPatternAddCharSet(pattern.get(), FC_CHARSET, set.get());
  return pattern;
}

/// The file of the font that has the character and resembles the station's font most, and the font's place in it.
std::pair<std::string, int> font_file(char32_t character, bool bold) {
  const auto pattern = with_character(character);
  FcPatternAddString(pattern.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("Inter"));
  FcPatternAddString(pattern.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
  FcPatternAddInteger(pattern.get(), FC_WEIGHT, bold ? FC_WEIGHT_DEMIBOLD : FC_WEIGHT_REGULAR);
  FcPatternAddBool(pattern.get(), FC_SCALABLE, FcTrue);
  FcConfigSubstitute(config(), pattern.get(), FcMatchPattern);
  FcDefaultSubstitute(pattern.get());
  FcResult result = FcResultNoMatch;
  const Owned<FcPattern> found(FcFontMatch(config(), pattern.get(), &result));
  FcChar8* file = nullptr;
  int index = 0;
  if (!found || FcPatternGetString(found.get(), FC_FILE, 0, &file) != FcResultMatch) return {};
  FcPatternGetInteger(found.get(), FC_INDEX, 0, &index);
  return {reinterpret_cast<const char*>(file), index};
}

/// Writes a font's outline in the operators of PDF.
class Path {
 public:
  explicit Path(double units) : units_(units) {}

  static int move(const FT_Vector* to, void* path) { return static_cast<Path*>(path)->begin(*to); }
  static int straight(const FT_Vector* to, void* path) {
    auto& own = *static_cast<Path*>(path);
    own.text_ += own.pair(to->x, to->y) + "l ";
    own.last_ = *to;
    return 0;
  }
  static int conic(const FT_Vector* control, const FT_Vector* to, void* path) {
    auto& own = *static_cast<Path*>(path);
    const auto third = [](FT_Pos end, FT_Pos middle) {
      return (static_cast<double>(end) + 2 * static_cast<double>(middle)) / 3;
    };
    own.text_ += own.pair(third(own.last_.x, control->x), third(own.last_.y, control->y)) +
                 own.pair(third(to->x, control->x), third(to->y, control->y)) + own.pair(to->x, to->y) + "c ";
    own.last_ = *to;
    return 0;
  }
  static int cubic(const FT_Vector* a, const FT_Vector* b, const FT_Vector* to, void* path) {
    auto& own = *static_cast<Path*>(path);
    own.text_ += own.pair(a->x, a->y) + own.pair(b->x, b->y) + own.pair(to->x, to->y) + "c ";
    own.last_ = *to;
    return 0;
  }
  std::string finish() { return text_.empty() ? "" : text_ + "h "; }

 private:
  int begin(const FT_Vector& to) {
    text_ += (text_.empty() ? "" : "h ") + pair(to.x, to.y) + "m ";
    last_ = to;
    return 0;
  }
  template <typename T>
  std::string pair(T x, T y) const {
    return fmt::format("{:.5f} {:.5f} ", static_cast<double>(x) / units_, static_cast<double>(y) / units_);
  }

  double units_;
  std::string text_;
  FT_Vector last_{};
};

FT_Face face_of(char32_t character, bool bold) {
  static const Owned<std::remove_pointer_t<FT_Library>> library([] {
    FT_Library made = nullptr;
    FT_Init_FreeType(&made);
    return made;
  }());
  static std::map<std::pair<std::string, int>, Owned<std::remove_pointer_t<FT_Face>>> faces;
  const auto file = font_file(character, bold);
  auto& face = faces[file];
  if (!face) {
    FT_Face opened = nullptr;
    if (file.first.empty() || FT_New_Face(library.get(), file.first.c_str(), file.second, &opened) != 0)
      return nullptr;
    face.reset(opened);
  }
  return face.get();
}

}  // namespace

bool drawable(char32_t character) {
  static const bool any_font = has_font(Owned<FcPattern>(FcPatternCreate()).get());
  if (!any_font) return true;
  static std::mutex mutex;
  static std::map<char32_t, bool> known;
  const std::scoped_lock lock(mutex);
  const auto found = known.find(character);
  if (found != known.end()) return found->second;
  return known[character] = has_font(with_character(character).get());
}

std::pair<double, std::string> outline(char32_t character, bool bold) {
  static std::mutex mutex;
  const std::scoped_lock lock(mutex);
  const auto face = face_of(character, bold);
  const auto glyph = face == nullptr ? 0 : FT_Get_Char_Index(face, character);
  if (glyph == 0 || FT_Load_Glyph(face, glyph, FT_LOAD_NO_SCALE) != 0)
    throw std::runtime_error(
        fmt::format("no font on this machine can draw the character U+{:04X}, which a figure has",
                    static_cast<unsigned>(character)));
  const double units = face->units_per_EM;
  Path path(units);
  const FT_Outline_Funcs steps{Path::move, Path::straight, Path::conic, Path::cubic, 0, 0};
  if (face->glyph->format == FT_GLYPH_FORMAT_OUTLINE)
    FT_Outline_Decompose(&face->glyph->outline, &steps, &path);
  return {static_cast<double>(face->glyph->metrics.horiAdvance) / units, path.finish()};
}

}  // namespace turnpoint::system
