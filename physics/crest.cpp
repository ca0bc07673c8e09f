#include "physics/crest.hpp"
#include "physics/gate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace turnpoint::physics {
namespace {

using std::numbers::pi;
constexpr double longest_period_s = 0.05;

void validate(std::span<const Tone> tones) {
  require(tones.size() <= 200, "number of tones", static_cast<double>(tones.size()), "at most 200");
  for (const Tone& tone : tones) {
    require(tone.frequency_Hz >= 1e-3 && tone.frequency_Hz <= 1e7, "frequency_Hz", tone.frequency_Hz,
            "1e-3 to 1e7");
    require_size_or_0("tone amplitude_m", tone.amplitude_m);
    require(std::abs(tone.phase_rad) <= 1e9, "tone phase_rad", tone.phase_rad, "-1e9 to 1e9");
  }
}

// with more tones than this, improving the phases would take too long, so Schroeder's phases are kept
constexpr std::size_t most_descended = 12;

// Period of the envelope: 1 divided by the greatest common divisor of the differences between the
// frequencies, which are rounded to whole hertz.
double beat_period_s(std::span<const Tone> tones) {
  long divisor = 0;
  for (const Tone& tone : tones) {
    divisor = std::gcd(divisor, std::lround(std::abs(tone.frequency_Hz - tones[0].frequency_Hz)));
  }
  return divisor == 0 ? 1 / tones[0].frequency_Hz
                      : std::min(longest_period_s, 1.0 / static_cast<double>(divisor));
}

// Returns the indices of the tones, ordered by frequency.
std::vector<std::size_t> by_frequency(std::span<const Tone> tones) {
  std::vector<std::size_t> order(tones.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return tones[a].frequency_Hz < tones[b].frequency_Hz;
  });
  return order;
}

// Schroeder's phases for unequal powers: phi_n = -2 pi sum_(l < n) (n - l) p_l, with p_l the share of tone l
// in the total power. N equal powers give phi_n = -pi n (n - 1)/N.
void schroeder(std::span<Tone> tones) {
  double total = 0;
  for (const Tone& tone : tones) total += tone.amplitude_m * tone.amplitude_m;
  double phase = 0, below = 0;
  for (const std::size_t i : by_frequency(tones)) {
    phase -= 2 * pi * below;
    tones[i].phase_rad = std::remainder(phase, 2 * pi);
    below += total > 0 ? tones[i].amplitude_m * tones[i].amplitude_m / total : 0;
  }
}

// The peak, over one beat period, of the envelope |rest(t) + tone(t) e^(i phi)|, as a function of the phase
// phi of one tone. `rest` is the sum of the other tones.
class Envelope {
 public:
  explicit Envelope(std::span<const Tone> tones) {
    const double period = beat_period_s(tones);
    for (const Tone& tone : tones) {
      auto& row = phasor_.emplace_back(grid);
      const double turns = (tone.frequency_Hz - tones[0].frequency_Hz) * period;
      for (std::size_t j = 0; j < grid; ++j) {
        row[j] = std::polar(tone.amplitude_m, 2 * pi * turns * static_cast<double>(j) / grid);
      }
    }
  }
  double peak(std::span<const Tone> tones) const {
    double most = 0;
    std::vector<std::complex<double>> turn;
    for (const Tone& tone : tones) turn.push_back(std::polar(1.0, tone.phase_rad));
    for (std::size_t j = 0; j < grid; ++j) {
      std::complex<double> sum = 0;
      for (std::size_t i = 0; i < turn.size(); ++i) sum += phasor_[i][j] * turn[i];
      most = std::max(most, std::norm(sum));
    }
    return std::sqrt(most);
  }

 private:
  static constexpr std::size_t grid = 256;
  std::vector<std::vector<std::complex<double>>> phasor_;
};

}  // namespace

void assign_phases(std::span<Tone> tones) {
  validate(tones);
  if (tones.empty()) return;
  schroeder(tones);
  if (tones.size() < 3 || tones.size() > most_descended) return;
  const Envelope envelope(tones);
  double best = envelope.peak(tones);
  for (double step = pi / 2; step > 0.02; step *= 0.5) {
    for (std::size_t i = 1; i < tones.size(); ++i) {
      for (const double by : {step, -step}) {
        tones[i].phase_rad += by;
        const double now = envelope.peak(tones);
        if (now < best) {
          best = now;
          break;
        }
        tones[i].phase_rad -= by;
      }
    }
  }
  for (Tone& tone : tones) tone.phase_rad = std::remainder(tone.phase_rad, 2 * pi);
}

double crest_factor(std::span<const Tone> tones) {
  validate(tones);
  double power = 0, fastest = 0;
  for (const Tone& tone : tones) {
    power += 0.5 * tone.amplitude_m * tone.amplitude_m;
    fastest = std::max(fastest, tone.frequency_Hz);
  }
  if (!(power > 0)) return 0;
  if (tones.size() == 1) return std::numbers::sqrt2;
  const double period = std::max(beat_period_s(tones), 1 / fastest);
  const auto count = static_cast<std::size_t>(std::ceil(16 * fastest * period)) + 3;
  std::vector<double> wave(count, 0.0);
  const double dt = 1 / (16 * fastest);
  for (const Tone& tone : tones) {
    const std::complex<double> turn = std::polar(1.0, 2 * pi * tone.frequency_Hz * dt);
    std::complex<double> z = std::polar(tone.amplitude_m, tone.phase_rad);
    for (double& one : wave) {
      one += z.real();
      z *= turn;
    }
  }
  double peak = 0;
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double y = std::abs(wave[i]);
    if (y < 0.98 * peak) continue;
    // the maximum of the parabola through this sample and its two neighbours
    const double sign = wave[i] < 0 ? -1 : 1;
    const double a = sign * wave[i - 1], c = sign * wave[i + 1];
    const double bend = a - 2 * y + c;
    peak = std::max(peak, y >= a && y >= c && bend < 0 ? y - (a - c) * (a - c) / (8 * bend) : y);
  }
  return peak / std::sqrt(power);
}

std::vector<Product> audible_products(std::span<const Tone> tones, double below_Hz) {
  validate(tones);
  std::vector<Product> found;
  const auto add = [&](double f, int order) {
    f = std::abs(f);
    if (f > 0 && f < below_Hz) found.push_back({f, order});
  };
  for (std::size_t i = 0; i < tones.size(); ++i) {
    for (std::size_t j = 0; j < tones.size(); ++j) {
      if (i < j) add(tones[i].frequency_Hz - tones[j].frequency_Hz, 2);
      for (std::size_t k = 0; k < tones.size(); ++k) {
        // Add f_i + f_j - f_k; i = j gives 2 f_i - f_k. Skip k = i and k = j, because the result would be one
        // of the tones.
        if (i <= j && k != i && k != j)
          add(tones[i].frequency_Hz + tones[j].frequency_Hz - tones[k].frequency_Hz, 3);
      }
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Product& a, const Product& b) { return a.frequency_Hz < b.frequency_Hz; });
  std::vector<Product> merged;
  for (const Product& product : found) {
    if (!merged.empty() && product.frequency_Hz - merged.back().frequency_Hz < 1) {
      merged.back().order = std::min(merged.back().order, product.order);
    } else {
      merged.push_back(product);
    }
  }
  return merged;
}

}  // namespace turnpoint::physics
