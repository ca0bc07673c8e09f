#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"

namespace turnpoint::analysis {

/// Lowest and highest value of a quantity, in its unit.
using Range = std::pair<double, double>;

/// Returns the prior for a design that can present the given range of levels.
/// - Threshold: the density is flat within the range of levels.
/// - Slope: the density of the logarithm of the slope is flat between two slopes. With the shallower one, the
///   standard variable z changes by one over two thirds of the range of levels; with the steeper one, over a
///   24th (Weibull in dB over 30 dB: slopes of 0.43 to 7). If the protocol allows further `slopes`, the flat
///   part includes them.
/// - Beyond either end of the flat part, the density falls to 0 over a quarter of the flat width. For the
///   threshold, the width is that on the axis; for the slope, that in the logarithm.
/// The prior is wider than plausible values, because central intervals miss the true value more often near an
/// end of their prior. It falls to 0 at the ends because otherwise a few answers with a shallow slope would
/// draw the estimates far outside. Throws std::invalid_argument unless low < high and, on a log10 scale, low
/// > 0.
Prior prior_around(Function function, Scale scale, const Range& levels, const std::optional<Range>& slopes);

/// Returns the flat part of a prior, without the falling ends.
Prior flat_part(Function function, Scale scale, const Prior& prior);

struct PosteriorFit {
  PsychometricFit fit;  ///< `parameters` are posterior medians; empty if the threshold is not determined
  PsychometricIntervals intervals;
};

/// Computes estimates and central 95 % credible intervals from the posterior on a grid of threshold, slope,
/// lapse and (if fitted) guess. Lapse and guess are uniform within the bounds of the options.
///
/// Use this if a procedure chose the levels from the answers. The likelihood does not depend on how levels
/// were chosen or when the session stopped (Berger & Wolpert 1988), while a bootstrap at fixed levels gives
/// intervals that are too short.
///
/// An end of an interval is marked as touching if the data do not exclude that end of the prior. If the data
/// limit a quantity at neither end, a statement replaces its interval. The intervals have their stated
/// coverage if the true values lie in the middle half of the prior's ranges (tests/coverage/README.md); an
/// estimate outside gets a statement. If the answers become rarer as the level rises, or there are fewer
/// trials than FitOptions::minimum_trials, a statement replaces the fit.
///
/// Takes about 4 ms for 200 trials on 30 levels, and 10 ms with a band. Throws std::invalid_argument for
/// impossible counts, options or priors.
PosteriorFit fit_posterior(const std::vector<LevelCount>& data, const FitOptions& options, const Prior& prior,
                           int band_points);

}  // namespace turnpoint::analysis
