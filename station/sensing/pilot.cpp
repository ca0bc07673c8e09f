#include "station/sensing/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

namespace turnpoint::sensing {

namespace {

using Complex = std::complex<double>;

constexpr double kLeastLikeness = 0.8;
// largest accepted amplitude of a second copy of the pilot, relative to the first
constexpr double kLargestEcho = 0.5;
// largest accepted difference between the phase of the carrier and that expected from the envelope
constexpr double kLargestTurn = M_PI / 3;
constexpr std::int64_t kMargin_frames = 64;  // extra captured frames before and after the pilot

/// The value of the analytic (complex) pilot signal with amplitude 1 at the time n, in frames from its start;
/// n may have a fraction. Its imaginary part is played. The frequency rises as in a burst that glides: the
/// phase is increment n + curvature n (n - 1) / 2.
Complex pilot_at(const Pilot& pilot, double n) {
  const auto frames = static_cast<double>(pilot.frames);
  const double u = (n + 0.5) / frames;
  if (u <= 0 || u >= 1) return 0;
  const double curvature = (pilot.high_Hz - pilot.low_Hz) / pilot.rate_Hz / frames;
  const double cycles = pilot.low_Hz / pilot.rate_Hz * n + curvature * n * (n - 1) / 2;
  const double s = std::sin(M_PI * u);
  return std::polar(s * s, 2 * M_PI * (cycles - std::floor(cycles)));
}

/// A signal that was mixed down to 0 Hz from the middle of the pilot's band and then summed over groups of
/// `factor` frames, which lowers its rate.
struct Baseband {
  std::vector<double> re, im;

  void add(Complex value) {
    re.push_back(value.real());
    im.push_back(value.imag());
  }
};

template <class At>
Baseband baseband(const Pilot& pilot, std::int64_t frames, std::int64_t factor, const At& at) {
  const double turn = M_PI * (pilot.low_Hz + pilot.high_Hz) / pilot.rate_Hz;
  Baseband made;
  std::vector<Complex> mix;  // rotation within a group; the sum is rotated by the phase at the group's start
  for (std::int64_t k = 0; k < factor; ++k) mix.push_back(std::polar(1.0, -turn * static_cast<double>(k)));
  for (std::int64_t n = 0; n + factor <= frames; n += factor) {
    Complex sum = 0;
    for (std::int64_t k = 0; k < factor; ++k) sum += at(n + k) * mix[static_cast<std::size_t>(k)];
    made.add(sum * std::polar(1.0, -std::fmod(turn * static_cast<double>(n), 2 * M_PI)));
  }
  return made;
}

/// Returns the squared magnitude of the correlation of signal and pilot for each lag.
std::vector<double> correlation(const Baseband& signal, const Baseband& pilot) {
  const std::size_t lags = signal.re.size() - pilot.re.size() + 1;
  std::vector<double> re(lags), im(lags);
  for (std::size_t m = 0; m < pilot.re.size(); ++m) {
    const double a = pilot.re[m], b = pilot.im[m];
    const double *x = signal.re.data() + m, *y = signal.im.data() + m;
    for (std::size_t l = 0; l < lags; ++l) {
      re[l] += x[l] * a + y[l] * b;
      im[l] += y[l] * a - x[l] * b;
    }
  }
  for (std::size_t l = 0; l < lags; ++l) re[l] = re[l] * re[l] + im[l] * im[l];
  return re;
}

double energy(const Baseband& b, std::size_t from, std::size_t count) {
  double sum = 0;
  for (std::size_t m = from; m < from + count; ++m) sum += b.re[m] * b.re[m] + b.im[m] * b.im[m];
  return sum;
}

/// The start of the pilot, known to within a few frames, and its likeness (see PilotEcho).
struct Place {
  double frame = 0, likeness = 0;
};

/// Subtracts from the samples the sinusoid of this frequency that fits them best.
void remove_tone(std::vector<double>& samples, double frequency_Hz, int rate_Hz) {
  const double turn = 2 * M_PI * frequency_Hz / rate_Hz;
  const auto at = [&](std::size_t n) {
    return std::polar(1.0, std::fmod(turn * static_cast<double>(n), 2 * M_PI));
  };
  // Normal equations of the least-squares fit of a cosine and a sine.
  double cc = 0, cs = 0, ss = 0, xc = 0, xs = 0;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const Complex z = at(n);
    cc += z.real() * z.real(), cs += z.real() * z.imag(), ss += z.imag() * z.imag();
    xc += samples[n] * z.real(), xs += samples[n] * z.imag();
  }
  const double determinant = cc * ss - cs * cs;
  const double c = (ss * xc - cs * xs) / determinant, s = (cc * xs - cs * xc) / determinant;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const Complex z = at(n);
    samples[n] -= c * z.real() + s * z.imag();
  }
}

std::optional<Place> coarse_place(const Pilot& pilot, const std::vector<double>& samples) {
  const auto factor = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(pilot.rate_Hz / (1.3 * (pilot.high_Hz - pilot.low_Hz))));
  const auto signal = baseband(pilot, static_cast<std::int64_t>(samples.size()), factor,
                               [&](std::int64_t n) { return Complex(samples[static_cast<std::size_t>(n)]); });
  const auto shape = baseband(pilot, pilot.frames, factor,
                              [&](std::int64_t n) { return pilot_at(pilot, static_cast<double>(n)); });
  const auto power = correlation(signal, shape);
  const auto best = static_cast<std::size_t>(std::max_element(power.begin(), power.end()) - power.begin());
  const double energies = energy(signal, best, shape.re.size()) * energy(shape, 0, shape.re.size());
  if (!(energies > 0)) return std::nullopt;
  const double likeness = std::sqrt(power[best] / energies);
  if (likeness < kLeastLikeness) return std::nullopt;
  // width of the correlation's main lobe
  const std::size_t near = 1 + static_cast<std::size_t>(24 / factor);
  for (std::size_t l = 0; l < power.size(); ++l) {
    const bool elsewhere = l + near < best || l > best + near;
    if (elsewhere && power[l] > kLargestEcho * kLargestEcho * power[best]) return std::nullopt;
  }
  return Place{static_cast<double>(best) * static_cast<double>(factor), likeness};
}

