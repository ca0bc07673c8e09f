#include "station/analysis/diffusion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "station/analysis/first_passage.hpp"
#include "station/analysis/proportion.hpp"
#include "station/analysis/quantile.hpp"
#include "station/core/draws.hpp"
#include "station/core/number.hpp"

namespace turnpoint::analysis {

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr double kNearChance = 1e-3;
constexpr double kDriftPriorSd = 10;      // per s, with s = 1
constexpr double kContaminantPrior = 19;  // Beta(1, 19)
constexpr int kPosteriorDraws = 1000, kMostRounds = 16;
// no more draws are added with this many effective ones, and with every end of an interval certain to this
// share of its width
constexpr double kEnoughDraws = 400, kEnoughOfWidth = 0.05;
constexpr int kFewestAnswers = 10;  // answers

double log_add(double a, double b) {
  if (a < b) std::swap(a, b);
  return std::isinf(b) ? a : a + std::log1p(std::exp(b - a));
}

/// The proportion of contaminants that answer right (or wrong), if decisions do so with this probability:
/// half of them guess, half decide but answer at another time.
double contaminant_share(double decisions) { return 0.25 + 0.5 * decisions; }

constexpr double kDriftSdPrior = 2, kRangePrior_s = 0.2;  // with s = 1

/// The parameters that all difficulties share, with s = 1.
struct Shared {
  double boundary = 1, nondecision_s = 0, contaminants = 0, start = 0.5, drift_sd = 0, range_s = 0;

  Diffusion diffusion(double drift) const { return {drift, boundary, start, drift_sd, range_s}; }
};

/// The negative logarithm of the posterior density (or of the likelihood) over the parameters as the search
/// sees them: the shared ones, unbounded, then the drifts. It is a sum over the difficulties, and each drift
/// concerns one of them only, which derivatives make use of.
class Posterior {
 public:
  Posterior(const std::vector<DiffusionTrial>& trials, std::size_t difficulties,
            const DiffusionOptions& options)
      : options_(options), answers_(difficulties), censored_(difficulties) {
    Eigen::Index next = kContaminants;
    contaminants_ = options.contaminants ? next++ : 0;
    start_ = options.start ? next++ : 0;
    drift_sd_ = options.drift_varies ? next++ : 0;
    range_ = options.nondecision_varies ? next++ : 0;
    first_drift_ = next;
    double longest = 0;
    for (const auto& trial : trials)
      if (trial.outcome == DiffusionTrial::Outcome::answered) longest = std::max(longest, trial.time_s);
    std::map<std::array<double, 4>, double> rest;
    for (const auto& trial : trials) {
      const double window = trial.deadline_s ? 2 * std::max(*trial.deadline_s, trial.time_s) : longest;
      if (trial.outcome == DiffusionTrial::Outcome::answered)
        answers_[trial.difficulty].push_back({trial.correct, trial.time_s, 1 / window});
      else
        ++rest[{static_cast<double>(trial.difficulty),
                trial.outcome == DiffusionTrial::Outcome::late ? 1.0 : 0.0, trial.time_s, window}];
    }
    for (const auto& [what, count] : rest)
      censored_[static_cast<std::size_t>(what[0])].push_back(
          {what[1] > 0, what[2],
           std::log(std::clamp(what[1] > 0 ? 1 - what[2] / what[3] : what[2] / what[3], 1e-9, 1.0)), count});
  }

  static constexpr Eigen::Index kBoundary = 0, kNondecision = 1, kContaminants = 2;
  static constexpr double kImpossible = 1e100;

  Eigen::Index first_drift() const { return first_drift_; }
  Eigen::Index size() const { return first_drift_ + static_cast<Eigen::Index>(answers_.size()); }

  Shared shared(const Vector& theta) const {
    const auto share = [](double logit) { return 1 / (1 + std::exp(-logit)); };
    Shared at;
    at.boundary = std::exp(theta[kBoundary]), at.nondecision_s = std::exp(theta[kNondecision]);
    if (contaminants_) at.contaminants = share(theta[contaminants_]);
    if (start_) at.start = share(theta[start_]);
    if (drift_sd_) at.drift_sd = std::exp(theta[drift_sd_]);
    if (range_) at.range_s = std::exp(theta[range_]);
    return at;
  }

  Vector unbounded(const Shared& at, const std::vector<double>& drift) const {
    const auto logit = [](double p) { return std::log(p / (1 - p)); };
    Vector theta(size());
    theta[kBoundary] = std::log(at.boundary), theta[kNondecision] = std::log(at.nondecision_s);
    if (contaminants_) theta[contaminants_] = logit(at.contaminants);
    if (start_) theta[start_] = logit(at.start);
    if (drift_sd_) theta[drift_sd_] = std::log(at.drift_sd);
    if (range_) theta[range_] = std::log(at.range_s);
    for (std::size_t i = 0; i < drift.size(); ++i)
      theta[first_drift_ + static_cast<Eigen::Index>(i)] = drift[i];
    return theta;
  }

  double operator()(const Vector& theta) const {
    const auto at = shared(theta);
    double sum = shared_part(theta);
    for (std::size_t i = 0; i < answers_.size() && sum < kImpossible; ++i)
      sum += part(at, drift(theta, i), i);
    return std::isfinite(sum) && sum < kImpossible ? sum : kImpossible;
  }

  double log_likelihood(const Vector& theta) const {
    const auto at = shared(theta);
    double sum = 0;
    for (std::size_t i = 0; i < answers_.size(); ++i) sum += likelihood(at, drift(theta, i), i);
    return sum;
  }

