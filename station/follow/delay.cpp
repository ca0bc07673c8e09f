#include "station/follow/delay.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "station/follow/need.hpp"

namespace turnpoint::follow {

Timing timing_of(int rate_Hz) {
  need(rate_Hz >= 32000, "timing: the rate is below 32 kHz");
  Timing timing;
  timing.rate_Hz = rate_Hz;
  timing.period_frames = std::max(8, (rate_Hz / 2000 + 4) / 8 * 8);
  timing.window_frames = (3 * rate_Hz / 2000 + 1) / 2 * 2;
  return timing;
}

Delay total_delay(const Timing& t) {
  const double rate = t.rate_Hz;
  Delay delay;
  delay.window_s = 0.5 * t.window_frames / rate;
  delay.buffer_s = static_cast<double>(t.buffer_periods) * t.period_frames / rate;
  delay.period_s = t.period_frames / rate;
  delay.cells_s = t.cells_s;
  delay.total_s = delay.window_s + delay.buffer_s + delay.period_s + delay.cells_s;
  delay.converter_s = t.converter_s;
  delay.horizon_s = delay.window_s + delay.buffer_s + delay.cells_s + delay.converter_s + t.film_s;
  return delay;
}

std::string sentence(const Delay& d) {
  const auto parts = fmt::format(
      "{:.2f} ms from the finger's place to the amplitude: half a window {:.2f} ms, buffer {:.2f} ms, period "
      "{:.2f} ms, force cells {:.2f} ms; the converters add {:.2f} ms",
      1e3 * d.total_s, 1e3 * d.window_s, 1e3 * d.buffer_s, 1e3 * d.period_s, 1e3 * d.cells_s,
      1e3 * d.converter_s);
  if (!d.refused()) return parts;
  return parts + fmt::format("; allowed: {:.0f} ms without the converters", 1e3 * kMostDelay_s);
}

}  // namespace turnpoint::follow
