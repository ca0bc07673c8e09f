#include "station/system/fonts.hpp"

#include <fontconfig/fontconfig.h>

#include <memory>

namespace turnpoint::system {

namespace {

struct Destroy {
  void operator()(FcConfig* config) const { FcConfigDestroy(config); }
  void operator()(FcPattern* pattern) const { FcPatternDestroy(pattern); }
  void operator()(FcCharSet* set) const { FcCharSetDestroy(set); }
  void operator()(FcObjectSet* set) const { FcObjectSetDestroy(set); }
  void operator()(FcFontSet* set) const { FcFontSetDestroy(set); }
};
template <typename T>
using Owned = std::unique_ptr<T, Destroy>;

bool has_font(FcPattern* pattern) {
  // Use a configuration of our own, which is freed at exit; nullptr would select the global one, which is
  // never freed.
  static const Owned<FcConfig> config(FcInitLoadConfigAndFonts());
  const Owned<FcObjectSet> no_properties(FcObjectSetCreate());
  const Owned<FcFontSet> fonts(FcFontList(config.get(), pattern, no_properties.get()));
  return fonts && fonts->nfont > 0;
}

}  // namespace

bool drawable(char32_t character) {
  const Owned<FcPattern> pattern(FcPatternCreate());
  static const bool any_font = has_font(pattern.get());
  if (!any_font) return true;
  const Owned<FcCharSet> set(FcCharSetCreate());
  FcCharSetAddChar(set.get(), character);
  FcPatternAddCharSet(pattern.get(), FC_CHARSET, set.get());
  return has_font(pattern.get());
}

}  // namespace turnpoint::system
