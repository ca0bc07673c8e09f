#include "station/sensing/finger_track.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace turnpoint::sensing {
namespace {

constexpr double release_N = 0.03, half_amplitude_Hz = 20;

}  // namespace

FingerTracker::FingerTracker(Band band) : rate_Hz_(points_per_second(band)) {
  const double sigma_s = std::sqrt(2 * std::numbers::ln2) / (2 * std::numbers::pi * half_amplitude_Hz);
  const int half = static_cast<int>(std::ceil(4 * sigma_s * rate_Hz_));
  double sum = -1;
  for (int k = 0; k <= half; ++k) {
    weights_.push_back(std::exp(-0.5 * std::pow(k / (sigma_s * rate_Hz_), 2)));
    sum += 2 * weights_.back();
  }
  for (double& weight : weights_) weight /= sum;
  ring_.resize(static_cast<std::size_t>(2 * half + 1));
  points_for_contact_ = std::lround(contact_s * rate_Hz_);
}

FingerTracker::Entry& FingerTracker::at(std::int64_t ago) {
  return ring_[static_cast<std::size_t>((count_ - 1 - ago) % static_cast<std::int64_t>(ring_.size()))];
}

void FingerTracker::judge_contact() {
  const double normal_N = at(0).point.force.normal_N;
  above_ = normal_N > contact_N ? above_ + 1 : 0;
  at(0).contact = count_ > 1 && at(1).contact && normal_N >= release_N;
  if (at(0).contact || above_ < points_for_contact_) return;
  for (std::int64_t ago = 0; ago < above_; ++ago) at(ago).contact = true;
}

std::optional<FingerPoint> FingerTracker::push(const ForcePoint& point) {
  if (count_ > 0 && point.index != at(0).point.index + 1)
    throw std::logic_error("finger track: a force point was left out");
  ++count_;
  at(0) = {point, false};
  judge_contact();
  if (count_ < static_cast<std::int64_t>(ring_.size())) return std::nullopt;

  const auto half = static_cast<std::int64_t>(weights_.size()) - 1;
  const Entry& middle = at(half);
  FingerPoint finger{middle.point.index, middle.point.force.normal_N, middle.point.force.lateral_N};
  finger.contact = middle.contact;
  finger.position_mm = finger.speed_mm_s = std::numeric_limits<double>::quiet_NaN();
  double normal = 0;
  bool contact = true;  // true if the finger is in contact at all points of the window
  // Sums over the window, for fitting a line by weighted least squares: the sums of w N^2 t^i and of w N M
  // t^i, with weight w, normal force N, moment M and time t.
  double square = 0, square_t = 0, square_tt = 0, product = 0, product_t = 0;
  for (std::int64_t k = -half; k <= half; ++k) {
    const Force& force = at(half - k).point.force;
    contact = contact && at(half - k).contact;
    const double weight = weights_[static_cast<std::size_t>(std::abs(k))], t = static_cast<double>(k);
    const double w = weight * force.normal_N, nn = w * force.normal_N, nm = w * force.moment_Nmm;
    normal += w;
    square += nn, square_t += nn * t, square_tt += nn * t * t;
    product += nm, product_t += nm * t;
  }
  if (!contact || !(normal >= least_normal_N)) return finger;
  const double determinant = square * square_tt - square_t * square_t;
  finger.position_mm = (square_tt * product - square_t * product_t) / determinant;
  finger.speed_mm_s = rate_Hz_ * (square * product_t - square_t * product) / determinant;
  return finger;
}

std::vector<FingerPoint> finger_track(const std::vector<ForcePoint>& forces, Band band) {
  FingerTracker tracker(band);
  std::vector<FingerPoint> track;
  for (const auto& point : forces)
    if (const auto finger = tracker.push(point)) track.push_back(*finger);
  return track;
}

namespace {

constexpr double slowest_mm_s = 10, shortest_mm = 30, end_mm = 5;

int direction_of(const FingerPoint& point) {
  if (!(std::abs(point.speed_mm_s) > slowest_mm_s)) return 0;
  return point.speed_mm_s > 0 ? 1 : -1;
}

}  // namespace

std::vector<Stroke> find_strokes(std::span<const FingerPoint> track) {
  std::vector<Stroke> all;
  for (std::size_t first = 0, end = 0; first < track.size(); first = end) {
    const int direction = direction_of(track[first]);
    for (end = first + 1; end < track.size() && direction_of(track[end]) == direction;) ++end;
    const double from_mm = track[first].position_mm, to_mm = track[end - 1].position_mm;
    if (direction == 0 || !(std::abs(to_mm - from_mm) >= shortest_mm)) continue;
    Stroke stroke{first, end, direction};
    while (std::abs(track[stroke.first].position_mm - from_mm) < end_mm) ++stroke.first;
    while (std::abs(track[stroke.end - 1].position_mm - to_mm) < end_mm) --stroke.end;
    all.push_back(stroke);
  }
  return all;
}

}  // namespace turnpoint::sensing
