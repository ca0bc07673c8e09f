#include "physics/gate.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "physics/dispersion.hpp"
#include "physics/statement.hpp"
#include "physics/taper.hpp"

namespace turnpoint::physics {
namespace {

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

bool is_size(double value) { return value >= least_size && value <= largest_size; }

}  // namespace

void require(bool holds, const char* quantity, double value, const char* allowed) {
  if (holds) return;
  throw std::invalid_argument(quantity + (" is " + number(value)) + "; allowed: " + allowed);
}

void require_size(const char* quantity, double value) {
  require(is_size(value), quantity, value, "above 0 (1e-18 to 1e+18)");
}

void require_size_or_0(const char* quantity, double value) {
  require(value == 0 || is_size(value), quantity, value, "0 or more (to 1e+18)");
}

double highest_frequency_Hz(const Surface& surface) {
  const Dispersion dispersion(surface);
  const double along = largest_phase_rad / surface.length_m,
               across = largest_phase_across_rad / Taper(surface).half_width_m(0);
  const double high = dispersion.frequency_Hz(std::min(along, across));
  if (dispersion.theory == PlateTheory::kirchhoff) return high;
  return std::min(high, dispersion.frequency_Hz(largest_phase_through_rad / surface.thickness_m));
}

void validate(const Surface& surface, double f) {
  validate(surface);
  const double low = Dispersion(surface).frequency_Hz(least_phase_rad / surface.length_m),
               high = highest_frequency_Hz(surface);
  if (!(f >= low && f <= high))
    throw std::invalid_argument("frequency_Hz is " + number(f) + "; allowed: above 0, on this surface " +
                                number(low) + " to " + number(high));
}

void validate(const Surface& surface, std::span<const Tone> tones) {
  double most = 0;
  for (const Tone& tone : tones) {
    validate(surface, tone.frequency_Hz);
    require_size_or_0("tone amplitude_m", tone.amplitude_m);
    require(std::abs(tone.phase_rad) <= 1e9, "tone phase_rad", tone.phase_rad, "-1e9 to 1e9");
    most = std::max(most, tone.amplitude_m);
  }
  if (!(most > 0)) throw std::invalid_argument("tones: at least one with an amplitude above 0 is needed");
}

void validate(const Edge& edge) {
  if (edge.kind == Edge::Kind::percent || edge.kind == Edge::Kind::friction)
    require(edge.level >= 1e-6 && edge.level < 1, "edge level", edge.level, "above 0 (1e-6), below 1");
}

void require_fall(const Surface& surface) {
  const auto* taper = std::get_if<LinearTaper>(&surface.taper);
  if (taper != nullptr && taper->slope == 0)
    throw Refused(make_statement("constant-width",
                                 "a strip of constant width has no boundary that follows the frequency"));
}

void require_on_surface(const Surface& surface, const char* quantity, double x) {
  if (x >= 0 && x <= surface.length_m) return;
  throw std::invalid_argument(quantity + (" is " + number(x)) + "; allowed: 0 to " +
                              number(surface.length_m));
}

}  // namespace turnpoint::physics
