#include "station/analysis/psychometric_posterior.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "station/analysis/posterior_grid.hpp"
#include "station/core/number.hpp"

namespace turnpoint::analysis {

namespace {

/// Steepness (rate) of the function at the two ends of the prior's flat part, multiplied by the range of the
/// levels.
constexpr double kShallow = 1.5, kSteep = 24;
/// The report gets a statement if an estimate lies in the first or last quarter of the prior's range.
constexpr double kOuter = 0.25;
/// Width of the part at either end in which the prior falls to 0: kBeyond is relative to the width of the
/// flat part, kFallingShare to the whole range.
constexpr double kBeyond = 0.25, kFallingShare = kBeyond / (1 + 2 * kBeyond);

void check(const Prior& prior) {
  const auto rises = [](double low, double high) {
    return std::isfinite(low) && std::isfinite(high) && low < high;
  };
  if (!rises(prior.threshold_low, prior.threshold_high) || !rises(prior.slope_low, prior.slope_high) ||
      !(prior.slope_low > 0) || !(prior.falling_share >= 0 && prior.falling_share <= 0.5))
    throw std::invalid_argument("prior: threshold " + core::number(prior.threshold_low) + " to " +
                                core::number(prior.threshold_high) + ", slope " +
                                core::number(prior.slope_low) + " to " + core::number(prior.slope_high) +
                                ", falling over " + core::number(prior.falling_share) +
                                "; low must be below high, a slope above 0, and the share at most 0.5");
}

Cells between(double one, double other) { return {std::min(one, other), std::max(one, other), 1}; }

Box box_of(const FitOptions& options, const Prior& prior) {
  Box box;
  box[at_threshold] = between(axis_position(options.function, options.scale, prior.threshold_low),
                              axis_position(options.function, options.scale, prior.threshold_high));
  box[at_rate] = between(std::log(rate_from_slope(options.function, prior.slope_low)),
                         std::log(rate_from_slope(options.function, prior.slope_high)));
  box[at_lapse] = between(options.lapse_low, options.lapse_high);
  box[at_guess] = between(options.guess_value, options.guess_value);
  if (options.guess == Guess::fitted) box[at_guess] = between(options.guess_low, options.guess_high);
  return box;
}

/// Computes estimates, intervals and statements from the posterior grid of one fit.
class Reading {
 public:
  Reading(PosteriorFit& into, const Prior& prior)
      : result_(into),
        options_(into.fit.options),
        prior_(prior),
        counts_(axis_counts(into.fit.data, options_.function, options_.scale, into.fit.weight)),
        box_(box_of(options_, prior)),
        grid_(options_.function, options_.guess, counts_, box_, prior.falling_share) {
    for (const auto& point : into.fit.data) trials_ += point.trials;
  }

  Psychometric medians() const {
    const auto median = [&](Parameter parameter) { return grid_.marginal(parameter).quantile(0.5); };
    Psychometric parameters{to_level(median(at_threshold)), to_slope(median(at_rate)), median(at_guess),
                            median(at_lapse)};
    if (options_.guess == Guess::tied_to_lapse) parameters.guess = parameters.lapse;
    return parameters;
  }

  void read_parameters() {
    const auto parameters = medians();
    if (grid_.undetermined(at_threshold)) {
      say_undetermined("threshold", "report.threshold", prior_.threshold_low, prior_.threshold_high);
      return;
    }
    result_.fit.parameters = parameters;
    const double u = axis_position(options_.function, options_.scale, parameters.threshold);
    if (u < counts_.lowest() || u > counts_.u.back())
      result_.fit.statements.push_back({"extrapolated", core::phrase("statement.extrapolated")});
  }

  void read_intervals() {
    auto& intervals = result_.intervals;
    if (off_centre(at_threshold)) say_off_centre("threshold", "report.threshold");
    intervals.threshold = interval(at_threshold, [this](double u) { return to_level(u); });
    const bool normal = options_.function == Function::normal;
    const char *const rate = normal ? "spread" : "slope", *const name =
                                                              normal ? "report.spread" : "report.slope";
    if (grid_.undetermined(at_rate)) {
      say_undetermined(rate, name, prior_.slope_low, prior_.slope_high);
    } else {
      intervals.slope = interval(at_rate, [this](double r) { return to_slope(r); });
      if (off_centre(at_rate)) say_off_centre(rate, name);
    }
    const auto itself = [](double share) { return share; };
    if (options_.lapse_low < options_.lapse_high) intervals.lapse = interval(at_lapse, itself);
    if (options_.guess == Guess::fitted) intervals.guess = interval(at_guess, itself);
    if (const auto crossing = grid_.marginal_of_crossing(0.75)) {
      intervals.level_75 = to_level(crossing->quantile(0.5));
      intervals.interval_75 = {central(*crossing, [this](double u) { return to_level(u); }),
                               intervals.threshold->touches_low, intervals.threshold->touches_high};
    }
  }

