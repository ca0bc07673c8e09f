#include "station/follow/record.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace turnpoint::follow {
namespace {

constexpr double kFirstLag_s = -0.01, kLastLag_s = 0.03;
constexpr double kLeastVariation = 0.05;
constexpr std::size_t kFewest = 100;  // felt values, for a lag

/// What was asked and commanded over time, at the middles of the periods.
class Course {
 public:
  Course(std::span<const Recorded> periods, int period_frames) : periods_(periods), period_(period_frames) {}

  /// The two periods around a frame and the way between their middles; empty unless both follow the finger.
  struct Between {
    const Update *before, *after;
    double along;
  };
  std::optional<Between> at(double frame) const {
    const double middle = frame - 0.5 * period_;
    const auto after = std::upper_bound(
        periods_.begin(), periods_.end(), middle,
        [](double value, const Recorded& one) { return value < static_cast<double>(one.frame); });
    if (after == periods_.begin() || after == periods_.end()) return std::nullopt;
    const Recorded &a = *(after - 1), &b = *after;
    if (b.frame - a.frame != period_ || !follows(a.update) || !follows(b.update)) return std::nullopt;
    return Between{&a.update, &b.update, (middle - static_cast<double>(a.frame)) / period_};
  }

  static bool follows(const Update& update) { return update.fault == Fault::none && update.following >= 1; }

 private:
  std::span<const Recorded> periods_;
  int period_;
};

double asked(const Course::Between& at) {
  return at.before->asked + at.along * (at.after->asked - at.before->asked);
}
double modelled(const Course::Between& at) {
  return at.before->modelled + at.along * (at.after->modelled - at.before->modelled);
}

struct Felt {
  double frame, friction;
};

/// Correlation of what was felt with what was asked `lag` frames before; empty if too few values have both.
std::optional<double> correlation(std::span<const Felt> felt, const Course& course, double lag) {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (const Felt& one : felt) {
    const auto at = course.at(one.frame - lag);
    if (!at) continue;
    const double a = asked(*at), f = one.friction;
    n += 1, x += a, y += f, xx += a * a, yy += f * f, xy += a * f;
  }
  if (n < kFewest) return std::nullopt;
  const double a = xx / n - x / n * x / n, f = yy / n - y / n * y / n;
  if (!(std::sqrt(std::max(a, 0.0)) >= kLeastVariation * x / n) || !(f > 0)) return std::nullopt;
  return (xy / n - x / n * y / n) / std::sqrt(a * f);
}

std::optional<double> lag_frames(std::span<const Felt> felt, const Course& course, const Timing& timing) {
  const auto periods = [&](double seconds) {
    return static_cast<int>(std::lround(seconds * timing.rate_Hz / timing.period_frames));
  };
  const int first = periods(kFirstLag_s), last = periods(kLastLag_s);
  std::vector<std::optional<double>> found;
  for (int k = first; k <= last; ++k) found.push_back(correlation(felt, course, k * timing.period_frames));
  // A texture repeats, and so does the correlation: the maximum that is reached from no lag is the right one.
  auto best = static_cast<std::size_t>(-first);
  const auto higher = [&](std::size_t k) {
    return k < found.size() && found[k] && found[best] && *found[k] > *found[best];
  };
  const bool later = higher(best + 1);
  while (later ? higher(best + 1) : best > 0 && higher(best - 1)) best = later ? best + 1 : best - 1;
  if (!found[best] || best == 0 || best + 1 == found.size() || !found[best - 1] || !found[best + 1])
    return std::nullopt;
  const double before = *found[best - 1], here = *found[best], after = *found[best + 1];
  const double bend = before - 2 * here + after;
  const double part = bend < 0 ? 0.5 * (before - after) / bend : 0;
  return (first + static_cast<double>(best) + part) * timing.period_frames;
}

}  // namespace

Summary summarise(std::span<const Recorded> periods, const Plan& plan, std::int64_t first_frame,
                  std::int64_t end_frame) {
  const Course course(periods, plan.timing.period_frames);
  const bool friction = plan.pattern.asked == Asked::friction;
  std::vector<Felt> felt;
  double sum_asked = 0, sum_modelled = 0, sum_felt = 0;
  std::vector<std::pair<double, double>> pairs;  // asked and felt
  const Recorded* before = nullptr;
  std::int64_t followed = 0;  // periods within the interval
  for (const Recorded& one : periods) {
    if (one.frame >= first_frame && one.frame + plan.timing.period_frames <= end_frame &&
        Course::follows(one.update))
      ++followed;
    const bool again = before != nullptr && before->sample_frame == one.sample_frame;
    before = &one;
    // The cells say later what the finger feels.
    const double frame = static_cast<double>(one.sample_frame) - plan.timing.cells_s * plan.timing.rate_Hz;
    if (again || !std::isfinite(one.update.felt) || frame < static_cast<double>(first_frame) ||
        frame >= static_cast<double>(end_frame))
      continue;
    const auto at = course.at(frame);
    if (!at) continue;
    felt.push_back({frame, one.update.felt});
    sum_asked += asked(*at), sum_modelled += modelled(*at), sum_felt += one.update.felt;
    pairs.emplace_back(asked(*at), one.update.felt);
  }
  Summary summary;
  const auto length = static_cast<double>(end_frame - first_frame);
  if (length > 0) summary.share = static_cast<double>(followed * plan.timing.period_frames) / length;
  if (felt.empty()) return summary;
  const auto n = static_cast<double>(felt.size());
  summary.felt = sum_felt / n;
  if (plan.resting_known || friction) summary.commanded = sum_modelled / n;
  if (!friction) return summary;
  const double scale = plan.resting_known || sum_modelled <= 0 ? 1 : sum_felt / sum_modelled;
  *summary.commanded *= scale;
  summary.asked = scale * sum_asked / n;
  const auto is_inside = [scale](const auto& pair) {
    return std::abs(pair.second - scale * pair.first) < kTolerance * scale * pair.first;
  };
  summary.inside = static_cast<double>(std::ranges::count_if(pairs, is_inside)) / n;
  if (const auto lag = lag_frames(felt, course, plan.timing)) summary.lag_s = *lag / plan.timing.rate_Hz;
  return summary;
}

std::string fault_names(std::span<const Recorded> periods, bool late) {
  const auto bit = [](Fault fault) { return 1u << static_cast<unsigned>(fault); };
  std::uint32_t faults = late ? bit(Fault::late) : 0;
  for (const Recorded& one : periods)
    faults |= one.update.interrupted |
              (one.update.seen & (bit(Fault::late) | bit(Fault::reference) | bit(Fault::force)));
  std::string text;
  for (int k = 1; k < kFaults; ++k)
    if (faults >> k & 1u) text += (text.empty() ? "" : " ") + std::string(name(static_cast<Fault>(k)));
  return text.empty() ? "ok" : text;
}

}  // namespace turnpoint::follow
