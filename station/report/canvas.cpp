#include "station/report/canvas.hpp"

namespace turnpoint::report {

double text_width(const std::string& utf8, double size_px) {
  double ems = 0;
  for (const unsigned char byte : utf8) {
    if ((byte & 0xC0) == 0x80) continue;  // skip the continuation bytes of a character
    // wide characters, such as Chinese and Japanese, begin at U+3000 and are a full em wide
    ems += byte >= 0xE3 && byte < 0xF0 ? 1.0 : byte >= 0xF0 ? 1.0 : 0.62;
  }
  return ems * size_px;
}

}  // namespace turnpoint::report
