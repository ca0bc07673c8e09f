#include "station/sensing/interval_proof.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "station/drive/sine.hpp"
#include "station/sensing/joint_fit.hpp"
#include "station/sensing/lock_in.hpp"
#include "station/sensing/onset.hpp"
#include "station/sensing/planned_stretches.hpp"

namespace turnpoint::sensing {

using terms::Proof;
using terms::ProofCause;

namespace {

constexpr double kWindow_s = 0.2;     // of a joint fit
constexpr double kShortest_s = 0.01;  // a shorter steady stretch is not measured
constexpr double kSettle_s = 0.005;   // the plate needs this long to follow: 7 time constants at Q 60
constexpr double kBefore_s = 0.02, kAfter_s = 0.06;  // around the rising ramp, where the onset is looked for
constexpr double kLowest_Hz = 5000;                  // of products
constexpr double kApart_Hz = 20;                     // least distance of a product from a tone
constexpr double kUnseenNoise = 0.05;  // a tone whose relative standard error is larger is not judged
constexpr double kVibrates_dB = -10;   // a weaker vibration has no onset to measure

double in_dB(double ratio) { return 20 * std::log10(std::max(ratio, 1e-10)); }

/// Tones of equal frequency, which only their sum can be measured of.
struct Line {
  std::uint64_t phase = 0, increment = 0;
  double frequency_Hz = 0, gain = 1;  // gain of the high-pass filter
  std::vector<PlannedTone> tones;
  std::vector<std::complex<double>> expected;  // by pick-up, in captured units
  std::vector<double> seen;                    // by pick-up: response / best response; 0 if unknown
};

struct Window {
  std::size_t stretch = 0;
  std::int64_t first = 0, end = 0;  // captured frames
  bool valid = false;
  std::vector<std::complex<double>> amplitude;  // [pick-up][line], as captured
  std::vector<double> residual;                 // [pick-up]: mean square behind the high-pass filter
};

struct Measured {
  Stretch plan;
  std::vector<Line> lines;
  std::unique_ptr<ToneSums> sums;
};

std::vector<Line> lines_of(const Stretch& stretch, const IntervalPlan& plan) {
  std::vector<Line> lines;
  for (const PlannedTone& tone : stretch.tones) {
    auto same = std::find_if(lines.begin(), lines.end(),
                             [&](const Line& line) { return line.increment == tone.increment; });
    if (same == lines.end()) {
      Line line;
      line.phase = tone.phase;
      line.increment = tone.increment;
      line.frequency_Hz = tone.frequency_Hz;
      line.gain = high_pass_gain(tone.frequency_Hz, plan.rate_Hz, high_pass_step(plan.rate_Hz));
      line.expected.resize(plan.pick_ups.size());
      line.seen.resize(plan.pick_ups.size());
      same = lines.insert(lines.end(), line);
    }
    same->tones.push_back(tone);
    const double turn = 2 * M_PI * 0x1p-64 * static_cast<double>(tone.phase - same->phase);
    for (std::size_t p = 0; p < plan.pick_ups.size(); ++p)
      if (const auto h = response(plan.pick_ups[p], tone.channel, tone.frequency_Hz))
        same->expected[p] += *h * std::polar(tone.amplitude, turn);
  }
  for (Line& line : lines) {
    double planned = 0;
    for (const PlannedTone& tone : line.tones) planned += tone.amplitude;
    for (std::size_t p = 0; p < plan.pick_ups.size(); ++p)
      line.seen[p] = std::abs(line.expected[p]) / (planned * best_response(plan.pick_ups[p]));
  }
  return lines;
}

std::vector<int> inputs_of(const IntervalPlan& plan) {
  if (plan.pick_ups.empty()) throw std::logic_error("sensing: a proof needs a pick-up");
  std::vector<int> inputs;
  for (const PickUp& pick_up : plan.pick_ups) inputs.push_back(pick_up.channel);
  return inputs;
}

}  // namespace

struct IntervalProof::State {
  explicit State(const IntervalPlan& plan);

