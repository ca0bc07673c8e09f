#include "station/sensing/interval_proof.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "station/audio/sine.hpp"
#include "station/sensing/aligned_blocks.hpp"
#include "station/sensing/glide_proof.hpp"
#include "station/sensing/joint_fit.hpp"
#include "station/sensing/lock_in.hpp"
#include "station/sensing/planned_lines.hpp"
#include "station/sensing/tone_sums.hpp"

// The state of an IntervalProof. interval_proof.cpp takes the captured frames, and interval_measure.cpp
// computes the result from them.

// Changes that are sent while the burst plays.

namespace turnpoint::sensing {

constexpr double kShortest_s = 0.01;  // a shorter steady stretch is not measured
// time that the plate needs to follow a change: 7 time constants at Q 60
constexpr double kSettle_s = 0.005;

/// A window of captured frames to which all tones are fitted. Nothing changes in the burst during a window.
struct Window {
  std::size_t stretch = 0;
  std::int64_t first = 0, end = 0;  // first captured frame, and the one after the last
  bool valid = false;
  std::vector<std::uint64_t> phase;  // played phase of each line at the first frame, in 2^-64 cycles
  std::vector<std::complex<double>> amplitude;  // captured complex amplitudes, [pick-up][line]
  std::vector<double> residual;                 // mean squares of what the tones do not explain, after the
                                                // high-pass filter, [pick-up]
};

struct Measured {
  Stretch plan;
  std::vector<PlannedLine> lines;
  std::unique_ptr<ToneSums> sums;  // null once all frames of the stretch have been received
};

/// The lock-in that looks for the moment at which a ramp of the burst passes half its level.
struct RampWatch {
  bool planned = false;
  std::size_t stretch = 0;          ///< the steady tones before or after the ramp
  std::int64_t first = 0, end = 0;  ///< captured frames in which it looks
  double half_frame = 0;            ///< captured frame at which the planned envelope is at half its level
  std::unique_ptr<HannWindow> hann;
  std::vector<std::complex<double>> points;  ///< of the main pick-up, [point][line]
  std::int64_t first_point = 0;
};

struct IntervalProof::State {
  explicit State(const IntervalPlan& plan);

  std::size_t pick_ups() const { return plan_.pick_ups.size(); }
  std::int64_t frames_of(double seconds) const { return std::llround(seconds * plan_.rate_Hz); }
  void add_parts();
  void add_stretch(Stretch plan);
  void add_glide(const Glide& glide, std::int64_t end_frame);
  void size_buffers();
  void change(const audio::Change& change, const audio::Format& format);
  void end_stretch_at(std::int64_t frame);
  void end_windows_at(std::int64_t end) noexcept;
  std::int64_t block_at_or_after(std::int64_t playback_frame) const;
  std::int64_t block_at_or_before(std::int64_t playback_frame) const;
  void add_windows(std::size_t stretch);
  std::int64_t needed_until() const noexcept;
  void add_onset();
  void add_offset();
  double planned_delay_frames(const std::vector<PlannedLine>& lines) const;
  void watch_ramp(RampWatch& watch, std::int64_t first, std::int64_t end);

  void end_at(std::int64_t playback_frame) noexcept;

  void take(const AlignedBlock& block);
  void follow(RampWatch& watch, const AlignedBlock& block, const ToneSums& sums) noexcept;
  void accumulate(const AlignedBlock& block, Window& window, const ToneSums& sums) noexcept;
  void finish(Window& window, const ToneSums& sums) noexcept;
  void keep_if_worst(const Window& window) noexcept;

  void conclude(std::optional<bool> in_contact);
  void measure_tones();
  void measure_tone(std::size_t stretch, const PlannedLine& line, std::size_t place);
  void measure_residual();
  void measure_products();
  void measure_brief();
  std::span<const double> unexplained();
  std::optional<double> ramp_error_us(const RampWatch& watch, bool rising) const;
  void find_lost();
  void judge_tones(const Limits& level);
  void judge_glides(const Limits& level);
  void judge_rest();
  std::optional<double> found_elsewhere(const ToneProof& tone);