  /// The prior of the shared parameters, on the scale of the search.
  double shared_part(const Vector& theta) const {
    const auto at = shared(theta);
    if (!(at.boundary > 1e-3 && at.boundary < 1e3 && at.nondecision_s < 1e3 && at.drift_sd < 1e3 &&
          at.range_s < 1e3 && at.start > 1e-9 && at.start < 1 - 1e-9))
      return kImpossible;
    if (contaminants_ && !(at.contaminants > 1e-12 && at.contaminants < 1)) return kImpossible;
    if (options_.method == DiffusionOptions::Method::likelihood) return 0;
    double sum = theta[kNondecision];
    if (contaminants_) sum += std::log(at.contaminants) + kContaminantPrior * std::log1p(-at.contaminants);
    if (start_) sum += 2 * std::log(at.start * (1 - at.start));
    if (drift_sd_) sum += theta[drift_sd_] - 0.5 * std::pow(at.drift_sd / kDriftSdPrior, 2);
    if (range_) sum += theta[range_] - 0.5 * std::pow(at.range_s / kRangePrior_s, 2);
    return -sum;
  }

  /// What the answers to one difficulty and the prior of its drift contribute.
  double part(const Vector& theta, std::size_t difficulty) const {
    return part(shared(theta), drift(theta, difficulty), difficulty);
  }

 private:
  struct Answer {
    bool correct;
    double time_s;
    double contaminant;  ///< density (1/s) of the times of contaminants
  };
  struct Censored {
    bool late;
    double time_s, log_contaminant, count;
  };

  double drift(const Vector& theta, std::size_t difficulty) const {
    return theta[first_drift_ + static_cast<Eigen::Index>(difficulty)];
  }

  double part(const Shared& at, double v, std::size_t difficulty) const {
    double sum = likelihood(at, v, difficulty);
    if (options_.method == DiffusionOptions::Method::posterior)
      sum -= v * v / (2 * kDriftPriorSd * kDriftPriorSd);
    return std::isfinite(sum) ? -sum : kImpossible;
  }

  double likelihood(const Shared& at, double v, std::size_t difficulty) const {
    const Diffusion d = at.diffusion(v);
    double sum = 0;
    const FirstPassageDensity wrong(d, false), right(d, true);
    if (!contaminants_) {
      for (const auto& answer : answers_[difficulty])
        sum += (answer.correct ? right : wrong).log_at(answer.time_s - at.nondecision_s);
      for (const auto& trial : censored_[difficulty]) sum += trial.count * undecided(d, trial, at);
      return sum;
    }
    const double log_share = std::log(at.contaminants), log_rest = std::log1p(-at.contaminants);
    const double p = upper_probability(d);
    const double by_chance[] = {at.contaminants * contaminant_share(1 - p),
                                at.contaminants * contaminant_share(p)};
    // The logarithm of a product takes less time than those of its factors. No factor is 0, because of the
    // contaminants.
    double product = 1;
    for (const auto& answer : answers_[difficulty]) {
      product *=
          (1 - at.contaminants) * (answer.correct ? right : wrong).at(answer.time_s - at.nondecision_s) +
          by_chance[answer.correct ? 1 : 0] * answer.contaminant;
      if (product > 1e-100 && product < 1e100) continue;
      sum += std::log(product);
      product = 1;
    }
    sum += std::log(product);
    for (const auto& trial : censored_[difficulty])
      sum += trial.count * log_add(log_rest + undecided(d, trial, at), log_share + trial.log_contaminant);
    return sum;
  }
  static double undecided(const Diffusion& d, const Censored& trial, const Shared& at) {
    const double survival = log_survival(d, trial.time_s - at.nondecision_s);
    return trial.late ? survival : std::log(std::max(-std::expm1(survival), 1e-300));
  }

  DiffusionOptions options_;
  Eigen::Index contaminants_ = 0, start_ = 0, drift_sd_ = 0, range_ = 0, first_drift_ = 0;  // 0: not fitted
  std::vector<std::vector<Answer>> answers_;                                                // by difficulty
  std::vector<std::vector<Censored>> censored_;
};

/// The gradient of f over these entries of `at`, by central differences.
template <class F>
Vector gradient_over(const F& f, const Vector& at, const std::vector<Eigen::Index>& entries) {
  Vector result(static_cast<Eigen::Index>(entries.size())), x = at;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    constexpr double step = 1e-5;
    const auto k = entries[i];
    x[k] = at[k] + step;
    const double up = f(x);
    x[k] = at[k] - step;
    result[static_cast<Eigen::Index>(i)] = (up - f(x)) / (2 * step);
    x[k] = at[k];
  }
  return result;
}

/// Calls visit(f, entries) for each summand f of the posterior, with the parameters that it depends on.
template <class Visit>
void over_parts(const Posterior& f, std::size_t difficulties, const Visit& visit) {
  std::vector<Eigen::Index> entries;
  for (Eigen::Index k = 0; k < f.first_drift(); ++k) entries.push_back(k);
  visit([&f](const Vector& x) { return f.shared_part(x); }, entries);
  entries.push_back(0);
  for (std::size_t i = 0; i < difficulties; ++i) {
    entries.back() = f.first_drift() + static_cast<Eigen::Index>(i);
    visit([&f, i](const Vector& x) { return f.part(x, i); }, entries);
  }
}

Vector gradient(const Posterior& f, const Vector& at) {
  Vector result = Vector::Zero(at.size());
  over_parts(f, static_cast<std::size_t>(at.size() - f.first_drift()),
             [&](const auto& part, const auto& entries) {
               const Vector some = gradient_over(part, at, entries);
               for (std::size_t i = 0; i < entries.size(); ++i)
                 result[entries[i]] += some[static_cast<Eigen::Index>(i)];
             });
  return result;
}