  std::size_t pick_ups() const { return plan_.pick_ups.size(); }
  std::int64_t frames_of(double seconds) const { return std::llround(seconds * plan_.rate_Hz); }
  void add_stretches();
  void add_windows(std::size_t stretch);
  void choose_main();
  void add_onset();

  void take(const AlignedBlock& block) noexcept;
  void accumulate(const AlignedBlock& block, Window& window, const ToneSums& sums) noexcept;
  void finish(Window& window, const ToneSums& sums) noexcept;
  void keep_if_worst(const Window& window) noexcept;

  void conclude(std::optional<bool> in_contact);
  void measure_tones();
  void measure_tone(std::size_t stretch, const Line& line, std::size_t place);
  void measure_residual();
  void subtract_fit();
  void measure_onset();
  void find_lost();
  void judge_tones(const Limits& level);
  void judge_rest();
  std::optional<double> found_elsewhere(const ToneProof& tone);

  IntervalPlan plan_;
  LockInShape shape_;
  AlignedBlocks blocks_;
  std::vector<Measured> stretches_;
  std::vector<Window> windows_;
  std::size_t current_ = 0;           // window that is being filled
  std::int64_t begin_ = 0, end_ = 0;  // captured frames of the burst
  std::int64_t next_ = 0;             // first captured frame after those that were taken
  std::int64_t good_frames_ = 0;      // of the burst
  std::size_t main_ = 0;              // the pick-up that sees most of the plan

  JointFit fit_;
  std::vector<std::complex<double>> products_;  // sums of the current window, [pick-up][line]
  std::vector<double> energy_;
  std::int64_t summed_ = 0;  // frames in them
  std::vector<std::uint64_t> phases_, increments_;
  std::vector<float> raw_, worst_raw_;  // of the main pick-up, in the current and in the worst window
  std::ptrdiff_t worst_ = -1;
  bool fit_subtracted_ = false;

  bool onset_planned_ = false;
  std::int64_t onset_first_ = 0, onset_end_ = 0;  // captured frames of the lock-in
  double onset_frame_ = 0;                        // where the half level is planned, as captured
  std::unique_ptr<HannWindow> hann_;
  std::vector<std::complex<double>> points_;  // of the main pick-up, [point][line]
  std::int64_t first_point_ = 0;