  IntervalPlan plan_;
  LockInShape shape_;
  AlignedBlocks blocks_;
  PlannedTones tones_;
  std::vector<Measured> stretches_;
  std::vector<Window> windows_;
  std::vector<GlideProof> glides_;
  std::size_t current_glide_ = 0;
  int live_changes_ = 0;
  bool unplanned_ = false;            // a live change came that cannot be measured
  std::size_t current_ = 0;           // index of the window that is being filled
  std::int64_t begin_ = 0, end_ = 0;  // the burst's first captured frame, and the one after its last
  bool cut_ = false;                  // the burst was stopped
  std::int64_t next_ = 0;             // first captured frame that has not been received
  std::vector<std::uint8_t> good_;    // for each aligned block of the burst: 1 if it was captured
  std::size_t main_ = 0;              // index of the pick-up that captures the planned tones most strongly

  JointFit fit_;
  // sums of sample times sinusoid in the current window, [pick-up][line]
  std::vector<std::complex<double>> products_;
  std::vector<double> energy_;
  std::int64_t summed_ = 0;  // number of frames that products_ and energy_ contain
  std::vector<std::uint64_t> phases_, increments_;
  std::vector<double> raw_, worst_raw_;  // samples of the main pick-up in the current and in the worst window
  std::optional<std::size_t> worst_;     // window with the largest residual
  bool fit_subtracted_ = false;

  RampWatch onset_, offset_;

  IntervalResult result_;
  bool vibrates_ = false;
  std::vector<Finding> findings_;
};

/// Returns the index (with a fraction) at which an envelope last rises through 0.5, half of its final level
/// of 1, interpolated by cubics. Empty if the envelope never rises through 0.5, or if a value next to the
/// crossing is NaN. A symmetric low-pass filter does not move the half level of a symmetric ramp, so the
/// envelope may have been filtered, even with a window longer than the ramp.
std::optional<double> half_level(std::span<const double> envelope);

namespace {

// Value at index `at` of the polynomial through `points` values of y that start at index `first`.
double interpolated(std::span<const double> y, std::size_t first, std::size_t points, double at) {
  double sum = 0;
  for (std::size_t i = first; i < first + points; ++i) {
    double weight = 1;
    for (std::size_t j = first; j < first + points; ++j)
      if (j != i) weight *= (at - static_cast<double>(j)) / (static_cast<double>(i) - static_cast<double>(j));
    sum += weight * y[i];
  }
  return sum;
}

}  // namespace

std::optional<double> half_level(std::span<const double> envelope) {
  constexpr double half = 0.5;
  std::optional<std::size_t> below;
  for (std::size_t k = 0; k + 1 < envelope.size(); ++k)
    if (envelope[k] < half && envelope[k + 1] >= half) below = k;
  if (!below) return std::nullopt;
  const std::size_t points = std::min<std::size_t>(4, envelope.size());
  const std::size_t first = std::min(*below > 0 ? *below - 1 : 0, envelope.size() - points);
  for (std::size_t k = first; k < first + points; ++k)
    if (std::isnan(envelope[k])) return std::nullopt;
  auto low = static_cast<double>(*below), high = low + 1;
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    (interpolated(envelope, first, points, middle) < half ? low : high) = middle;
  }
  return low;
}

namespace {

constexpr double kWindow_s = 0.2;  // approximate length of the windows for the joint fits
// the onset is looked for from this time before the rising ramp to this time after it
constexpr double kBefore_s = 0.02, kAfter_s = 0.06;
// the end of the burst is looked for until this time after it
constexpr double kFallen_s = 0.003;

std::vector<int> inputs_of(const IntervalPlan& plan) {
  if (plan.pick_ups.empty()) throw std::logic_error("sensing: a proof needs a pick-up");
  std::vector<int> inputs;
  for (const PickUp& pick_up : plan.pick_ups) inputs.push_back(pick_up.channel);
  return inputs;
}

}  // namespace

IntervalProof::State::State(const IntervalPlan& plan)
    : plan_(plan),
      shape_(LockInShape::of_rate(plan.rate_Hz)),
      blocks_(plan.rate_Hz, plan.capture_channels, inputs_of(plan), shape_.block_frames,
              high_pass_step(plan.rate_Hz)),
      tones_(plan.burst),
      fit_(audio::max_tones) {
  begin_ =
      static_cast<std::int64_t>(std::floor(static_cast<double>(plan.burst.start_frame) + plan.delay_frames));
  end_ = begin_ + 1 + plan.burst.length_frames;
  next_ = std::numeric_limits<std::int64_t>::min();
  good_.resize(static_cast<std::size_t>((end_ - 1) / shape_.block_frames - begin_ / shape_.block_frames + 1));
  add_parts();
  if (!stretches_.empty()) main_ = main_pick_up(stretches_.front().lines, pick_ups());
  add_onset();
  add_offset();
  products_.resize(pick_ups() * audio::max_tones);
  energy_.resize(pick_ups());
  phases_.resize(audio::max_tones);
  increments_.resize(audio::max_tones);
  size_buffers();
}