Matrix hessian(const Posterior& f, const Vector& at) {
  constexpr double step = 1e-3;
  Matrix result = Matrix::Zero(at.size(), at.size());
  over_parts(f, static_cast<std::size_t>(at.size() - f.first_drift()),
             [&](const auto& part, const auto& entries) {
               Vector x = at;
               for (const auto k : entries) {
                 x[k] = at[k] + step;
                 const Vector up = gradient_over(part, x, entries);
                 x[k] = at[k] - step;
                 const Vector change = (up - gradient_over(part, x, entries)) / (2 * step);
                 for (std::size_t i = 0; i < entries.size(); ++i)
                   result(entries[i], k) += change[static_cast<Eigen::Index>(i)];
                 x[k] = at[k];
               }
             });
  return (result + result.transpose()) / 2;
}

/// Finds the mode by the BFGS method with a search along each direction that halves the step until the value
/// falls.
Vector mode_from(const Posterior& f, Vector x) {
  const auto n = x.size();
  Matrix inverse = Matrix::Identity(n, n) * 1e-2;
  double value = f(x);
  Vector slope = gradient(f, x);
  for (int round = 0; round < 400; ++round) {
    Vector direction = -inverse * slope;
    if (!(direction.dot(slope) < 0)) {
      inverse = Matrix::Identity(n, n) * 1e-2;
      direction = -inverse * slope;
    }
    if (const double reach = direction.cwiseAbs().maxCoeff(); reach > 1) direction /= reach;
    double step = 1, next = 0;
    Vector to;
    while (step > 1e-10) {
      to = x + step * direction;
      next = f(to);
      if (next < value + 1e-4 * step * direction.dot(slope)) break;
      step /= 2;
    }
    if (step <= 1e-10) break;
    const Vector new_slope = gradient(f, to), moved = to - x, turned = new_slope - slope;
    const double curvature = moved.dot(turned);
    if (curvature > 1e-12) {
      const Vector along = inverse * turned;
      inverse += (curvature + turned.dot(along)) / (curvature * curvature) * moved * moved.transpose() -
                 (along * moved.transpose() + moved * along.transpose()) / curvature;
    }
    const double gained = value - next;
    x = to, value = next, slope = new_slope;
    if (gained < 1e-9 && slope.cwiseAbs().maxCoeff() < 1e-3) break;
  }
  return x;
}

/// A place from which the search can begin, with s = 1. If all answers are decisions, it is one at which the
/// fastest of them is possible.
std::pair<Shared, std::vector<double>> start_of(const std::vector<DiffusionTrial>& trials,
                                                std::size_t difficulties, bool contaminants) {
  std::vector<double> right, all;
  std::vector<int> answered(difficulties), correct(difficulties);
  for (const auto& trial : trials) {
    if (trial.outcome != DiffusionTrial::Outcome::answered) continue;
    all.push_back(trial.time_s);
    ++answered[trial.difficulty];
    if (!trial.correct) continue;
    right.push_back(trial.time_s);
    ++correct[trial.difficulty];
  }
  const double fastest = contaminants ? quantile(all, 0.05) : *std::min_element(all.begin(), all.end());
  const double early = quantile(all, 0.05), spread = quantile(all, 0.75) - quantile(all, 0.25);
  DiffusionParameters start{0.1, kDiffusionScale * std::clamp(2 * std::sqrt(spread + 0.05), 0.5, 4.0),
                            0.8 * early};
  if (right.size() > 2)
    if (const auto ez = ez_diffusion(static_cast<double>(right.size()) / static_cast<double>(all.size()),
                                     static_cast<int>(all.size()), mean(right), variance(right));
        ez && ez->nondecision_s > 0.1 * early && ez->nondecision_s < early)
      start = *ez;
  Shared at;
  at.boundary = start.boundary / kDiffusionScale;
  at.nondecision_s = std::max(std::min(start.nondecision_s, 0.9 * fastest), 1e-3);
  at.contaminants = 0.02, at.drift_sd = 0.5, at.range_s = 0.2 * at.nondecision_s;
  std::vector<double> drift;
  for (std::size_t i = 0; i < difficulties; ++i) {
    const double p = (correct[i] + 0.5) / (answered[i] + 1.0);
    drift.push_back(std::clamp(std::log(p / (1 - p)) / at.boundary, -6.0, 6.0));
  }
  return {at, drift};
}

/// Weighted draws from the posterior.
struct WeightedDraws {
  std::vector<Vector> at;
  std::vector<double> weight;  // their sum is 1
  double effective = 0;        // number of independent draws that they are worth
  double error_of_width = 0;   // largest standard error of an interval's end, over the interval's width
};

/// Draws from the posterior by way of proposals: t distributions with 6 degrees of freedom. Each round adds
/// one proposal and its draws. The draws of all rounds count, with the posterior density over that of the
/// mixture of all proposals as their weights (Owen & Zhou 2000), so that a proposal that is too narrow, or
/// does not reach all modes, makes no draw outweigh the others once another one has been there.
class Sampler {
 public:
  explicit Sampler(const Posterior& f) : f_(f) {}

  void add(const Vector& centre, const Matrix& covariance, core::Draws& draws) {
    const auto n = centre.size();
    const Matrix root = covariance.llt().matrixL();
    proposals_.push_back({centre, root, -root.diagonal().array().log().sum()});
    for (std::size_t i = 0; i < at_.size(); ++i)
      mixture_[i] = log_add(mixture_[i], density(proposals_.back(), at_[i]));
    for (int i = 0; i < kPosteriorDraws; ++i) {
      Vector z(n);
      for (Eigen::Index k = 0; k < n; ++k) z[k] = draws.normal();
      double chi2 = 0;
      for (int k = 0; k < kFreedom; ++k) {
        const double g = draws.normal();
        chi2 += g * g;
      }
      at_.push_back(centre + std::sqrt(kFreedom / chi2) * (root * z));
      height_.push_back(-f_(at_.back()));
      double mixture = density(proposals_[0], at_.back());
      for (std::size_t k = 1; k < proposals_.size(); ++k)
        mixture = log_add(mixture, density(proposals_[k], at_.back()));
      mixture_.push_back(mixture);
    }
    sort_new(n);
  }

