#include "station/plot/canvas.hpp"

namespace turnpoint::plot {

double text_width(const std::string& utf8, double size_px) {
  double ems = 0;
  for (const unsigned char byte : utf8) {
    if ((byte & 0xC0) == 0x80) continue;      // a continuation byte of the previous character
    ems += byte >= 0xE3 && byte < 0xF0 ? 1.0  // from U+3000 on: CJK
           : byte >= 0xF0              ? 1.0
                                       : 0.62;
  }
  return ems * size_px;
}

}  // namespace turnpoint::plot