void IntervalProof::State::size_buffers() {
  std::int64_t longest = 0;
  for (const Window& window : windows_) longest = std::max(longest, window.end - window.first);
  raw_.resize(std::max(raw_.size(), static_cast<std::size_t>(longest)));
  worst_raw_.resize(raw_.size());
  std::size_t tones = 0;
  for (const Measured& stretch : stretches_) tones += stretch.plan.tones.size();
  result_.tones.reserve(tones);
  findings_.reserve(6 * tones + 16);
}

// Adds the stretches of the burst, and the glides between them.
void IntervalProof::State::add_parts() {
  const audio::PreparedBurst& burst = plan_.burst;
  const std::int64_t start = burst.start_frame, risen = start + burst.ramp.frames,
                     falls = start + burst.length_frames - burst.ramp.frames;
  for (int c = 0; c <= burst.change_count; ++c) {
    const auto begins_at = [&](int change) {
      return change < burst.change_count
                 ? std::min(start + burst.changes[static_cast<std::size_t>(change)].at_frame, falls)
                 : falls;
    };
    const std::int64_t first = std::max(tones_.origin_frame(), risen), end = begins_at(c);
    if (first < end) add_stretch(tones_.stretch(first, end));
    if (c < burst.change_count)
      add_glide(tones_.change(burst.changes[static_cast<std::size_t>(c)]), begins_at(c + 1));
  }
}

void IntervalProof::State::add_stretch(Stretch plan) {
  Measured made;
  made.lines = planned_lines(plan, plan_.pick_ups, plan_.rate_Hz);
  std::vector<FollowedTone> followed;
  for (const PlannedLine& line : made.lines)
    followed.push_back({line.tones.front().partial, plan.origin_frame});
  made.sums = std::make_unique<ToneSums>(followed, pick_ups(), shape_.block_frames, shape_.window_frames,
                                         plan_.delay_frames);
  made.plan = std::move(plan);
  stretches_.push_back(std::move(made));
  add_windows(stretches_.size() - 1);
}

// Measures a glide until the plate has settled, if the burst does not change again before. What lies in the
// ramps of the burst is left out.
void IntervalProof::State::add_glide(const Glide& glide, std::int64_t end_frame) {
  const audio::PreparedBurst& burst = plan_.burst;
  const std::int64_t first = std::max(glide.first_frame, burst.start_frame + burst.ramp.frames);
  const std::int64_t end = std::min(glide.first_frame + glide.frames + frames_of(kSettle_s), end_frame);
  const std::int64_t block = block_at_or_before(first), end_block = block_at_or_after(end);
  const std::int64_t from = first > glide.first_frame ? block_at_or_after(first) : block;
  const std::int64_t to = end == end_frame ? block_at_or_before(end) : end_block;
  if (from < to && !glide.tones.empty())
    glides_.emplace_back(glide, from, to, plan_.pick_ups, plan_.rate_Hz, shape_.block_frames,
                         plan_.delay_frames);
}

std::int64_t IntervalProof::State::block_at_or_after(std::int64_t playback_frame) const {
  const double block = shape_.block_frames;
  return static_cast<std::int64_t>(
             std::ceil((static_cast<double>(playback_frame) + plan_.delay_frames) / block)) *
         shape_.block_frames;
}

std::int64_t IntervalProof::State::block_at_or_before(std::int64_t playback_frame) const {
  const double block = shape_.block_frames;
  return static_cast<std::int64_t>(
             std::floor((static_cast<double>(playback_frame) + plan_.delay_frames) / block)) *
         shape_.block_frames;
}

void IntervalProof::State::add_windows(std::size_t stretch) {
  const Stretch& plan = stretches_[stretch].plan;
  const std::int64_t first = block_at_or_after(plan.first_frame + frames_of(kSettle_s)),
                     end = block_at_or_before(plan.end_frame);
  if (static_cast<double>(end - first) < kShortest_s * plan_.rate_Hz || plan.tones.empty()) return;
  const std::int64_t blocks = (end - first) / shape_.block_frames;
  const auto count =
      std::max<std::int64_t>(1, std::llround(static_cast<double>(end - first) / (kWindow_s * plan_.rate_Hz)));
  for (std::int64_t k = 0; k < count; ++k) {
    Window window;
    window.stretch = stretch;
    window.first = first + blocks * k / count * shape_.block_frames;
    window.end = first + blocks * (k + 1) / count * shape_.block_frames;
    window.phase.resize(stretches_[stretch].lines.size());
    window.amplitude.resize(pick_ups() * stretches_[stretch].lines.size());
    window.residual.resize(pick_ups());
    windows_.push_back(std::move(window));
  }
}