  /// The draws so far. They are worth as many independent ones as the least certain of the quantiles that are
  /// reported tells, and at most as many as are drawn again with equal weights.
  WeightedDraws weighted(double confidence) const {
    WeightedDraws sample;
    sample.at = at_;
    double highest = -std::numeric_limits<double>::infinity(), sum = 0;
    for (std::size_t i = 0; i < at_.size(); ++i)
      if (height_[i] > -Posterior::kImpossible) highest = std::max(highest, height_[i] - mixture_[i]);
    for (std::size_t i = 0; i < at_.size(); ++i) {
      sample.weight.push_back(
          height_[i] > -Posterior::kImpossible ? std::exp(height_[i] - mixture_[i] - highest) : 0);
      sum += sample.weight.back();
    }
    if (!(sum > 0)) return sample;
    for (auto& w : sample.weight) w /= sum;
    sample.effective = kPosteriorDraws;
    const double tail = (1 - confidence) / 2;
    // weight up to each draw, in the order of a parameter, and the sum of the squares of the weights
    std::vector<double> below(at_.size()), squares(at_.size());
    for (Eigen::Index k = 0; k < at_[0].size(); ++k) {
      const auto& order = sorted_[static_cast<std::size_t>(k)];
      double weight = 0, square = 0;
      for (std::size_t i = 0; i < order.size(); ++i) {
        const double w = sample.weight[order[i]];
        below[i] = weight += w;
        squares[i] = square += w * w;
      }
      const auto quantile_at = [&](double p) {
        const auto found = std::lower_bound(below.begin(), below.end(), p) - below.begin();
        return at_[order[std::min(static_cast<std::size_t>(found), order.size() - 1)]][k];
      };
      const double width = quantile_at(1 - tail) - quantile_at(tail);
      for (const double p : {tail, 0.5, 1 - tail}) {
        // the variance of the weight below the quantile, and what it means for the quantile
        const auto up_to = std::upper_bound(below.begin(), below.end(), p) - below.begin();
        const double low = up_to == 0 ? 0 : squares[static_cast<std::size_t>(up_to) - 1];
        const double variance = (1 - p) * (1 - p) * low + p * p * (square - low);
        sample.effective = std::min(sample.effective, p * (1 - p) / variance);
        const double error = std::sqrt(variance);
        sample.error_of_width =
            std::max(sample.error_of_width, (quantile_at(p + error) - quantile_at(p - error)) / 2 / width);
      }
    }
    return sample;
  }

 private:
  /// Sorts the draws of the last round into the order of each parameter.
  void sort_new(Eigen::Index parameters) {
    sorted_.resize(static_cast<std::size_t>(parameters));
    std::vector<double> value(
        at_.size());  // side by side in memory, which makes sorting several times faster
    for (Eigen::Index k = 0; k < parameters; ++k) {
      auto& order = sorted_[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < at_.size(); ++i) value[i] = at_[i][k];
      const auto lower = [&](std::size_t a, std::size_t b) { return value[a] < value[b]; };
      const auto old = static_cast<std::ptrdiff_t>(order.size());
      for (auto i = order.size(); i < at_.size(); ++i) order.push_back(i);
      std::sort(order.begin() + old, order.end(), lower);
      std::inplace_merge(order.begin(), order.begin() + old, order.end(), lower);
    }
  }

  static constexpr int kFreedom = 6;
  struct Proposal {
    Vector centre;
    Matrix root;
    double log_scale;
  };
  static double density(const Proposal& of, const Vector& at) {
    const Vector z = of.root.triangularView<Eigen::Lower>().solve(at - of.centre);
    return of.log_scale -
           0.5 * static_cast<double>(kFreedom + at.size()) * std::log1p(z.squaredNorm() / kFreedom);
  }

  const Posterior& f_;
  std::vector<Proposal> proposals_;
  std::vector<Vector> at_;
  std::vector<double> height_, mixture_;          // logarithms of the densities of posterior and proposals
  std::vector<std::vector<std::size_t>> sorted_;  // the draws in the order of each parameter
};

/// Returns draws of equal weight (systematic resampling), in random order: the reports of differences pair
/// those of two conditions.
std::vector<Vector> equally_weighted(const WeightedDraws& sample, core::Draws& draws) {
  std::vector<Vector> result;
  const double offset = draws.uniform();
  double reached = 0;
  std::size_t i = 0;
  for (int k = 0; k < kPosteriorDraws; ++k) {
    const double wanted = (k + offset) / kPosteriorDraws;
    while (i + 1 < sample.weight.size() && reached + sample.weight[i] < wanted) reached += sample.weight[i++];
    result.push_back(sample.at[i]);
  }
  draws.shuffle(result);
  return result;
}

/// Weighted quantiles of one number for each draw: the median and a central interval.
template <typename Of>
Estimate estimate(const WeightedDraws& sample, double confidence, const Of& of) {
  std::vector<std::pair<double, double>> values;
  for (std::size_t i = 0; i < sample.at.size(); ++i) values.emplace_back(of(sample.at[i]), sample.weight[i]);
  std::sort(values.begin(), values.end());
  const auto at = [&](double p) {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double middle = sum + values[i].second / 2;
      if (middle >= p) {
        if (i == 0) return values[0].first;
        const double before = sum - values[i - 1].second / 2;
        return values[i - 1].first +
               (values[i].first - values[i - 1].first) * (p - before) / (middle - before);
      }
      sum += values[i].second;
    }
    return values.back().first;
  };
  const double tail = (1 - confidence) / 2;
  return {at(0.5), {at(tail), at(1 - tail), confidence}};
}

}  // namespace