/// Correlation of the samples with the analytic (complex) pilot signal that starts at `frame`, which may have
/// a fraction.
Complex correlation_at(const Pilot& pilot, const std::vector<double>& samples, double frame) {
  const auto size = static_cast<std::int64_t>(samples.size());
  const auto first = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(frame)) - 1, 0, size);
  const auto end = std::clamp<std::int64_t>(first + pilot.frames + 3, 0, size);
  Complex sum = 0;
  for (std::int64_t n = first; n < end; ++n)
    sum += samples[static_cast<std::size_t>(n)] * std::conj(pilot_at(pilot, static_cast<double>(n) - frame));
  return sum;
}

/// Returns the start at which the magnitude of the correlation is largest; `coarse` is a first estimate.
double envelope_place(const Pilot& pilot, const std::vector<double>& samples, double coarse) {
  constexpr double step = 0.5;
  constexpr int reach = 16;
  std::vector<double> power;
  for (int k = -reach; k <= reach; ++k)
    power.push_back(std::abs(correlation_at(pilot, samples, coarse + k * step)));
  const auto best = std::clamp<std::ptrdiff_t>(std::max_element(power.begin(), power.end()) - power.begin(),
                                               1, 2 * reach - 1);
  const auto* p = power.data() + best;
  const double bend = p[-1] - 2 * p[0] + p[1];
  const double offset = bend < 0 ? 0.5 * (p[-1] - p[1]) / bend : 0;
  return coarse + (static_cast<double>(best - reach) + offset) * step;
}

/// Phase of the correlation between -90 and 90 degrees. It is 0 if the carriers are exactly in phase or
/// exactly opposite.
double carrier_phase(Complex correlation) {
  const double phase = std::arg(correlation * Complex(0, 1));
  return std::remainder(phase, M_PI);
}

}  // namespace

audio::Burst pilot_burst(const Pilot& pilot, std::int64_t start_frame) {
  audio::Burst burst;
  burst.start_frame = start_frame;
  burst.length_frames = pilot.frames;
  burst.ramp.frames = pilot.frames / 2;
  burst.tones.count = 1;
  burst.tones.tones[0] = {pilot.low_Hz, pilot.amplitude, 0, pilot.channel};
  burst.change_count = 1;
  burst.changes[0] = {0, pilot.frames, burst.tones};
  burst.changes[0].to.tones[0].frequency_Hz = pilot.high_Hz;
  return burst;
}

PilotListener::PilotListener(const Pilot& pilot, std::int64_t start_frame, int capture_channels,
                             int reference_channel, double longest_delay_s)
    : pilot_(pilot),
      start_frame_(start_frame),
      channels_(capture_channels),
      reference_(reference_channel),
      wanted_(static_cast<std::size_t>(std::ceil(longest_delay_s * pilot.rate_Hz) +
                                       static_cast<double>(pilot.frames + 2 * kMargin_frames))) {
  if (reference_channel < 0 || reference_channel >= capture_channels)
    throw std::logic_error("sensing: no such captured channel");
  samples_.reserve(wanted_);
}

void PilotListener::push(const CaptureBlock& block) {
  if (block.rate_Hz != pilot_.rate_Hz || block.channels != channels_)
    throw std::logic_error("sensing: captured block has an unexpected rate or number of channels");
  const std::int64_t next = start_frame_ - kMargin_frames + static_cast<std::int64_t>(samples_.size());
  if (block.first_frame > next) lost_ = lost_ || !complete();
  for (std::int64_t n = std::max<std::int64_t>(0, next - block.first_frame);
       n < block.frames() && !complete(); ++n)
    samples_.push_back(0x1p-31 * block.samples[static_cast<std::size_t>(n * channels_ + reference_)]);
}

std::optional<PilotEcho> PilotListener::find() const {
  if (lost_ || samples_.size() < wanted_) return std::nullopt;
  auto samples = samples_;
  if (pilot_.carrier_Hz > 0) remove_tone(samples, pilot_.carrier_Hz, pilot_.rate_Hz);
  const auto coarse = coarse_place(pilot_, samples);
  if (!coarse) return std::nullopt;
  double place = envelope_place(pilot_, samples, coarse->frame);
  // `turn` is how much the correlation's phase changes if the start is wrong by one frame. It is given by the
  // pilot's mean frequency.
  const double turn = M_PI * (pilot_.low_Hz + pilot_.high_Hz) / pilot_.rate_Hz;
  if (std::fabs(carrier_phase(correlation_at(pilot_, samples, place))) > kLargestTurn) return std::nullopt;
  for (int k = 0; k < 4; ++k) place -= carrier_phase(correlation_at(pilot_, samples, place)) / turn;
  double shape = 0;
  for (std::int64_t n = 0; n < pilot_.frames; ++n)
    shape += std::norm(pilot_at(pilot_, static_cast<double>(n)));
  const double amplitude = 2 * std::abs(correlation_at(pilot_, samples, place)) / shape;
  return PilotEcho{place - static_cast<double>(kMargin_frames), 20 * std::log10(amplitude / pilot_.amplitude),
                   coarse->likeness};
}

}  // namespace turnpoint::sensing