// The mean group delay from the drive to the main pick-up, plus the loop delay.
double IntervalProof::State::planned_delay_frames(const std::vector<PlannedLine>& lines) const {
  double delay_s = 0, weights = 0;
  for (const PlannedLine& line : lines)
    for (const PlayedTone& tone : line.tones) {
      const double weight = std::norm(line.expected[main_] * line.gain);
      delay_s += weight * group_delay_s(plan_.pick_ups[main_], tone.partial.channel, line.frequency_Hz);
      weights += weight;
    }
  if (!(weights > 0)) return std::numeric_limits<double>::quiet_NaN();
  return plan_.delay_frames + delay_s / weights * plan_.rate_Hz;
}

std::int64_t IntervalProof::State::needed_until() const noexcept {
  return offset_.planned ? std::max(end_, offset_.end) : end_;
}

void IntervalProof::State::watch_ramp(RampWatch& watch, std::int64_t first, std::int64_t end) {
  const std::int64_t block = shape_.block_frames;
  const std::size_t lines = stretches_[watch.stretch].lines.size();
  watch.planned = !std::isnan(watch.half_frame);
  watch.first = first / block * block, watch.end = end / block * block;
  watch.hann = std::make_unique<HannWindow>(lines, pick_ups(), shape_.block_frames, shape_.window_frames);
  watch.points.clear();
  watch.points.reserve(static_cast<std::size_t>((watch.end - watch.first) / block + 1) * lines);
}

// Sets up the measurement of the onset. It is possible only if the first tones last so long that the window
// of the lock-in passes the whole ramp before they change.
void IntervalProof::State::add_onset() {
  if (windows_.empty() || windows_.front().stretch != 0) return;
  const auto& plan = stretches_.front().plan;
  const std::int64_t start = plan_.burst.start_frame, ramp = plan_.burst.ramp.frames;
  if (plan.first_frame != start + ramp || plan.origin_frame != start) return;
  if (plan.end_frame < start + ramp / 2 + shape_.window_frames) return;
  const std::int64_t half = shape_.window_frames / 2;
  onset_.half_frame = static_cast<double>(start) + (static_cast<double>(ramp) - 1) / 2 +
                      planned_delay_frames(stretches_.front().lines);
  watch_ramp(onset_, begin_ - frames_of(kBefore_s) - half,
             std::min(begin_ + ramp + frames_of(kAfter_s) + half, end_ - ramp));
}

// The same for the ramp at the end of the burst, which the last tones must precede for as long.
void IntervalProof::State::add_offset() {
  offset_.planned = false;
  if (unplanned_ || cut_ || stretches_.empty()) return;
  const auto& plan = stretches_.back().plan;
  const std::int64_t end = plan_.burst.start_frame + plan_.burst.length_frames,
                     ramp = plan_.burst.ramp.frames;
  const std::int64_t first =
      std::max(plan.first_frame + frames_of(kSettle_s), plan_.burst.start_frame + ramp);
  if (plan.tones.empty() || plan.end_frame != end - ramp || plan.end_frame < first + shape_.window_frames)
    return;
  offset_.stretch = stretches_.size() - 1;
  offset_.half_frame = static_cast<double>(end - ramp) + (static_cast<double>(ramp) - 1) / 2 +
                       planned_delay_frames(stretches_.back().lines);
  const std::int64_t earliest = std::max(first + static_cast<std::int64_t>(plan_.delay_frames),
                                         end_ - ramp - frames_of(kAfter_s) - shape_.window_frames / 2);
  watch_ramp(offset_, earliest + shape_.block_frames, end_ + frames_of(kFallen_s) + shape_.window_frames / 2);
}

// Windows that extend beyond the end of the burst do not count, even if they are already filled. A window
// that is not filled yet may end earlier.
void IntervalProof::State::end_at(std::int64_t playback_frame) noexcept {
  const auto end =
      static_cast<std::int64_t>(std::floor(static_cast<double>(playback_frame) + plan_.delay_frames));
  if (end >= end_) return;
  cut_ = true;
  end_ = std::max(end, begin_);
  offset_.planned = false;
  end_windows_at(end_ / shape_.block_frames * shape_.block_frames);
  for (GlideProof& glide : glides_) glide.end_at(end_);
}