std::optional<DiffusionParameters> ez_diffusion(double proportion_correct, int trials, double mean_s,
                                                double variance_s2) {
  double p = proportion_correct;
  if (p >= 1 && trials > 0) p = 1 - 0.5 / trials;
  if (!(p > 0 && p < 1) || proportion_correct > 1 || !(variance_s2 > 0) || !std::isfinite(variance_s2) ||
      !std::isfinite(mean_s))
    return std::nullopt;
  const double e = p - 0.5;
  DiffusionParameters result;
  if (std::abs(e) < kNearChance) {  // the limits of the formulas, which lose precision there
    result.drift = kDiffusionScale * e * std::pow(32 / (3 * variance_s2), 0.25);
    result.boundary = kDiffusionScale * std::pow(24 * variance_s2, 0.25);
    result.nondecision_s = mean_s - std::sqrt(24 * variance_s2) / 4;
  } else {
    const double L = std::log(p / (1 - p)), x = L * (L * p * p - L * p + p - 0.5) / variance_s2;
    result.drift = std::copysign(kDiffusionScale * std::pow(x, 0.25), e);
    result.boundary = kDiffusionScale * kDiffusionScale * L / result.drift;
    const double y = -result.drift * result.boundary / (kDiffusionScale * kDiffusionScale);
    result.nondecision_s =
        mean_s - result.boundary / (2 * result.drift) * (1 - std::exp(y)) / (1 + std::exp(y));
  }
  if (result.nondecision_s < 0) return std::nullopt;
  return result;
}

namespace {

/// The mode of a posterior and the inverse of its curvature there.
struct Mode {
  Vector at;
  Matrix covariance;
  bool curved = true;  ///< false if the curvature is not positive in all directions
};

Matrix covariance_at(const Posterior& posterior, const Vector& centre, bool& curved) {
  const Matrix curvature = hessian(posterior, centre);
  const Matrix one = Matrix::Identity(curvature.rows(), curvature.cols());
  for (double ridge = 0; ridge < 1e6; ridge = ridge == 0 ? 1e-3 : ridge * 10) {
    const Eigen::LLT<Matrix> factor(curvature + ridge * one);
    if (factor.info() == Eigen::Success) return factor.solve(one);
    curved = false;
  }
  return 0.01 * one;
}

/// The maximum of the likelihood from the best of five starts, with a last step by Newton's method.
Mode maximum(const Posterior& f, const Shared& start, const std::vector<double>& drift) {
  Mode best;
  double lowest = 2 * Posterior::kImpossible;
  for (const double stretch : {1.0, 0.7, 1.4, 0.85, 1.2}) {
    Shared from = start;
    from.boundary *= stretch, from.nondecision_s *= std::min(1.0, 1.6 - 0.6 * stretch);
    from.drift_sd *= stretch, from.range_s *= stretch;
    std::vector<double> slower = drift;
    for (auto& v : slower) v /= stretch;
    const Vector found = mode_from(f, f.unbounded(from, slower));
    if (const double value = f(found); value < lowest) lowest = value, best.at = found;
  }
  for (int round = 0; round < 3; ++round) {
    best.curved = true;
    best.covariance = covariance_at(f, best.at, best.curved);
    const Vector next = best.at - best.covariance * gradient(f, best.at);
    if (!(f(next) < f(best.at))) break;
    best.at = next;
  }
  return best;
}

/// Draws from a normal distribution around the maximum.
WeightedDraws normal_draws(const Mode& mode, core::Draws& draws) {
  const Matrix root = mode.covariance.llt().matrixL();
  WeightedDraws sample;
  for (int i = 0; i < kPosteriorDraws; ++i) {
    Vector z(mode.at.size());
    for (Eigen::Index k = 0; k < z.size(); ++k) z[k] = draws.normal();
    sample.at.push_back(mode.at + root * z);
  }
  sample.weight.assign(sample.at.size(), 1.0 / kPosteriorDraws);
  sample.effective = kPosteriorDraws;
  return sample;
}

WeightedDraws posterior_draws(const Posterior& posterior, const Vector& centre, double confidence,
                              core::Draws& draws) {
  bool curved = true;
  Matrix covariance = covariance_at(posterior, centre, curved);
  // a nearly flat direction must not send most of the draws to where nothing is possible
  for (Eigen::Index i = 0; i < covariance.rows(); ++i)
    if (const double sd = std::sqrt(covariance(i, i)); sd > 2) {
      covariance.row(i) *= 2 / sd;
      covariance.col(i) *= 2 / sd;
    }
  Sampler sampler(posterior);
  sampler.add(centre, 1.2 * covariance, draws);
  WeightedDraws sample = sampler.weighted(confidence);
  for (int round = 1;
       round < kMostRounds && (sample.effective < kEnoughDraws || !(sample.error_of_width < kEnoughOfWidth));
       ++round) {
    Vector mean = Vector::Zero(centre.size());
    for (std::size_t i = 0; i < sample.at.size(); ++i) mean += sample.weight[i] * sample.at[i];
    Matrix spread = 0.02 * covariance;
    for (std::size_t i = 0; i < sample.at.size(); ++i)
      spread += sample.weight[i] * (sample.at[i] - mean) * (sample.at[i] - mean).transpose();
    sampler.add(mean, 1.2 * spread, draws);
    sample = sampler.weighted(confidence);
    covariance = spread;
  }
  return sample;
}

}  // namespace

