#include "station/sensing/trial_finger.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "station/analysis/quantile.hpp"

namespace turnpoint::sensing {

TrialSummary summarise(std::span<const FingerPoint> track, Band band, std::span<const Stroke> strokes,
                       const MovementWindow& window) {
  TrialSummary summary;
  const auto contacts = std::ranges::count_if(track, [](const FingerPoint& point) { return point.contact; });
  summary.contact_s = static_cast<double>(contacts) / points_per_second(band);
  summary.strokes = static_cast<int>(strokes.size());

  std::vector<double> normal_N, speed_mm_s;
  for (const Stroke& stroke : strokes)
    for (const auto& point : track.subspan(stroke.first, stroke.end - stroke.first)) {
      normal_N.push_back(point.normal_N);
      speed_mm_s.push_back(std::abs(point.speed_mm_s));
    }
  if (normal_N.size() > 1) {
    const auto share = [](const std::vector<double>& values, double least, double most) {
      if (most == MovementWindow::any) return TrialSummary::none;
      const auto inside =
          std::ranges::count_if(values, [&](double value) { return value >= least && value <= most; });
      return static_cast<double>(inside) / static_cast<double>(values.size());
    };
    summary.normal_N = analysis::mean(normal_N);
    summary.normal_sd_N = std::sqrt(analysis::variance(normal_N));
    summary.normal_in_window = share(normal_N, window.least_normal_N, window.most_normal_N);
    summary.speed_mm_s = analysis::mean(speed_mm_s);
    summary.speed_in_window = share(speed_mm_s, window.least_speed_mm_s, window.most_speed_mm_s);
  }
  return summary;
}

Movement judge(const TrialSummary& summary, const MovementWindow& window) {
  if (summary.strokes < window.strokes) return Movement::strokes;
  // the comparisons below are false for NaN, which means "not asked for" or "no stroke"
  if (summary.normal_in_window < window.fraction) {
    const double middle_N = (window.least_normal_N + window.most_normal_N) / 2;
    return summary.normal_N < middle_N ? Movement::light : Movement::hard;
  }
  if (summary.speed_in_window < window.fraction) {
    const double middle_mm_s = (window.least_speed_mm_s + window.most_speed_mm_s) / 2;
    return summary.speed_mm_s < middle_mm_s ? Movement::slow : Movement::fast;
  }
  return Movement::ok;
}

const char* name(Movement movement) {
  switch (movement) {
    case Movement::ok:
      return "ok";
    case Movement::strokes:
      return "strokes";
    case Movement::light:
      return "light";
    case Movement::hard:
      return "hard";
    case Movement::slow:
      return "slow";
    case Movement::fast:
      return "fast";
  }
  return "";
}

namespace {

constexpr double filter_s = 0.02;   // a force point needs captured frames up to this far before and after it
constexpr double tracker_s = 0.04;  // position and speed need force points up to this far before and after
constexpr double now_s = 0.1;       // time over which now() averages
constexpr double idle_s = 1;  // while no trial is expected, only the newest capture of this length is kept
// longest capture that is kept; in a longer trial, its beginning is lost
constexpr double longest_s = 1200;

static_assert(TrialFinger::tail_s >= filter_s + tracker_s);

}  // namespace

const char* name(ForcesState state) {
  switch (state) {
    case ForcesState::ok:
      return "ok";
    case ForcesState::lost:
      return "lost";
    case ForcesState::wire:
      return "wire";
    case ForcesState::tare:
      return "tare";
  }
  return "";
}

TrialFinger::TrialFinger(const FingerSetup& setup)
    : setup_(setup),
      demodulator_(setup.bridges),
      frames_per_point_(demodulator_.frames_per_point()),
      points_per_s_(points_per_second(setup.bridges.band)) {}

void TrialFinger::expect(std::int64_t quiet_until, std::vector<Range> intervals) {
  quiet_until_ = quiet_until;
  intervals_ = std::move(intervals);
  tared_ = false;
  tare_moved_N_ = 0;
  keep_from(index_at(quiet_until) - points_in(tare_s + tracker_s));
}

void TrialFinger::cut(std::int64_t frame) {
  std::erase_if(intervals_, [frame](const Range& range) { return range.first_frame >= frame; });
  for (auto& range : intervals_) range.end_frame = std::min(range.end_frame, frame);
}

void TrialFinger::keep_from(std::int64_t index) {
  while (!points_.empty() && points_.front().index < index) points_.pop_front();
}

void TrialFinger::push(const CaptureBlock& block) {
  // If the capture has paused for long, start again instead of filtering frames that do not exist.
  if (block.first_frame > next_frame_ + static_cast<std::int64_t>(idle_s * setup_.bridges.rate_Hz)) {
    demodulator_ = BridgeDemodulator(setup_.bridges);
    points_.clear();
  }
  next_frame_ = std::max(next_frame_, block.first_frame + block.frames());
  demodulator_.push(block, [this](const BridgePoint& point) { points_.push_back(point); });
  if (points_.empty()) return;
  keep_from(points_.back().index - points_in(intervals_.empty() ? idle_s : longest_s));
}

void TrialFinger::push(const BridgePoint& point) {
  if (!points_.empty() && point.index <= points_.back().index) return;
  if (!points_.empty() && point.index > points_.back().index + points_in(idle_s)) points_.clear();
  while (!points_.empty() && points_.back().index + 1 < point.index) {
    BridgePoint lost{.index = points_.back().index + 1};
    lost.ratio.fill(std::numeric_limits<double>::quiet_NaN());
    points_.push_back(lost);
  }
  points_.push_back(point);
  keep_from(point.index - points_in(intervals_.empty() ? idle_s : longest_s));
}

std::optional<Readings> TrialFinger::zero() {
  take_tare();
  return zero_;
}

std::int64_t TrialFinger::known_at() const {
  if (intervals_.empty()) return std::numeric_limits<std::int64_t>::min();
  return intervals_.back().end_frame + static_cast<std::int64_t>(tail_s * setup_.bridges.rate_Hz);
}

/// Returns the state of the forces from the points with indices from `first` to before `end`.
ForcesState TrialFinger::state_of(std::int64_t first, std::int64_t end) const {
  auto next = first;
  for (const auto& point : points_) {
    if (point.index < first || point.index >= end) continue;
    if (point.fault != WireFault::none) return ForcesState::wire;
    if (point.index != next++ || std::isnan(point.ratio[0])) return ForcesState::lost;
  }
  return next == end ? ForcesState::ok : ForcesState::lost;
}

/// Computes the mean and standard deviation of the readings in the points `quiet`.
void TrialFinger::describe(const std::vector<BridgePoint>& quiet) {
  read_.reset(), noise_.reset();
  if (static_cast<std::int64_t>(quiet.size()) < points_in(tare_s) / 2) return;
  Readings mean{}, spread{};
  const auto n = static_cast<double>(quiet.size());
  for (std::size_t k = 0; k < mean.size(); ++k) {
    const double scale = setup_.bridges.full_scale[k];
    for (const auto& point : quiet) mean[k] += point.ratio[k] / scale / n;
    for (const auto& point : quiet) spread[k] += std::pow(point.ratio[k] / scale - mean[k], 2) / (n - 1);
    spread[k] = std::sqrt(spread[k]);
    if (!std::isfinite(spread[k])) return;
  }
  read_ = mean, noise_ = spread;
}

void TrialFinger::take_tare() {
  if (std::exchange(tared_, true)) return;
  const auto end = index_at(quiet_until_) - points_in(filter_s);
  std::vector<BridgePoint> quiet;
  for (const auto& point : points_) {
    if (point.index < end - points_in(tare_s) || point.index >= end) continue;
    // Skip the first points after the capture began, because their filters lack frames. All later points must
    // be complete.
    if (quiet.empty() && std::isnan(point.ratio[0])) continue;
    quiet.push_back(point);
  }
  describe(quiet);
  auto taken = tare(quiet, setup_.bridges.band, setup_.calibration, zero_.value_or(Readings{}));
  loaded_ = zero_ && taken.state == TareState::stopped;
  // Without a usable tare, keep the previous one: a finger that already waits on the surface must not stop
  // the session.
  if (loaded_ || taken.state == TareState::restless || taken.state == TareState::incomplete) return;
  if (zero_) tare_moved_N_ = taken.moved_N;
  zero_ = taken.readings;
}

std::vector<FingerPoint> TrialFinger::track(std::int64_t first, std::int64_t end) const {
  FingerTracker tracker(setup_.bridges.band);
  std::vector<FingerPoint> points;
  for (const auto& point : points_) {
    if (point.index < first - points_in(tracker_s) || point.index >= end + points_in(tracker_s)) continue;
    if (const auto finger = tracker.push(force_point(point, setup_.calibration, *zero_));
        finger && finger->index >= first && finger->index < end)
      points.push_back(*finger);
  }
  return points;
}

std::optional<bool> TrialFinger::contact(std::size_t interval) {
  if (interval >= intervals_.size()) return std::nullopt;
  take_tare();
  const auto first = index_at(intervals_[interval].first_frame),
             end = index_at(intervals_[interval].end_frame);
  if (!zero_ || state_of(first, end) != ForcesState::ok) return std::nullopt;
  std::int64_t above = 0;
  for (const auto& point : points_) {
    if (point.index < first || point.index >= end) continue;
    above = force_point(point, setup_.calibration, *zero_).force.normal_N > contact_N ? above + 1 : 0;
    if (above >= points_in(contact_s)) return true;
  }
  return false;
}

std::optional<FingerNow> TrialFinger::now() {
  if (intervals_.empty() || points_.empty()) return std::nullopt;
  const auto newest = points_.back().index + 1, first = newest - points_in(now_s);
  if (first < index_at(quiet_until_)) return std::nullopt;
  take_tare();
  if (!zero_ || loaded_ || state_of(first, newest) != ForcesState::ok) return std::nullopt;
  // The track ends before the newest point, because the position at a point needs the points after it.
  FingerNow now;
  now.position_mm = std::numeric_limits<double>::quiet_NaN();
  double speed_sum = 0;
  int points = 0, moving = 0;
  for (const auto& point : track(first, newest)) {
    now.normal_N += point.normal_N;
    now.contact = point.contact;
    ++points;
    if (!std::isnan(point.position_mm)) now.position_mm = point.position_mm;
    if (std::isnan(point.speed_mm_s)) continue;
    speed_sum += point.speed_mm_s, ++moving;
  }
  if (points == 0) return std::nullopt;
  now.normal_N /= points;
  now.speed_mm_s = moving > 0 ? speed_sum / moving : std::numeric_limits<double>::quiet_NaN();
  return now;
}

TrialForces TrialFinger::result() {
  TrialForces forces;
  forces.frames_per_point = frames_per_point_;
  if (intervals_.empty()) return forces;
  take_tare();
  const auto begin = index_at(quiet_until_), first = index_at(intervals_.front().first_frame);
  const auto end = index_at(intervals_.back().end_frame);
  forces.state = state_of(first, end);
  const auto faulty = std::ranges::find_if(points_, [&](const BridgePoint& point) {
    return point.index >= first && point.index < end && point.fault != WireFault::none;
  });
  if (faulty != points_.end() && faulty->fault != WireFault::reference) forces.faulty_bridge = faulty->bridge;
  forces.tare_moved_N = tare_moved_N_;
  forces.zero = read_, forces.noise = noise_;
  if ((!zero_ || loaded_) && forces.state != ForcesState::wire) forces.state = ForcesState::tare;
  const auto last = index_at(intervals_.back().first_frame);
  intervals_.clear();
  if (!zero_) return forces;
  forces.track = track(std::min(begin, first), end);
  const auto in_trial = std::span(forces.track)
                            .subspan(static_cast<std::size_t>(
                                std::lower_bound(forces.track.begin(), forces.track.end(), first,
                                                 [](const FingerPoint& point, std::int64_t index) {
                                                   return point.index < index;
                                                 }) -
                                forces.track.begin()));
  const auto strokes = find_strokes(in_trial);
  // The profile uses only the last interval, because scenes differ between intervals.
  std::vector<Stroke> of_last;
  for (const auto& stroke : strokes)
    if (in_trial[stroke.first].index >= last) of_last.push_back(stroke);
  const auto before = forces.track.size() - in_trial.size();
  for (const auto& stroke : of_last)
    forces.strokes.push_back({stroke.first + before, stroke.end + before, stroke.direction});
  Bins bins;
  bins.count = static_cast<std::size_t>(setup_.length_mm / bins.width_mm);
  forces.profile = friction_profile(in_trial, of_last, bins);
  forces.summary = summarise(in_trial, setup_.bridges.band, strokes, setup_.window);
  forces.movement = judge(forces.summary, setup_.window);
  return forces;
}

}  // namespace turnpoint::sensing