void IntervalProof::State::take(const AlignedBlock& block) {
  const std::int64_t end = block.first_frame + block.frames;
  next_ = end;
  if (end > begin_ && block.first_frame < end_ && !block.lost) {
    good_[static_cast<std::size_t>(block.first_frame / block.frames - begin_ / block.frames)] = 1;
    result_.largest_sample = std::max(result_.largest_sample, block.largest);
  }
  while (current_glide_ < glides_.size() && glides_[current_glide_].end_frame() <= block.first_frame)
    ++current_glide_;
  for (std::size_t g = current_glide_; g < std::min(current_glide_ + 2, glides_.size()); ++g)
    glides_[g].take(block);  // two glides may meet in a block
  const auto watches = [&](const RampWatch& watch) {
    return watch.planned && block.first_frame >= watch.first && end <= watch.end;
  };
  const bool onset = watches(onset_), offset = watches(offset_) && !(onset && offset_.stretch != 0);
  while (current_ < windows_.size() && windows_[current_].end <= block.first_frame) {
    ++current_;
    summed_ = 0;
  }
  Window* window = current_ < windows_.size() && windows_[current_].first <= block.first_frame
                       ? &windows_[current_]
                       : nullptr;
  if (!onset && !offset && window == nullptr) return;
  const std::size_t stretch = window != nullptr ? window->stretch : offset ? offset_.stretch : 0;
  ToneSums& sums = *stretches_[stretch].sums;
  const bool rises = onset && stretch == 0, falls = offset && stretch == offset_.stretch;
  sums.compute(block, rises || falls ? ToneSums::Parts::windowed : ToneSums::Parts::plain);
  if (window != nullptr) accumulate(block, *window, sums);
  if (rises) follow(onset_, block, sums);
  if (falls) follow(offset_, block, sums);
}

void IntervalProof::State::follow(RampWatch& watch, const AlignedBlock& block,
                                  const ToneSums& sums) noexcept {
  if (!watch.hann->take(block, sums)) return;
  if (watch.points.empty()) watch.first_point = watch.hann->centre();
  const std::size_t lines = sums.tones();
  for (std::size_t l = 0; l < lines && watch.points.size() < watch.points.capacity(); ++l)
    watch.points.push_back(watch.hann->values()[main_ * lines + l]);
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
  std::copy_n(block.row[main_], block.frames, raw_.begin() + summed_);
  summed_ += block.frames;
  if (window.first + summed_ == window.end) finish(window, sums);
}