DiffusionFit fit_diffusion(const std::vector<DiffusionTrial>& trials, std::size_t difficulties,
                           std::uint64_t seed, int stream, const DiffusionOptions& options) {
  DiffusionFit result;
  const auto answers = std::count_if(trials.begin(), trials.end(), [](const auto& trial) {
    return trial.outcome == DiffusionTrial::Outcome::answered;
  });
  if (answers < kFewestAnswers) {
    result.statements.push_back(
        {"diffusion-too-few", core::phrase("statement.diffusion_too_few", {core::plain(kFewestAnswers)})});
    return result;
  }
  const bool likelihood = options.method == DiffusionOptions::Method::likelihood;
  const Posterior posterior(trials, difficulties, options);
  const auto [start, drifts] = start_of(trials, difficulties, options.contaminants);
  Mode mode;
  if (likelihood)
    mode = maximum(posterior, start, drifts);
  else
    mode.at = mode_from(posterior, posterior.unbounded(start, drifts));
  core::Draws draws({seed, core::Stream::bootstrap, 2000, stream, 0});
  const WeightedDraws sample =
      likelihood ? normal_draws(mode, draws) : posterior_draws(posterior, mode.at, options.confidence, draws);
  const auto log_boundary =
      estimate(sample, options.confidence, [](const Vector& x) { return x[Posterior::kBoundary]; });
  if (!mode.curved || sample.effective < 30 ||
      log_boundary.interval.high - log_boundary.interval.low > std::log(20)) {
    result.statements.push_back(
        {"diffusion-not-determined", core::phrase("statement.diffusion_not_determined")});
    return result;
  }
  DiffusionEstimates found;
  found.effective_draws = sample.effective;
  found.log_likelihood = posterior.log_likelihood(mode.at);
  const double reach = normal_quantile(0.5 + options.confidence / 2);
  // each number rises with one parameter and depends on no other
  const auto add = [&](const auto& of) {
    if (!likelihood) return estimate(sample, options.confidence, of);
    const double value = of(mode.at);
    Vector up = mode.at, down = mode.at;
    const Vector sd = mode.covariance.diagonal().cwiseSqrt();
    up += reach * sd, down -= reach * sd;
    return Estimate{value, {of(down), of(up), options.confidence}};
  };
  const auto of_shared = [&](double Shared::*which, double scale = 1) {
    return add([&posterior, which, scale](const Vector& x) { return scale * posterior.shared(x).*which; });
  };
  found.boundary = of_shared(&Shared::boundary, kDiffusionScale);
  found.nondecision_s = of_shared(&Shared::nondecision_s);
  found.contaminants = of_shared(&Shared::contaminants);
  found.start = of_shared(&Shared::start);
  found.drift_sd = of_shared(&Shared::drift_sd, kDiffusionScale);
  found.nondecision_range_s = of_shared(&Shared::range_s);
  const auto first = posterior.first_drift();
  for (Eigen::Index k = first; k < posterior.size(); ++k)
    found.drift.push_back(add([k](const Vector& x) { return kDiffusionScale * x[k]; }));
  for (const auto& x : equally_weighted(sample, draws)) {
    const auto at = posterior.shared(x);
    DiffusionDraw one{kDiffusionScale * at.boundary,
                      at.nondecision_s,
                      at.contaminants,
                      at.start,
                      kDiffusionScale * at.drift_sd,
                      at.range_s,
                      {}};
    for (Eigen::Index k = first; k < posterior.size(); ++k) one.drift.push_back(kDiffusionScale * x[k]);
    found.draws.push_back(std::move(one));
  }
  result.estimates = std::move(found);
  return result;
}

namespace {

/// Trials of one difficulty with the same deadline.
struct Stratum {
  std::size_t difficulty = 0;
  std::optional<double> deadline_s;
  double early_s = 0;            // answers before it were not accepted; 0 if all are
  double window_s = 0;           // times of trials that are no decision are uniform up to here
  std::vector<double> times[2];  // of wrong and of right answers
  int late = 0, early = 0;

