#include "station/audio/gain_line.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::audio {

void GainLine::begin(const Following& following) noexcept {
  following_ = following;
  first_ = count_ = 0;
  before_ = newest_ = gain_ = leave_gain_ = following.resting_gain;
  end_frame_ = since_frame_ = steady_ = 0;
  begun_ = false;
  state_ = State::following;
  news_ = {};
}

void GainLine::push(const GainPeriod& period) noexcept {
  if (count_ == kWaiting || period.frames < gains_per_period || period.frames % gains_per_period != 0) return;
  if (begun_ && period.frame < end_frame_) return;
  for (const float gain : period.gain)
    if (!std::isfinite(gain)) return;
  GainPeriod& kept = waiting_[(first_ + count_) % kWaiting];
  kept = period;
  if (count_++ == 0) {
    // After a hole, nobody knows what the gain was at the first frame; the resting gain has taken over.
    const bool continues = begun_ && period.frame == end_frame_;
    before_ = continues ? newest_ : begun_ ? static_cast<double>(kept.gain.front()) : following_.resting_gain;
  }
  begun_ = true;
  end_frame_ = period.frame + period.frames;
  newest_ = static_cast<double>(kept.gain.back());
}

// Gives the gain of the line at a frame. Returns false if it has not come.
bool GainLine::line_at(std::int64_t frame, double& gain) noexcept {
  while (count_ > 0 && frame >= waiting_[first_].frame + waiting_[first_].frames) {
    const GainPeriod& over = waiting_[first_];
    const std::size_t next = (first_ + 1) % kWaiting;
    const bool continues = count_ > 1 && waiting_[next].frame == over.frame + over.frames;
    before_ = continues || count_ == 1 ? static_cast<double>(over.gain.back())
                                       : static_cast<double>(waiting_[next].gain.front());
    first_ = next;
    --count_;
  }
  if (count_ == 0 || frame < waiting_[first_].frame) return false;
  const GainPeriod& period = waiting_[first_];
  const std::int64_t each = period.frames / gains_per_period, since = frame - period.frame;
  const auto k = static_cast<std::size_t>(since / each);
  const double from = k == 0 ? before_ : static_cast<double>(period.gain[k - 1]);
  const double along = static_cast<double>(since % each) / static_cast<double>(each);
  gain = from + (static_cast<double>(period.gain[k]) - from) * along;
  return true;
}

double GainLine::step(std::int64_t frame) noexcept {
  double line = 0;
  const bool there = line_at(frame, line);
  steady_ = there ? steady_ + 1 : 0;
  const double rest = following_.resting_gain;
  const auto enter = [&](State state) { state_ = state, since_frame_ = frame; };
  if (!there && (state_ == State::following || state_ == State::resuming)) {
    leave_gain_ = gain_;
    enter(State::leaving);
    news_.lost = frame;
  }
  if (state_ == State::resting && steady_ > following_.steady_frames) enter(State::resuming);
  const auto share = [&](std::int64_t frames) {
    return std::min(1.0, static_cast<double>(frame - since_frame_ + 1) / static_cast<double>(frames));
  };
  switch (state_) {
    case State::following:
      return line;
    case State::leaving: {
      const double left = 1 - share(following_.leave_frames);
      if (left <= 0) enter(State::resting);
      return rest + left * (leave_gain_ - rest);
    }
    case State::resting:
      return rest;
    case State::resuming: {
      const double back = share(following_.resume_frames);
      if (back >= 1) enter(State::following), news_.back = frame + 1;
      return rest + back * (line - rest);
    }
  }
  return rest;
}

void GainLine::fill(std::int64_t at, int count, double* gain) noexcept {
  for (int n = 0; n < count; ++n) gain[n] = gain_ = std::clamp(step(at + n), 0.0, following_.most_gain);
}

}  // namespace turnpoint::audio