  IntervalResult result_;
  bool vibrates_ = false;
  std::vector<Finding> findings_;
};

IntervalProof::State::State(const IntervalPlan& plan)
    : plan_(plan),
      shape_(LockInShape::of_rate(plan.rate_Hz)),
      blocks_(plan.rate_Hz, plan.capture_channels, inputs_of(plan), shape_.block_frames,
              high_pass_step(plan.rate_Hz)),
      fit_(drive::max_tones) {
  begin_ =
      static_cast<std::int64_t>(std::floor(static_cast<double>(plan.burst.start_frame) + plan.delay_frames));
  end_ = begin_ + 1 + plan.burst.length_frames;
  next_ = std::numeric_limits<std::int64_t>::min();
  add_stretches();
  choose_main();
  add_onset();
  products_.resize(pick_ups() * drive::max_tones);
  energy_.resize(pick_ups());
  phases_.resize(drive::max_tones);
  increments_.resize(drive::max_tones);
  std::int64_t longest = 0;
  for (const Window& window : windows_) longest = std::max(longest, window.end - window.first);
  raw_.resize(static_cast<std::size_t>(longest));
  worst_raw_.resize(raw_.size());
  std::size_t tones = 0;
  for (const Measured& stretch : stretches_) tones += stretch.plan.tones.size();
  result_.tones.reserve(tones);
  findings_.reserve(6 * tones + 16);
}

void IntervalProof::State::add_stretches() {
  for (Stretch& plan : planned_stretches(plan_.burst, plan_.rate_Hz)) {
    Measured made;
    made.lines = lines_of(plan, plan_);
    std::vector<FollowedTone> followed;
    for (const Line& line : made.lines)
      followed.push_back({{line.phase, line.increment, 0, 0, 0}, plan.origin_frame});
    made.sums = std::make_unique<ToneSums>(followed, pick_ups(), shape_.block_frames, shape_.window_frames,
                                           plan_.delay_frames);
    made.plan = std::move(plan);
    stretches_.push_back(std::move(made));
    add_windows(stretches_.size() - 1);
  }
}

void IntervalProof::State::add_windows(std::size_t stretch) {
  const Stretch& plan = stretches_[stretch].plan;
  const double block = shape_.block_frames;
  const auto first = static_cast<std::int64_t>(
      std::ceil((static_cast<double>(plan.first_frame + frames_of(kSettle_s)) + plan_.delay_frames) / block));
  const auto end = static_cast<std::int64_t>(
      std::floor((static_cast<double>(plan.end_frame) + plan_.delay_frames) / block));
  const std::int64_t blocks = end - first;
  if (static_cast<double>(blocks) * block < kShortest_s * plan_.rate_Hz || plan.tones.empty()) return;
  const auto count = std::max<std::int64_t>(
      1, std::llround(static_cast<double>(blocks) * block / (kWindow_s * plan_.rate_Hz)));
  for (std::int64_t k = 0; k < count; ++k) {
    Window window;
    window.stretch = stretch;
    window.first = (first + blocks * k / count) * shape_.block_frames;
    window.end = (first + blocks * (k + 1) / count) * shape_.block_frames;
    window.amplitude.resize(pick_ups() * stretches_[stretch].lines.size());
    window.residual.resize(pick_ups());
    windows_.push_back(std::move(window));
  }
}

void IntervalProof::State::choose_main() {
  if (stretches_.empty()) return;
  double most = -1;
  for (std::size_t p = 0; p < pick_ups(); ++p) {
    double seen = 0;
    for (const Line& line : stretches_.front().lines) seen += line.seen[p] * line.seen[p];
    if (seen > most) {
      most = seen;
      main_ = p;
    }
  }
}

// The onset can be measured if the first tones last until the window of the lock-in has passed the ramp.
void IntervalProof::State::add_onset() {
  if (windows_.empty() || windows_.front().stretch != 0) return;
  const auto& [plan, lines, sums] = stretches_.front();
  const std::int64_t start = plan_.burst.start_frame, ramp = plan_.burst.ramp.frames;
  if (plan.first_frame != start + ramp || plan.origin_frame != start) return;
  if (plan.end_frame < start + ramp / 2 + shape_.window_frames) return;
  double delay_s = 0, weights = 0;
  for (const Line& line : lines)
    for (const PlannedTone& tone : line.tones) {
      const double weight = std::norm(line.expected[main_] * line.gain);
      delay_s += weight * group_delay_s(plan_.pick_ups[main_], tone.channel, tone.frequency_Hz);
      weights += weight;
    }
  if (!(weights > 0)) return;
  onset_planned_ = true;
  onset_frame_ = static_cast<double>(start) + (static_cast<double>(ramp) - 1) / 2 + plan_.delay_frames +
                 delay_s / weights * plan_.rate_Hz;
  const std::int64_t block = shape_.block_frames, half = shape_.window_frames / 2;
  onset_first_ = (begin_ - frames_of(kBefore_s) - half) / block * block;
  onset_end_ = (begin_ + ramp + frames_of(kAfter_s) + half) / block * block;
  onset_end_ = std::min(onset_end_, (end_ - ramp) / block * block);
  hann_ = std::make_unique<HannWindow>(lines.size(), pick_ups(), shape_.block_frames, shape_.window_frames);
  points_.reserve(static_cast<std::size_t>((onset_end_ - onset_first_) / block + 1) * lines.size());
}

void IntervalProof::State::take(const AlignedBlock& block) noexcept {
  const std::int64_t end = block.first_frame + block.frames;
  next_ = end;
  const std::int64_t inside = std::min(end, end_) - std::max(block.first_frame, begin_);
  if (inside > 0 && !block.lost) {
    good_frames_ += inside;
    result_.largest_sample = std::max(result_.largest_sample, block.largest);
  }
  const bool onset = onset_planned_ && block.first_frame >= onset_first_ && end <= onset_end_;
  while (current_ < windows_.size() && windows_[current_].end <= block.first_frame) {
    ++current_;
    summed_ = 0;
  }
  Window* window = current_ < windows_.size() && windows_[current_].first <= block.first_frame
                       ? &windows_[current_]
                       : nullptr;
  if (!onset && window == nullptr) return;
  const std::size_t stretch = window != nullptr ? window->stretch : 0;
  ToneSums& sums = *stretches_[stretch].sums;
  sums.compute(block, onset && stretch == 0 ? ToneSums::Parts::windowed : ToneSums::Parts::plain);
  if (window != nullptr) accumulate(block, *window, sums);
  if (!onset || stretch != 0) return;
  if (!hann_->take(block, sums)) return;
  if (points_.empty()) first_point_ = hann_->centre();
  const std::size_t lines = sums.tones();
  for (std::size_t l = 0; l < lines && points_.size() < points_.capacity(); ++l)
    points_.push_back(hann_->values()[main_ * lines + l]);
}

void IntervalProof::State::accumulate(const AlignedBlock& block, Window& window,
                                      const ToneSums& sums) noexcept {
  const std::size_t lines = sums.tones();
  if (block.first_frame == window.first) {
    std::fill(products_.begin(), products_.end(), std::complex<double>{});
    std::fill(energy_.begin(), energy_.end(), 0.0);
    summed_ = 0;
  }
  if (block.lost || block.first_frame != window.first + summed_) return;  // the window stays invalid
  for (std::size_t p = 0; p < pick_ups(); ++p) {
    energy_[p] += block.energy[p];
    for (std::size_t l = 0; l < lines; ++l) products_[p * lines + l] += sums.plain(p, l);
  }
  for (std::int64_t n = 0; n < block.frames; ++n)
    raw_[static_cast<std::size_t>(summed_ + n)] = static_cast<float>(block.row[main_][n]);
  summed_ += block.frames;
  if (window.first + summed_ == window.end) finish(window, sums);
}

void IntervalProof::State::finish(Window& window, const ToneSums& sums) noexcept {
  const std::size_t lines = sums.tones();
  for (std::size_t l = 0; l < lines; ++l) {
    phases_[l] = sums.phase_at(l, window.first);
    increments_[l] = sums.increment(l);
  }
  if (!fit_.prepare({phases_.data(), lines}, {increments_.data(), lines}, summed_)) return;
  for (std::size_t p = 0; p < pick_ups(); ++p) {
    const std::span<std::complex<double>> amplitude{window.amplitude.data() + p * lines, lines};
    const double rest = fit_.solve({products_.data() + p * lines, lines}, energy_[p], amplitude);
    window.residual[p] = rest / static_cast<double>(summed_);
    for (std::size_t l = 0; l < lines; ++l) amplitude[l] /= stretches_[window.stretch].lines[l].gain;
  }
  window.valid = true;
  keep_if_worst(window);
}

void IntervalProof::State::keep_if_worst(const Window& window) noexcept {
  if (worst_ >= 0 && windows_[static_cast<std::size_t>(worst_)].residual[main_] >= window.residual[main_])
    return;
  worst_ = &window - windows_.data();
  raw_.swap(worst_raw_);
}

void IntervalProof::State::measure_tones() {
  double measured = 0, planned = 0;
  for (std::size_t s = 0; s < stretches_.size(); ++s)
    for (std::size_t l = 0; l < stretches_[s].lines.size(); ++l) {
      const Line& line = stretches_[s].lines[l];
      measure_tone(s, line, l);
      const ToneProof& last = result_.tones.back();
      if (!last.seen) continue;
      double amplitude = 0;
      for (const PlannedTone& tone : line.tones) amplitude += tone.amplitude;
      planned += amplitude * amplitude;
      measured += amplitude * amplitude * std::pow(10, last.ratio_dB / 10);
    }
  result_.ratio_dB = planned > 0 ? in_dB(std::sqrt(measured / planned)) : 0;
  vibrates_ = planned > 0 && result_.ratio_dB > kVibrates_dB;
}

// Adds one entry for each tone of the line, measured by the pick-up that sees it best.
void IntervalProof::State::measure_tone(std::size_t stretch, const Line& line, std::size_t place) {
  ToneProof made;
  made.stretch = static_cast<int>(stretch);
  made.frequency_Hz = line.frequency_Hz;
  const auto p =
      static_cast<std::size_t>(std::max_element(line.seen.begin(), line.seen.end()) - line.seen.begin());
  const std::size_t lines = stretches_[stretch].lines.size();
  double power = 0, noise = 0;
  std::complex<double> sum = 0;
  int count = 0;
  for (const Window& window : windows_) {
    if (window.stretch != stretch || !window.valid) continue;
    const auto ratio = window.amplitude[p * lines + place] / line.expected[p];
    const double frames = static_cast<double>(window.end - window.first);
    noise = std::max(noise,
                     std::sqrt(2 * window.residual[p] / frames) / (line.gain * std::abs(line.expected[p])));
    power += std::norm(ratio);
    sum += ratio;
    ++count;
    const double dB = in_dB(std::abs(ratio));
    if (count == 1 || std::fabs(dB) > std::fabs(made.worst_ratio_dB)) made.worst_ratio_dB = dB;
  }
  made.seen = count > 0 && in_dB(line.seen[p]) >= plan_.limits.unseen_dB && noise < kUnseenNoise;
  if (made.seen) {
    made.pick_up = static_cast<int>(p);
    made.ratio_dB = in_dB(std::sqrt(power / count));
    made.phase_error_deg = std::arg(sum) * 180 / M_PI;
  } else {
    made.worst_ratio_dB = 0;
  }
  for (const PlannedTone& tone : line.tones) {
    made.tone = tone.index;
    made.drive_channel = tone.channel;
    result_.tones.push_back(made);
  }
}

void IntervalProof::State::measure_residual() {
  if (worst_ < 0) return;
  const Window& window = windows_[static_cast<std::size_t>(worst_)];
  double weighted = 0, plain = 0;
  std::vector<double> frequencies;
  for (const Line& line : stretches_[window.stretch].lines) {
    plain += std::norm(line.expected[main_]) / 2;
    weighted += std::norm(line.expected[main_] * line.gain) / 2;
    frequencies.push_back(line.frequency_Hz);
  }
  if (!(weighted > 0)) return;
  result_.residual_dB = in_dB(std::sqrt(window.residual[main_] / weighted));
  if (result_.residual_dB < plan_.limits.residual_dB.flag - 20) return;
  subtract_fit();
  const std::span<const float> rest{worst_raw_.data(), static_cast<std::size_t>(window.end - window.first)};
  const int step = high_pass_step(plan_.rate_Hz);
  for (Product& product : products_of(frequencies, plan_.rate_Hz, kLowest_Hz, kApart_Hz)) {
    const double amplitude = amplitude_at(rest, product.frequency_Hz, plan_.rate_Hz) /
                             high_pass_gain(product.frequency_Hz, plan_.rate_Hz, step);
    product.level_dB = in_dB(amplitude / std::sqrt(2 * plain));
    if (!result_.product || product.level_dB > result_.product->level_dB) result_.product = product;
  }
}

// Leaves in the kept samples of the worst window only what the fit does not explain.
void IntervalProof::State::subtract_fit() {
  if (fit_subtracted_) return;
  fit_subtracted_ = true;
  const Window& window = windows_[static_cast<std::size_t>(worst_)];
  const auto& [plan, lines, sums] = stretches_[window.stretch];
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const auto a = window.amplitude[main_ * lines.size() + l] * lines[l].gain;
    std::uint64_t phase = sums->phase_at(l, window.first) + drive::phase_of_angle(std::arg(a));
    const double size = std::abs(a);
    for (std::int64_t n = 0; n < window.end - window.first; ++n, phase += lines[l].increment) {
      float& sample = worst_raw_[static_cast<std::size_t>(n)];
      sample = static_cast<float>(static_cast<double>(sample) - size * drive::sine_of_phase(phase));
    }
  }
}

