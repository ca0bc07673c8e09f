#include "station/sensing/tap.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "station/core/median.hpp"
#include "station/sensing/products.hpp"

namespace turnpoint::sensing {

namespace {

// The ringing is looked at from kAfterTap_s behind the largest deflection, when the finger has left the
// plate, for kRings_s. It must be this many times stronger than the noise before the tap.
constexpr double kAfterTap_s = 0.01, kRings_s = 0.2, kTapStandsOut = 20;
constexpr double kLowestRinging_Hz = 10, kHighestRinging = 0.4, kRingingStep_Hz = 0.25;

}  // namespace

std::optional<double> ringing_Hz(std::span<const double> signal, double rate_Hz) {
  const auto points = [&](double seconds) {
    return static_cast<std::size_t>(std::lround(seconds * rate_Hz));
  };
  if (signal.size() < points(kAfterTap_s + kRings_s)) return std::nullopt;
  const double rest = core::median({signal.begin(), signal.end()});
  std::vector<double> deflections;
  for (const double value : signal) deflections.push_back(std::abs(value - rest));
  const double noise = core::median(deflections);
  const auto peak = static_cast<std::size_t>(std::max_element(deflections.begin(), deflections.end()) -
                                             deflections.begin());
  const auto first = peak + points(kAfterTap_s);
  if (first + points(kRings_s) > signal.size()) return std::nullopt;
  std::vector<double> ringing(signal.begin() + static_cast<std::ptrdiff_t>(first),
                              signal.begin() + static_cast<std::ptrdiff_t>(first + points(kRings_s)));
  for (double& value : ringing) value -= rest;
  double strongest = 0, at_Hz = 0;
  for (double f = kLowestRinging_Hz; f <= kHighestRinging * rate_Hz; f += kRingingStep_Hz)
    if (const double amplitude = amplitude_at(ringing, f, static_cast<int>(std::lround(rate_Hz)));
        amplitude > strongest)
      strongest = amplitude, at_Hz = f;
  if (!(strongest > 0 && deflections[peak] > kTapStandsOut * noise && strongest > noise)) return std::nullopt;
  // A maximum at the lower end is no ringing, but the rest of a slow movement.
  return at_Hz > kLowestRinging_Hz ? std::optional(at_Hz) : std::nullopt;
}

}  // namespace turnpoint::sensing