void IntervalProof::State::finish(Window& window, const ToneSums& sums) noexcept {
  const std::size_t lines = sums.tones();
  for (std::size_t l = 0; l < lines; ++l) {
    phases_[l] = window.phase[l] = sums.phase_at(l, window.first);
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
  if (worst_ && windows_[*worst_].residual[main_] >= window.residual[main_]) return;
  worst_ = static_cast<std::size_t>(&window - windows_.data());
  raw_.swap(worst_raw_);
  fit_subtracted_ = false;
}

IntervalProof::IntervalProof(const IntervalPlan& plan) : state_(new State(plan)) {}
IntervalProof::~IntervalProof() = default;
IntervalProof::IntervalProof(IntervalProof&&) noexcept = default;
IntervalProof& IntervalProof::operator=(IntervalProof&&) noexcept = default;

std::int64_t IntervalProof::first_frame() const noexcept {
  return state_->begin_ - state_->frames_of(kBefore_s + 0.005) - state_->shape_.block_frames - 2;
}

std::int64_t IntervalProof::end_frame() const noexcept {
  return state_->needed_until() + state_->shape_.block_frames + high_pass_step(state_->plan_.rate_Hz);
}

void IntervalProof::push(const CaptureBlock& block) {
  const std::int64_t end = block.first_frame + block.frames();
  if (end <= first_frame() || complete()) return;
  state_->blocks_.push(block, [this](const AlignedBlock& aligned) { state_->take(aligned); });
}

void IntervalProof::stopped(std::int64_t frame) noexcept { state_->end_at(frame); }

void IntervalProof::changed(const audio::Change& change, const audio::Format& format) {
  state_->change(change, format);
}

bool IntervalProof::complete() const noexcept { return state_->next_ >= state_->needed_until(); }

const IntervalResult& IntervalProof::result(std::optional<bool> in_contact) {
  if (state_->plan_.burst.following.follows()) return state_->result_ = {};
  state_->conclude(in_contact);
  return state_->result_;
}

using core::Proof;
using core::ProofCause;

namespace {

constexpr double kLowest_Hz = 5000;    // distortion products below this frequency are ignored
constexpr double kApart_Hz = 20;       // distortion products closer than this to a tone are ignored
constexpr double kUnseenNoise = 0.05;  // a tone with a larger relative standard error is not judged
constexpr double kVibrates_dB = -10;   // the onset is not measured if the level relative to the plan is lower

}  // namespace

void IntervalProof::State::measure_tones() {
  double measured = 0, planned = 0;
  for (std::size_t s = 0; s < stretches_.size(); ++s) {
    const bool played = std::any_of(windows_.begin(), windows_.end(),
                                    [s](const Window& window) { return window.stretch == s; });
    if (cut_ && s > 0 && !played) continue;  // a stop came before this stretch, or just after it had begun
    for (std::size_t l = 0; l < stretches_[s].lines.size(); ++l) {
      const PlannedLine& line = stretches_[s].lines[l];
      measure_tone(s, line, l);
      const ToneProof& last = result_.tones.back();
      if (!last.seen) continue;
      double amplitude = 0;
      for (const PlayedTone& tone : line.tones) amplitude += tone.partial.amplitude;
      planned += amplitude * amplitude;
      measured += amplitude * amplitude * std::pow(10, last.ratio_dB / 10);
    }
  }
  result_.ratio_dB = planned > 0 ? in_dB(std::sqrt(measured / planned)) : 0;
  vibrates_ = planned > 0 && result_.ratio_dB > kVibrates_dB;
}

// Adds a ToneProof for each tone of the line (all tones of one frequency). The figures are from the pick-up
// that responds best to this line.
void IntervalProof::State::measure_tone(std::size_t stretch, const PlannedLine& line, std::size_t place) {
  ToneProof made;
  made.stretch = stretches_[stretch].plan.changes;
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
  for (const PlayedTone& tone : line.tones) {
    made.tone = tone.index;
    made.drive_channel = tone.partial.channel;
    result_.tones.push_back(made);
  }
}

void IntervalProof::State::measure_residual() {
  result_.residual_dB = result_.brief_dB = kNothing_dB;
  for (const Window& window : windows_) {
    const double planned = planned_power(stretches_[window.stretch].lines, main_);
    if (!window.valid || !(planned > 0)) continue;
    result_.residual_dB = std::max(result_.residual_dB, in_dB(std::sqrt(window.residual[main_] / planned)));
  }
  if (result_.residual_dB < plan_.limits.residual_dB.flag - 20) return;
  measure_products();
  measure_brief();
}

// A click is short: it hardly changes the rms of 0.2 s.
void IntervalProof::State::measure_brief() {
  const auto rest = unexplained();
  const double planned = rest.empty() ? 0 : planned_power(stretches_[windows_[*worst_].stretch].lines, main_);
  if (!(planned > 0)) return;
  const auto block = static_cast<std::size_t>(shape_.block_frames);
  for (std::size_t at = 0; at + block <= rest.size(); at += block) {
    double energy = 0;
    for (const double sample : rest.subspan(at, block)) energy += sample * sample;
    result_.brief_dB =
        std::max(result_.brief_dB, in_dB(std::sqrt(energy / static_cast<double>(block) / planned)));
  }
}

// Looks for the strongest distortion product of the tones (harmonic, combination, ...) in the window with the
// largest residual.
void IntervalProof::State::measure_products() {
  const auto rest = unexplained();
  if (rest.empty()) return;
  double planned = 0;
  std::vector<double> frequencies;
  for (const PlannedLine& line : stretches_[windows_[*worst_].stretch].lines) {
    planned += std::norm(line.expected[main_]) / 2;
    frequencies.push_back(line.frequency_Hz);
  }
  const int step = high_pass_step(plan_.rate_Hz);
  for (Product& product : products_of(frequencies, plan_.rate_Hz, kLowest_Hz, kApart_Hz)) {
    const double amplitude = amplitude_at(rest, product.frequency_Hz, plan_.rate_Hz) /
                             high_pass_gain(product.frequency_Hz, plan_.rate_Hz, step);
    product.level_dB = in_dB(amplitude / std::sqrt(2 * planned));
    if (!result_.product || product.level_dB > result_.product->level_dB) result_.product = product;
  }
}

// Returns the samples of the window with the largest residual, minus the fitted tones; empty if that window
// is not valid.
std::span<const double> IntervalProof::State::unexplained() {
  if (!worst_ || !windows_[*worst_].valid) return {};
  const Window& window = windows_[*worst_];
  const std::span<double> rest{worst_raw_.data(), static_cast<std::size_t>(window.end - window.first)};
  if (fit_subtracted_) return rest;
  fit_subtracted_ = true;
  const auto& lines = stretches_[window.stretch].lines;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const auto a = window.amplitude[main_ * lines.size() + l] * lines[l].gain;
    std::uint64_t phase = window.phase[l] + audio::phase_of_angle(std::arg(a));
    const double size = std::abs(a);
    for (double& sample : rest) {
      sample -= size * audio::sine_of_phase(phase);
      phase += lines[l].tones.front().partial.increment;
    }
  }
  return rest;
}

