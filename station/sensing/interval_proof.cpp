#include "station/sensing/interval_proof.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "station/sensing/interval_state.hpp"

namespace turnpoint::sensing {

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
      tones_(plan.burst, plan.rate_Hz),
      fit_(drive::max_tones) {
  begin_ =
      static_cast<std::int64_t>(std::floor(static_cast<double>(plan.burst.start_frame) + plan.delay_frames));
  end_ = begin_ + 1 + plan.burst.length_frames;
  next_ = std::numeric_limits<std::int64_t>::min();
  good_.resize(static_cast<std::size_t>((end_ - 1) / shape_.block_frames - begin_ / shape_.block_frames + 1));
  add_parts();
  if (!stretches_.empty()) main_ = main_pick_up(stretches_.front().lines, pick_ups());
  add_onset();
  add_offset();
  products_.resize(pick_ups() * drive::max_tones);
  energy_.resize(pick_ups());
  phases_.resize(drive::max_tones);
  increments_.resize(drive::max_tones);
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
  const drive::PreparedBurst& burst = plan_.burst;
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
    followed.push_back({{line.phase, line.increment, 0, 0, 0}, plan.origin_frame});
  made.sums = std::make_unique<ToneSums>(followed, pick_ups(), shape_.block_frames, shape_.window_frames,
                                         plan_.delay_frames);
  made.plan = std::move(plan);
  stretches_.push_back(std::move(made));
  add_windows(stretches_.size() - 1);
}

// Measures a glide until the plate has settled, if the burst does not change again before. What lies in the
// ramps of the burst is left out.
void IntervalProof::State::add_glide(const Glide& glide, std::int64_t end_frame) {
  const drive::PreparedBurst& burst = plan_.burst;
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
    for (const PlannedTone& tone : line.tones) {
      const double weight = std::norm(line.expected[main_] * line.gain);
      delay_s += weight * group_delay_s(plan_.pick_ups[main_], tone.channel, tone.frequency_Hz);
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
  const std::int64_t end = plan_.burst.start_frame + plan_.burst.length_frames, ramp = plan_.burst.ramp.frames;
  const std::int64_t first = std::max(plan.first_frame + frames_of(kSettle_s), plan_.burst.start_frame + ramp);
  if (plan.tones.empty() || plan.end_frame != end - ramp || plan.end_frame < first + shape_.window_frames) return;
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

void IntervalProof::State::follow(RampWatch& watch, const AlignedBlock& block, const ToneSums& sums) noexcept {
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

void IntervalProof::changed(const drive::Change& change, const drive::Format& format) {
  state_->change(change, format);
}

bool IntervalProof::complete() const noexcept { return state_->next_ >= state_->needed_until(); }

const IntervalResult& IntervalProof::result(std::optional<bool> in_contact) {
  state_->conclude(in_contact);
  return state_->result_;
}

}  // namespace turnpoint::sensing
