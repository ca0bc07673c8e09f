// Changes that are sent while the burst plays.
#include <algorithm>

#include "station/sensing/interval_state.hpp"

namespace turnpoint::sensing {

// The last stretch was expected to last until the end of the burst. It ends here instead, and a glide and
// another stretch follow.
void IntervalProof::State::change(const drive::Change& change, const drive::Format& format) {
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
  const auto prepared = drive::prepare_change(change, burst, format);
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