  double presented() const { return static_cast<double>(times[0].size() + times[1].size()) + late + early; }
};

std::vector<Stratum> strata_of(const std::vector<DiffusionTrial>& trials) {
  using Outcome = DiffusionTrial::Outcome;
  double longest = 0;
  for (const auto& trial : trials)
    if (trial.outcome == Outcome::answered) longest = std::max(longest, trial.time_s);
  std::map<std::pair<std::size_t, double>, Stratum> all;
  for (const auto& trial : trials) {
    auto& stratum = all[{trial.difficulty, trial.deadline_s.value_or(0)}];
    stratum.difficulty = trial.difficulty;
    stratum.deadline_s = trial.deadline_s;
    stratum.window_s = trial.deadline_s ? 2 * *trial.deadline_s : longest;
    stratum.early_s = std::max(stratum.early_s, trial.early_s);
    if (trial.outcome == Outcome::answered)
      stratum.times[trial.correct ? 1 : 0].push_back(trial.time_s);
    else if (trial.outcome == Outcome::late)
      ++stratum.late;
    else
      ++stratum.early, stratum.early_s = std::max(stratum.early_s, trial.time_s);
  }
  std::vector<Stratum> list;
  for (auto& [key, stratum] : all) list.push_back(std::move(stratum));
  return list;
}

/// The probability of an answer of this kind by `time_s` under the parameters of one draw.
double answered_by(const DiffusionDraw& at, const Stratum& stratum, bool correct, double time_s) {
  const Diffusion d{at.drift[stratum.difficulty] / kDiffusionScale, at.boundary / kDiffusionScale, at.start,
                    at.drift_sd / kDiffusionScale, at.nondecision_range_s};
  const double ever = correct ? upper_probability(d) : 1 - upper_probability(d);
  const double decided =
      std::isinf(time_s) ? ever : std::exp(log_distribution(d, correct, time_s - at.nondecision_s));
  return (1 - at.contaminants) * decided +
         at.contaminants * contaminant_share(ever) * std::clamp(time_s / stratum.window_s, 0.0, 1.0);
}

/// One kind of answer with times above `low_s`, up to `high_s`.
struct Bin {
  double low_s = 0, high_s = 0;
  bool correct = false;
};

/// The bins of a stratum. Each kind of answer has up to six bins that are equally probable under the fitted
/// parameters and expect five trials or more.
std::vector<Bin> bins_of(const DiffusionDraw& at, const Stratum& stratum) {
  const double end = stratum.deadline_s.value_or(INFINITY);
  std::vector<Bin> bins;
  for (const bool correct : {true, false}) {
    const auto by = [&](double time_s) { return answered_by(at, stratum, correct, time_s); };
    const double first = by(stratum.early_s), whole = by(end) - first;
    const int count = std::clamp(static_cast<int>(stratum.presented() * whole / 5), 1, 6);
    double low = stratum.early_s;
    for (int i = 1; i <= count; ++i) {
      double high = end;
      if (i < count) {
        double below = low, above = std::max(2 * stratum.window_s, low + 1);
        for (int step = 0; step < 50; ++step) {
          const double middle = 0.5 * (below + above);
          (by(middle) - first < whole * i / count ? below : above) = middle;
        }
        high = 0.5 * (below + above);
      }
      bins.push_back({low, high, correct});
      low = high;
    }
  }
  return bins;
}

/// The probabilities of the bins, then of answers that are too late and too early.
std::vector<double> probabilities(const DiffusionDraw& at, const Stratum& stratum,
                                  const std::vector<Bin>& bins) {
  std::vector<double> all;
  const auto both = [&](double time_s) {
    return answered_by(at, stratum, true, time_s) + answered_by(at, stratum, false, time_s);
  };
  for (const auto& bin : bins)
    all.push_back(answered_by(at, stratum, bin.correct, bin.high_s) -
                  answered_by(at, stratum, bin.correct, bin.low_s));
  all.push_back(stratum.deadline_s ? 1 - both(*stratum.deadline_s) : 0);
  all.push_back(stratum.early_s > 0 ? both(stratum.early_s) : 0);
  return all;
}

/// Joins the entries whose expected number is below this, because chi squared would be ruled by them.
constexpr double kFewestExpected = 2;

/// The counts of a stratum and what is expected, after rare entries were joined.
struct Expected {
  std::vector<std::size_t> place;  ///< of each entry of probabilities() in what follows
  std::size_t size = 0;
  std::vector<double> probability, count;

  std::vector<double> joined(const std::vector<double>& entries) const {
    std::vector<double> sums(size);
    for (std::size_t i = 0; i < entries.size(); ++i) sums[place[i]] += entries[i];
    return sums;
  }
};

Expected expected_of(const Stratum& stratum, const std::vector<Bin>& bins, const DiffusionDraw& at) {
  const auto all = probabilities(at, stratum, bins);
  Expected result;
  std::optional<std::size_t> rare;
  for (const double p : all) {
    if (stratum.presented() * p >= kFewestExpected) {
      result.place.push_back(result.size++);
      continue;
    }
    if (!rare) rare = result.size++;
    result.place.push_back(*rare);
  }
  std::vector<double> counts(all.size());
  for (std::size_t i = 0; i < bins.size(); ++i)
    for (const double time_s : stratum.times[bins[i].correct ? 1 : 0])
      counts[i] += (time_s > bins[i].low_s || i == 0 || bins[i - 1].correct != bins[i].correct) &&
                   time_s <= bins[i].high_s;
  counts[bins.size()] = stratum.late, counts[bins.size() + 1] = stratum.early;
  result.probability = result.joined(all);
  for (auto& p : result.probability) p = std::max(p, 1e-9);
  result.count = result.joined(counts);
  return result;
}

/// The parameters of a draw, moved by a small step along one of them: six shared ones, then the drifts.
constexpr std::size_t kSharedMoves = 6;
DiffusionDraw moved(DiffusionDraw at, std::size_t which, double step) {
  if (which == 0) at.boundary *= 1 + step;
  if (which == 1) at.nondecision_s *= 1 + step;
  if (which == 2) at.contaminants = std::max(at.contaminants + step, 0.0);
  if (which == 3) at.start += step;
  if (which == 4) at.drift_sd *= 1 + step;
  if (which == 5) at.nondecision_range_s *= 1 + step;
  if (which >= kSharedMoves) at.drift[which - kSharedMoves] += kDiffusionScale * step;
  return at;
}

/// What a kind of answer to one difficulty was, and what the model predicts. The deadline is that of most
/// trials.
PredictedAnswers predicted(const DiffusionDraw& at, const Stratum& stratum, bool correct) {
  PredictedAnswers result;
  auto times = stratum.times[correct ? 1 : 0];
  std::sort(times.begin(), times.end());
  result.observed = static_cast<int>(times.size());
  if (!times.empty()) result.observed_mean_s = mean(times);
  const auto n = static_cast<double>(times.size());
  if (times.size() >= 5)
    for (const double p : kPredictedQuantiles) {
      // from one order statistic to another, by the normal approximation of the binomial distribution
      const double reach = kZ95 * std::sqrt(n * p * (1 - p));
      const auto at_rank = [&](double rank) {
        return times[static_cast<std::size_t>(std::clamp(rank, 0.0, n - 1))];
      };
      result.observed_quantiles.push_back(
          {sorted_quantile(times, p),
           {at_rank(std::floor(n * p - reach)), at_rank(std::ceil(n * p + reach)), 0.95}});
    }
  const double end = stratum.deadline_s.value_or(INFINITY);
  const auto by = [&](double time_s) { return answered_by(at, stratum, correct, time_s); };
  const double first = by(stratum.early_s), whole = by(end) - first;
  result.probability = whole;
  const double last = std::min(end, at.nondecision_s + 4 * stratum.window_s);
  constexpr int steps = 400;
  double before = first, mean_s = 0;
  std::size_t next = 0;
  for (int i = 1; i <= steps; ++i) {
    const double low = stratum.early_s + (last - stratum.early_s) * (i - 1) / steps,
                 high = stratum.early_s + (last - stratum.early_s) * i / steps;
    const double now = by(high);
    mean_s += (now - before) * 0.5 * (low + high);
    while (next < kPredictedQuantiles.size() && now - first >= kPredictedQuantiles[next] * whole) {
      const double wanted = first + kPredictedQuantiles[next] * whole;
      result.quantile_s[next++] =
          low + (high - low) * (now > before ? (wanted - before) / (now - before) : 0.5);
    }
    before = now;
  }
  for (; next < kPredictedQuantiles.size(); ++next) result.quantile_s[next] = last;
  result.mean_s = before > first ? mean_s / (before - first) : last;
  return result;
}

}  // namespace

