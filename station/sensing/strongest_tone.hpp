#pragma once
#include <limits>
#include <optional>
#include <span>

namespace turnpoint::sensing {

/// A tone that was found in noise.
struct FoundTone {
  double frequency_Hz = 0;
  double power = 0;  ///< mean square
};

/// Returns the strongest tone of the samples between two frequencies; empty if no tone stands out of the
/// noise there. Noise that a resonance makes narrow counts as a tone. Takes about 1 ms for 50 ms of samples.
std::optional<FoundTone> strongest_tone(std::span<const double> samples, int rate_Hz, double low_Hz = 0,
                                        double high_Hz = std::numeric_limits<double>::infinity());

}  // namespace turnpoint::sensing