  void read_band(int points) {
    const double first = counts_.lowest(), last = counts_.u.back(), margin = 0.04 * (last - first);
    if (!(first < last)) return;
    for (int i = 0; i < points; ++i) {
      const double u = first - margin + i * (last - first + 2 * margin) / (points - 1);
      const auto range = central(grid_.marginal_of_probability(u), [](double p) { return p; });
      result_.intervals.band_level.push_back(to_level(u));
      result_.intervals.band_low.push_back(range.low);
      result_.intervals.band_high.push_back(range.high);
    }
  }

 private:
  double to_level(double u) const { return level_from_axis(options_.function, options_.scale, u); }
  double to_slope(double log_rate) const { return slope_from_rate(options_.function, std::exp(log_rate)); }

  /// `name` is the key of the parameter's name.
  void say_undetermined(const std::string& code, const char* name, double low, double high) {
    using core::phrase, core::plain;
    result_.fit.statements.push_back(
        {code + "-undetermined",
         phrase("statement.undetermined",
                {plain(trials_), phrase(name), plain(core::number(low, 3)), plain(core::number(high, 3))})});
  }

  bool off_centre(Parameter parameter) const {
    const double median = grid_.marginal(parameter).quantile(0.5);
    const double outer = kOuter * (box_[parameter].high - box_[parameter].low);
    return median < box_[parameter].low + outer || median > box_[parameter].high - outer;
  }

  void say_off_centre(const std::string& code, const char* name) {
    result_.fit.statements.push_back(
        {code + "-off-centre", core::phrase("statement.off_centre", {core::phrase(name)})});
  }

  template <class Map>
  Interval central(const Marginal& of, Map map) const {
    const double c = result_.intervals.confidence;
    const double one = map(of.quantile(0.5 - c / 2)), other = map(of.quantile(0.5 + c / 2));
    return {std::min(one, other), std::max(one, other), c};
  }

  template <class Map>
  ParameterInterval interval(Parameter parameter, Map map) const {
    ParameterInterval result{central(grid_.marginal(parameter), map), grid_.open_low(parameter),
                             grid_.open_high(parameter)};
    if (map(1.0) < map(0.0)) std::swap(result.touches_low, result.touches_high);
    return result;
  }

  PosteriorFit& result_;
  const FitOptions& options_;
  const Prior& prior_;
  AxisCounts counts_;
  Box box_;
  PosteriorGrid grid_;
  int trials_ = 0;
};

}  // namespace

Prior prior_around(Function function, Scale scale, const Range& levels, const std::optional<Range>& slopes) {
  if (!(levels.first < levels.second))
    throw std::invalid_argument("prior: levels from " + core::number(levels.first) + " to " +
                                core::number(levels.second) + "; the first must be below the second");
  const double low = axis_position(function, scale, levels.first),
               high = axis_position(function, scale, levels.second), range = high - low;
  double rate_low = kShallow / range, rate_high = kSteep / range;
  if (slopes)
    for (const double slope : {slopes->first, slopes->second}) {
      rate_low = std::min(rate_low, rate_from_slope(function, slope));
      rate_high = std::max(rate_high, rate_from_slope(function, slope));
    }
  const double wider = std::pow(rate_high / rate_low, kBeyond);
  Prior prior{level_from_axis(function, scale, low - kBeyond * range),
              level_from_axis(function, scale, high + kBeyond * range),
              slope_from_rate(function, rate_low / wider), slope_from_rate(function, rate_high * wider),
              kFallingShare};
  if (prior.slope_low > prior.slope_high) std::swap(prior.slope_low, prior.slope_high);
  return prior;
}

Prior flat_part(Function function, Scale scale, const Prior& prior) {
  const auto within = [&prior](double low, double high) {
    const double cut = prior.falling_share * (high - low);
    return Range{low + cut, high - cut};
  };
  const auto [low, high] = within(axis_position(function, scale, prior.threshold_low),
                                  axis_position(function, scale, prior.threshold_high));
  const auto [shallow, steep] = within(std::log(prior.slope_low), std::log(prior.slope_high));
  return {level_from_axis(function, scale, low), level_from_axis(function, scale, high), std::exp(shallow),
          std::exp(steep)};
}

PosteriorFit fit_posterior(const std::vector<LevelCount>& data, const FitOptions& options, const Prior& prior,
                           int band_points) {
  check(prior);
  PosteriorFit result;
  result.fit.options = options;
  result.fit.data = checked(data, options);
  if (auto reason = unusable(result.fit.data, options)) {
    result.fit.statements.push_back(*reason);
    return result;
  }
  if (std::any_of(result.fit.data.begin(), result.fit.data.end(),
                  [](const auto& point) { return point.admitted > 0; }))
    result.fit.weight = weight_of(result.fit.data, options, Reading(result, prior).medians());
  Reading reading(result, prior);
  result.intervals.method = IntervalMethod::posterior;
  result.intervals.prior = prior;
  reading.read_parameters();
  if (result.fit.parameters) reading.read_intervals();
  if (band_points > 1) reading.read_band(band_points);
  say_what_touches(result.intervals);
  return result;
}

}  // namespace turnpoint::analysis