// Time at which the captured envelope passes half its level on the ramp, measured minus planned.
std::optional<double> IntervalProof::State::ramp_error_us(const RampWatch& watch, bool rising) const {
  const auto steady = std::find_if(windows_.begin(), windows_.end(),
                                   [&](const Window& w) { return w.valid && w.stretch == watch.stretch; });
  if (!watch.planned || !vibrates_ || steady == windows_.end()) return std::nullopt;
  const auto& lines = stretches_[watch.stretch].lines;
  const std::size_t count = lines.size();
  double power = 0;
  for (std::size_t l = 0; l < count; ++l)
    power += std::norm(steady->amplitude[main_ * count + l] * lines[l].gain);
  std::vector<double> envelope;
  for (std::size_t k = 0; k + count <= watch.points.size(); k += count) {
    double level = 0;
    for (std::size_t l = 0; l < count; ++l) {
      const auto wave = steady->amplitude[main_ * count + l] * lines[l].gain;
      level += (std::conj(wave) * watch.points[k + l]).real();
    }
    envelope.push_back(level / power);
  }
  if (!rising) std::reverse(envelope.begin(), envelope.end());
  const auto at = half_level(envelope);
  if (!at) return std::nullopt;
  const double place = rising ? *at : static_cast<double>(envelope.size() - 1) - *at;
  const double frame = static_cast<double>(watch.first_point) + place * shape_.block_frames;
  return (frame - watch.half_frame) / plan_.rate_Hz * 1e6;
}

void IntervalProof::State::find_lost() {
  const std::int64_t block = shape_.block_frames;
  const auto good = std::count(good_.begin(), good_.begin() + ((end_ - 1) / block - begin_ / block + 1), 1);
  result_.lost_frames = ((end_ - 1) / block - begin_ / block + 1 - good) * block;
  if (result_.lost_frames > 0) findings_.push_back({ProofCause::gap, Proof::lost});
}