void IntervalProof::State::measure_onset() {
  const auto first = std::find_if(windows_.begin(), windows_.end(), [](const Window& w) { return w.valid; });
  if (!onset_planned_ || !vibrates_ || first == windows_.end() || first->stretch != 0) return;
  const auto& lines = stretches_.front().lines;
  const std::size_t count = lines.size();
  double power = 0;
  for (std::size_t l = 0; l < count; ++l)
    power += std::norm(first->amplitude[main_ * count + l] * lines[l].gain);
  std::vector<double> envelope;
  for (std::size_t k = 0; k + count <= points_.size(); k += count) {
    double level = 0;
    for (std::size_t l = 0; l < count; ++l) {
      const auto steady = first->amplitude[main_ * count + l] * lines[l].gain;
      level += (std::conj(steady) * points_[k + l]).real();
    }
    envelope.push_back(level / power);
  }
  if (const auto at = half_level(envelope)) {
    const double frame = static_cast<double>(first_point_) + *at * shape_.block_frames;
    result_.onset_error_us = (frame - onset_frame_) / plan_.rate_Hz * 1e6;
  }
}

void IntervalProof::State::find_lost() {
  result_.lost_frames = end_ - begin_ - good_frames_;
  if (result_.lost_frames > 0) findings_.push_back({ProofCause::gap, Proof::lost});
}