DiffusionCheck check_diffusion(const std::vector<DiffusionTrial>& trials, const DiffusionEstimates& fitted,
                               std::uint64_t seed, int stream) {
  DiffusionDraw at{fitted.boundary.value,
                   fitted.nondecision_s.value,
                   fitted.contaminants.value,
                   fitted.start.value,
                   fitted.drift_sd.value,
                   fitted.nondecision_range_s.value,
                   {}};
  for (const auto& drift : fitted.drift) at.drift.push_back(drift.value);
  const auto strata = strata_of(trials);
  std::vector<std::vector<Bin>> bins;
  std::vector<Expected> expected;
  std::size_t rows = 0;
  for (const auto& stratum : strata) {
    bins.push_back(bins_of(at, stratum));
    expected.push_back(expected_of(stratum, bins.back(), at));
    rows += expected.back().size;
  }
  const std::size_t parameters = kSharedMoves + at.drift.size();
  Matrix jacobian = Matrix::Zero(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(parameters));
  Eigen::Index row = 0;
  for (std::size_t s = 0; s < strata.size(); ++s) {
    const auto& cells = expected[s];
    for (std::size_t k = 0; k < parameters; ++k) {
      const auto fixed = [](const Estimate& one) { return one.interval.low == one.interval.high; };
      if ((k == 2 && fixed(fitted.contaminants)) || (k == 3 && fixed(fitted.start))) continue;
      constexpr double step = 1e-4;
      const auto up = cells.joined(probabilities(moved(at, k, step), strata[s], bins[s])),
                 down = cells.joined(probabilities(moved(at, k, -step), strata[s], bins[s]));
      for (std::size_t i = 0; i < cells.size; ++i)
        jacobian(row + static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
            std::sqrt(strata[s].presented() / cells.probability[i]) * (up[i] - down[i]) / (2 * step);
    }
    row += static_cast<Eigen::Index>(cells.size);
  }
  for (Eigen::Index k = 0; k < jacobian.cols(); ++k)
    if (const double length = jacobian.col(k).norm(); length > 0) jacobian.col(k) /= length;
  const auto columns = jacobian.cols();
  const Eigen::LLT<Matrix> squares(jacobian.transpose() * jacobian +
                                   1e-9 * Matrix::Identity(columns, columns));
  const auto statistic = [&](const Vector& residuals) {
    return residuals.squaredNorm() -
           residuals.dot(jacobian * squares.solve(jacobian.transpose() * residuals));
  };
  const auto residuals_of = [&](const auto& counts_of) {
    Vector residuals(static_cast<Eigen::Index>(rows));
    Eigen::Index next = 0;
    for (std::size_t s = 0; s < strata.size(); ++s) {
      const auto counts = counts_of(s);
      for (std::size_t i = 0; i < expected[s].size; ++i) {
        const double mean = strata[s].presented() * expected[s].probability[i];
        residuals[next++] = (counts[i] - mean) / std::sqrt(mean);
      }
    }
    return residuals;
  };
  DiffusionCheck check;
  check.statistic = statistic(residuals_of([&](std::size_t s) { return expected[s].count; }));
  core::Draws draws({seed, core::Stream::bootstrap, 3000, stream, 0});
  for (int i = 0; i < kCheckReplicates; ++i)
    check.replicates.push_back(statistic(residuals_of([&](std::size_t s) {
      const auto& p = expected[s].probability;
      std::vector<double> counts(p.size());
      const auto presented = static_cast<int>(strata[s].presented());
      for (int trial = 0; trial < presented; ++trial) {
        double left = draws.uniform();
        std::size_t which = 0;
        while (which + 1 < p.size() && left >= p[which]) left -= p[which++];
        ++counts[which];
      }
      return counts;
    })));
  check.difficulties.resize(fitted.drift.size());
  for (const auto& stratum : strata) {
    auto& most = check.difficulties[stratum.difficulty];
    const int answered = static_cast<int>(stratum.times[0].size() + stratum.times[1].size());
    if (answered <= most.right.observed + most.wrong.observed) continue;
    most = {predicted(at, stratum, true), predicted(at, stratum, false)};
  }
  return check;
}

std::optional<double> share_as_bad(const std::vector<const DiffusionCheck*>& checks) {
  if (checks.empty()) return std::nullopt;
  double found = 0;
  std::vector<double> replicates(kCheckReplicates);
  for (const auto* check : checks) {
    found += check->statistic;
    for (std::size_t i = 0; i < replicates.size(); ++i) replicates[i] += check->replicates[i];
  }
  const auto worse =
      std::count_if(replicates.begin(), replicates.end(), [found](double one) { return one >= found; });
  return (1.0 + static_cast<double>(worse)) / (1.0 + static_cast<double>(replicates.size()));
}

}  // namespace turnpoint::analysis