// If a planned tone is missing, looks for a vibration within 8 % of its frequency. Returns the frequency of
// that vibration.
std::optional<double> IntervalProof::State::found_elsewhere(const ToneProof& tone) {
  if (result_.residual_dB < plan_.limits.residual_dB.stop - 20) return std::nullopt;
  const auto rest = unexplained();
  if (rest.empty() || stretches_[windows_[*worst_].stretch].plan.changes != tone.stretch) return std::nullopt;
  double planned = 0;
  for (const PlannedLine& line : stretches_[windows_[*worst_].stretch].lines)
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
  for (int channel = 0; channel < audio::max_channels; ++channel) {
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

void IntervalProof::State::judge_glides(const Limits& level) {
  result_.glides.clear();
  for (const GlideProof& glide : glides_) {
    if (glide.failed()) findings_.push_back({ProofCause::none, Proof::unproven});
    for (const GlideToneProof& tone : glide.result(plan_.limits.unseen_dB)) {
      result_.glides.push_back(tone);
      if (!tone.seen) continue;
      findings_.push_back({ProofCause::level, judged(std::fabs(tone.worst_ratio_dB), level)});
      if (tone.worst_ratio_dB > plan_.limits.dead_dB)
        findings_.push_back(
            {ProofCause::phase, judged(std::fabs(tone.phase_error_deg), plan_.limits.phase_deg)});
    }
  }
}

void IntervalProof::State::judge_rest() {
  const ProofLimits& limits = plan_.limits;
  const double product = result_.product ? result_.product->level_dB : kNothing_dB;
  const Proof residual = judged(std::max(result_.residual_dB, product), limits.residual_dB);
  findings_.push_back({ProofCause::residual, residual});
  findings_.push_back({ProofCause::residual, judged(result_.brief_dB, brief_limits(limits))});
  if (result_.largest_sample >= limits.clipped) findings_.push_back({ProofCause::clipped, Proof::refused});
  // Clipping makes odd distortion products and reduces the level of the tones.
  if (product >= limits.residual_dB.flag && is_odd(result_.product->kind) && result_.ratio_dB < -0.1)
    findings_.push_back({ProofCause::clipped, residual});
  if (result_.onset_error_us)
    findings_.push_back({ProofCause::late, judged(std::fabs(*result_.onset_error_us), limits.onset_us)});
  else if (onset_.planned && vibrates_ && result_.lost_frames == 0 && !onset_.points.empty())
    findings_.push_back({ProofCause::late, Proof::refused});
  else
    findings_.push_back({ProofCause::none, Proof::unproven});
  if (result_.offset_error_us)
    findings_.push_back({ProofCause::offset, judged(std::fabs(*result_.offset_error_us), limits.onset_us)});
  else if (offset_.planned && vibrates_ && result_.lost_frames == 0 && !offset_.points.empty())
    findings_.push_back({ProofCause::offset, Proof::flagged});
  if (windows_.empty() || unplanned_) findings_.push_back({ProofCause::none, Proof::unproven});
}

void IntervalProof::State::conclude(std::optional<bool> in_contact) {
  findings_.clear();
  result_.tones.clear();
  result_.product.reset();
  result_.found_Hz.reset();
  measure_tones();
  measure_residual();
  result_.onset_error_us = ramp_error_us(onset_, true);
  result_.offset_error_us = ramp_error_us(offset_, false);
  find_lost();
  const ProofLimits& limits = plan_.limits;
  const Limits& level = in_contact.value_or(true) ? limits.level_in_contact_dB : limits.level_dB;
  judge_tones(level);
  judge_glides(level);
  judge_rest();
  result_.live_changes = live_changes_;
  const Finding all = concluded(findings_);
  result_.verdict = all.verdict;
  result_.cause = all.cause;
}

// The last stretch was expected to last until the end of the burst. It ends here instead, and a glide and
// another stretch follow.
void IntervalProof::State::change(const audio::Change& change, const audio::Format& format) {
  ++live_changes_;
  auto& burst = plan_.burst;
  const std::int64_t frame = burst.start_frame + change.at_frame;
  const std::int64_t falls = burst.start_frame + burst.length_frames - burst.ramp.frames;
  // A change during a glide, or one whose frames have already been received, cannot be measured, and nothing
  // that comes after it can.
  if (unplanned_) return;
  unplanned_ = frame < tones_.origin_frame() || block_at_or_before(frame) < next_;
  if (unplanned_) return end_stretch_at(frame);
  for (Measured& stretch : stretches_)
    if (block_at_or_after(stretch.plan.end_frame) + shape_.window_frames < next_) stretch.sums.reset();
  end_stretch_at(frame);
  const auto prepared = audio::prepare_change(change, burst, format);
  add_glide(tones_.change(prepared), falls);
  const std::int64_t first = std::max(tones_.origin_frame(), burst.start_frame + burst.ramp.frames);
  if (first < falls) add_stretch(tones_.stretch(first, falls));
  size_buffers();
  add_offset();
}

void IntervalProof::State::end_stretch_at(std::int64_t frame) {
  const std::int64_t end = block_at_or_before(frame);
  if (!stretches_.empty()) {
    auto& last = stretches_.back().plan.end_frame;
    last = std::min(last, frame);
  }
  end_windows_at(end);
  for (GlideProof& glide : glides_) glide.end_at(end);
  offset_.planned = false;
  if (!onset_.planned || onset_.end <= end) return;
  onset_.end = end;
  // The lock-in must pass the whole ramp before the tones change.
  const std::int64_t needed = plan_.burst.start_frame + plan_.burst.ramp.frames + shape_.window_frames;
  onset_.planned = frame >= needed;
}

// Drops the windows that extend beyond this captured frame, the first of a block. A window is shortened
// instead if some of its frames until then are still to come.
void IntervalProof::State::end_windows_at(std::int64_t end) noexcept {
  while (!windows_.empty() && windows_.back().end > end) {
    Window& window = windows_.back();
    if (next_ < end && static_cast<double>(end - window.first) >= kShortest_s * plan_.rate_Hz) {
      window.end = end;
      break;
    }
    windows_.pop_back();
  }
  if (worst_ && *worst_ >= windows_.size()) worst_.reset();
}

}  // namespace turnpoint::sensing