// Where a missing tone is found instead, if it is; within 8 % of its frequency.
std::optional<double> IntervalProof::State::found_elsewhere(const ToneProof& tone) {
  if (worst_ < 0 || result_.residual_dB < plan_.limits.residual_dB.stop - 20) return std::nullopt;
  const Window& window = windows_[static_cast<std::size_t>(worst_)];
  if (static_cast<int>(window.stretch) != tone.stretch) return std::nullopt;
  subtract_fit();
  const std::span<const float> rest{worst_raw_.data(), static_cast<std::size_t>(window.end - window.first)};
  double planned = 0;
  for (const Line& line : stretches_[window.stretch].lines)
    if (line.frequency_Hz == tone.frequency_Hz) planned = std::abs(line.expected[main_]);
  const int step = high_pass_step(plan_.rate_Hz);
  const double distance = plan_.rate_Hz / static_cast<double>(rest.size());
  double largest = 0, found = 0;
  for (double f = 0.92 * tone.frequency_Hz; f <= 1.08 * tone.frequency_Hz; f += distance) {
    const double amplitude = amplitude_at(rest, f, plan_.rate_Hz) / high_pass_gain(f, plan_.rate_Hz, step);
    if (amplitude > largest) {
      largest = amplitude;
      found = f;
    }
  }
  if (largest < 0.1 * planned) return std::nullopt;
  return found;
}

