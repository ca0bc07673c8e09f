#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"

namespace turnpoint::analysis {

/// Lowest and highest of something, in the unit that it has elsewhere.
using Range = std::pair<double, double>;

/// The prior of a design that can present levels of a range: the threshold may lie a quarter of the range
/// beyond both ends, on the function's axis; the slope from one whose function takes 1.3 times the range for
/// a change of z by one to one that takes a 48th of it, which holds every plausible slope with room (Weibull
/// in dB, 30 dB: 0.22 to 14). `slopes` that a protocol thinks possible widen that, with a factor of 2 on both
/// sides. Wider than what is plausible on purpose: towards an end of a prior its central intervals miss more
/// often. Throws std::invalid_argument unless low < high, above 0 on a log10 scale.
Prior prior_around(Function function, Scale scale, const Range& levels, const std::optional<Range>& slopes);

struct PosteriorFit {
  PsychometricFit fit;  ///< `parameters` are posterior medians; none where the threshold is not determined
  PsychometricIntervals intervals;
};

/// Estimates and central 95 % credible intervals from the posterior on a grid of threshold, slope, lapse and,
/// where it is fitted, guess; the last two are uniform within the bounds of the options. For levels that a
/// procedure chose by the answers: the likelihood does not depend on how levels were chosen or when the
/// session stopped (Berger & Wolpert 1988), while a bootstrap at fixed levels gives intervals that are too
/// short.
///
/// An end of an interval `touches` where the data do not exclude the prior's end. What the data limit at
/// neither end has no interval but a statement. Reversed data and fewer trials than
/// FitOptions::minimum_trials are refused. Takes about 4 ms for 200 trials on 30 levels, and 10 ms for a
/// band. Throws std::invalid_argument for counts, options or a prior that make no sense.
PosteriorFit fit_posterior(const std::vector<LevelCount>& data, const FitOptions& options, const Prior& prior,
                           int band_points);

}  // namespace turnpoint::analysis
