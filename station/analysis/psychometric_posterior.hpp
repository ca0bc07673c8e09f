#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"

namespace turnpoint::analysis {

/// Lowest and highest of something, in the unit that it has elsewhere.
using Range = std::pair<double, double>;

/// The prior of a design that can present levels of a range. Its density is flat for thresholds within the
/// range, and for slopes from one whose function takes two thirds of the range for a change of z by one to
/// one that takes a 24th of it (Weibull in dB, 30 dB: 0.43 to 7), or further where a protocol thinks other
/// `slopes` possible. Beyond either end it falls to 0 over a quarter of that, on the axis and of the
/// logarithm. Wider than what is plausible, since central intervals miss more often towards an end of their
/// prior; falling there, since a few shallow answers would otherwise draw the estimates far outside. Throws
/// std::invalid_argument unless low < high, above 0 on a log10 scale.
Prior prior_around(Function function, Scale scale, const Range& levels, const std::optional<Range>& slopes);

/// The ends of the part of a prior that is flat, as a prior.
Prior flat_part(Function function, Scale scale, const Prior& prior);

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
/// neither end has no interval but a statement. Where true values lie in the middle half of the prior's
/// ranges intervals hold them as often as they say (tests/coverage/README.md); an estimate outside gets a
/// statement. Reversed data and fewer trials than FitOptions::minimum_trials are refused. Takes about 4 ms
/// for 200 trials on 30 levels, and 10 ms for a band. Throws std::invalid_argument for counts, options or a
/// prior that make no sense.
PosteriorFit fit_posterior(const std::vector<LevelCount>& data, const FitOptions& options, const Prior& prior,
                           int band_points);

}  // namespace turnpoint::analysis