void IntervalProof::State::judge_tones(const Limits& level) {
  const ProofLimits& limits = plan_.limits;
  bool searched = false;
  for (const ToneProof& tone : result_.tones) {
    if (!tone.seen) {
      findings_.push_back({ProofCause::none, Proof::unproven});
      continue;
    }
    if (tone.ratio_dB < kVibrates_dB && !searched) {
      searched = true;
      result_.found_Hz = found_elsewhere(tone);
      if (result_.found_Hz) findings_.push_back({ProofCause::frequency, Proof::stopped});
    }
    if (tone.ratio_dB < limits.dead_dB)
      findings_.push_back({result_.found_Hz ? ProofCause::frequency : ProofCause::dead, Proof::stopped});
    findings_.push_back({ProofCause::level, judged(std::fabs(tone.worst_ratio_dB), level)});
    if (tone.ratio_dB > limits.dead_dB)
      findings_.push_back({ProofCause::phase, judged(std::fabs(tone.phase_error_deg), limits.phase_deg)});
  }
  for (int channel = 0; channel < drive::max_channels; ++channel) {
    int tones = 0, halved = 0;
    for (const ToneProof& tone : result_.tones) {
      if (!tone.seen || tone.drive_channel != channel) continue;
      ++tones;
      halved += tone.ratio_dB > limits.half_low_dB && tone.ratio_dB < limits.half_high_dB ? 1 : 0;
    }
    if (tones > 0 && halved == tones)
      findings_.push_back({ProofCause::half, judged(-limits.half_high_dB, level)});
  }
}

