#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"

namespace turnpoint::analysis {

/// Lowest and highest value, in the unit of the quantity.
using Range = std::pair<double, double>;

/// The prior for a design that can present a range of levels. Its density is flat for thresholds within the
/// range. For slopes it is flat from a function that needs two thirds of the range for a change of z by one
/// to a function that needs a 24th of it (Weibull in dB over 30 dB: 0.43 to 7), or further if the protocol
/// allows other `slopes`. Beyond either end it falls to 0 over a quarter of that width, on the axis for the
/// threshold and in the logarithm for the slope. The prior is wider than what is plausible, because central
/// intervals miss more often near an end of their prior. It falls at the ends, because a few shallow answers
/// would otherwise draw the estimates far outside. Throws std::invalid_argument unless low < high, and on a
/// log10 scale above 0.
Prior prior_around(Function function, Scale scale, const Range& levels, const std::optional<Range>& slopes);

/// The flat part of a prior, as a prior.
Prior flat_part(Function function, Scale scale, const Prior& prior);

struct PosteriorFit {
  PsychometricFit fit;  ///< `parameters` are posterior medians; empty if the threshold is not determined
  PsychometricIntervals intervals;
};

/// Estimates and central 95 % credible intervals from the posterior on a grid of threshold, slope, lapse and,
/// if it is fitted, guess. Lapse and guess are uniform within the bounds of the options.
/// Use this if a procedure chose the levels by the answers. The likelihood does not depend on how levels were
/// chosen or when the session stopped (Berger & Wolpert 1988), while a bootstrap at fixed levels gives
/// intervals that are too short.
/// An end of an interval `touches` if the data do not exclude the prior's end. A quantity that the data limit
/// at neither end has no interval but a statement. If true values lie in the middle half of the prior's
/// ranges, the intervals have their stated coverage (tests/coverage/README.md); an estimate outside gets a
/// statement. Reversed data and fewer trials than FitOptions::minimum_trials are refused.
/// Takes about 4 ms for 200 trials on 30 levels, and 10 ms with a band. Throws std::invalid_argument for
/// counts, options or a prior that make no sense.
PosteriorFit fit_posterior(const std::vector<LevelCount>& data, const FitOptions& options, const Prior& prior,
                           int band_points);

}  // namespace turnpoint::analysis