void IntervalProof::State::judge_rest() {
  const ProofLimits& limits = plan_.limits;
  const double product = result_.product ? result_.product->level_dB : -200;
  const Proof residual = judged(std::max(result_.residual_dB, product), limits.residual_dB);
  findings_.push_back({ProofCause::residual, residual});
  if (result_.largest_sample >= limits.clipped) findings_.push_back({ProofCause::clipped, Proof::refused});
  // A limiter makes odd products and takes a part of the tones away.
  if (product >= limits.residual_dB.flag && is_odd(result_.product->kind) && result_.ratio_dB < -0.1)
    findings_.push_back({ProofCause::clipped, residual});
  if (result_.onset_error_us)
    findings_.push_back({ProofCause::late, judged(std::fabs(*result_.onset_error_us), limits.onset_us)});
  else if (onset_planned_ && vibrates_ && result_.lost_frames == 0 && !points_.empty())
    findings_.push_back({ProofCause::late, Proof::refused});
  else
    findings_.push_back({ProofCause::none, Proof::unproven});
  if (windows_.empty()) findings_.push_back({ProofCause::none, Proof::unproven});
}

void IntervalProof::State::conclude(std::optional<bool> in_contact) {
  findings_.clear();
  result_.tones.clear();
  result_.product.reset();
  result_.onset_error_us.reset();
  result_.found_Hz.reset();
  measure_tones();
  measure_residual();
  measure_onset();
  find_lost();
  const ProofLimits& limits = plan_.limits;
  judge_tones(in_contact.value_or(true) ? limits.level_in_contact_dB : limits.level_dB);
  judge_rest();
  const Finding all = concluded(findings_);
  result_.verdict = all.verdict;
  result_.cause = all.cause;
}

IntervalProof::IntervalProof(const IntervalPlan& plan) : state_(new State(plan)) {}
IntervalProof::~IntervalProof() = default;
IntervalProof::IntervalProof(IntervalProof&&) noexcept = default;
IntervalProof& IntervalProof::operator=(IntervalProof&&) noexcept = default;

std::int64_t IntervalProof::first_frame() const noexcept {
  return state_->begin_ - state_->frames_of(kBefore_s + 0.005) - state_->shape_.block_frames - 2;
}

std::int64_t IntervalProof::end_frame() const noexcept {
  return state_->end_ + state_->shape_.block_frames + high_pass_step(state_->plan_.rate_Hz);
}

void IntervalProof::push(const CaptureBlock& block) {
  const std::int64_t end = block.first_frame + block.frames();
  if (end <= first_frame() || complete()) return;
  state_->blocks_.push(block, [this](const AlignedBlock& aligned) { state_->take(aligned); });
}

bool IntervalProof::complete() const noexcept { return state_->next_ >= state_->end_; }

const IntervalResult& IntervalProof::result(std::optional<bool> in_contact) {
  state_->conclude(in_contact);
  return state_->result_;
}

}  // namespace turnpoint::sensing
