#include "station/analysis/diffusion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "station/analysis/first_passage.hpp"
#include "station/analysis/quantile.hpp"
#include "station/random/draws.hpp"
#include "station/text/number.hpp"

namespace turnpoint::analysis {

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr double kNearChance = 1e-3;
constexpr double kDriftPriorSd = 10;      // per s, with s = 1
constexpr double kContaminantPrior = 19;  // Beta(1, 19)
constexpr int kPosteriorDraws = 1000, kAdaptations = 4;
constexpr double kEnoughDraws = 400;  // effective draws that end the adaptation
constexpr int kFewestAnswers = 10;    // answers

/// The parameters as the search sees them, unbounded: logarithm of the boundary and of the non-decision time,
/// logit of the proportion of contaminants, then the drifts; all with s = 1.
enum Index { kBoundary, kNondecision, kContaminants, kFirstDrift };

double log_add(double a, double b) {
  if (a < b) std::swap(a, b);
  return std::isinf(b) ? a : a + std::log1p(std::exp(b - a));
}

/// The negative logarithm of the posterior density of the parameters.
class Posterior {
 public:
  Posterior(const std::vector<DiffusionTrial>& trials, std::size_t difficulties)
      : difficulties_(difficulties) {
    double longest = 0;
    for (const auto& trial : trials)
      if (trial.outcome == DiffusionTrial::Outcome::answered) longest = std::max(longest, trial.time_s);
    std::map<std::array<double, 4>, double> rest;
    for (const auto& trial : trials) {
      const double window = trial.deadline_s ? 2 * std::max(*trial.deadline_s, trial.time_s) : longest;
      if (trial.outcome == DiffusionTrial::Outcome::answered)
        answers_.push_back({trial.difficulty, trial.correct, trial.time_s, -std::log(2 * window)});
      else
        ++rest[{static_cast<double>(trial.difficulty),
                trial.outcome == DiffusionTrial::Outcome::late ? 1.0 : 0.0, trial.time_s, window}];
    }
    for (const auto& [what, count] : rest)
      censored_.push_back(
          {static_cast<std::size_t>(what[0]), what[1] > 0, what[2],
           std::log(std::clamp(what[1] > 0 ? 1 - what[2] / what[3] : what[2] / what[3], 1e-9, 1.0)), count});
  }

  std::size_t size() const { return kFirstDrift + difficulties_; }

  double operator()(const Vector& theta) const {
    const double a = std::exp(theta[kBoundary]), ter = std::exp(theta[kNondecision]);
    const double share = 1 / (1 + std::exp(-theta[kContaminants]));
    if (!(a > 1e-3 && a < 1e3 && ter < 1e3 && share > 1e-12 && share < 1)) return kImpossible;
    const double log_share = std::log(share), log_rest = std::log1p(-share);
    double sum = log_share + kContaminantPrior * log_rest + theta[kNondecision];
    for (std::size_t i = 0; i < difficulties_; ++i) {
      const double v = theta[static_cast<Eigen::Index>(kFirstDrift + i)];
      sum -= v * v / (2 * kDriftPriorSd * kDriftPriorSd);
    }
    for (const auto& answer : answers_) {
      const Diffusion d{theta[static_cast<Eigen::Index>(kFirstDrift + answer.difficulty)], a, 0.5};
      sum += log_add(log_rest + log_density(d, answer.correct, answer.time_s - ter),
                     log_share + answer.log_contaminant);
    }
    for (const auto& trial : censored_) {
      const Diffusion d{theta[static_cast<Eigen::Index>(kFirstDrift + trial.difficulty)], a, 0.5};
      const double survival = log_survival(d, trial.time_s - ter);
      const double decision = trial.late ? survival : std::log(std::max(-std::expm1(survival), 1e-300));
      sum += trial.count * log_add(log_rest + decision, log_share + trial.log_contaminant);
    }
    return std::isfinite(sum) ? -sum : kImpossible;
  }

  static constexpr double kImpossible = 1e100;

 private:
  struct Answer {
    std::size_t difficulty;
    bool correct;
    double time_s, log_contaminant;
  };
  struct Censored {
    std::size_t difficulty;
    bool late;
    double time_s, log_contaminant, count;
  };
  std::size_t difficulties_;
  std::vector<Answer> answers_;
  std::vector<Censored> censored_;
};

Vector gradient(const Posterior& f, const Vector& at) {
  Vector result(at.size());
  Vector x = at;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    constexpr double step = 1e-5;
    x[i] = at[i] + step;
    const double up = f(x);
    x[i] = at[i] - step;
    result[i] = (up - f(x)) / (2 * step);
    x[i] = at[i];
  }
  return result;
}

Matrix hessian(const Posterior& f, const Vector& at) {
  constexpr double step = 1e-3;
  Matrix result(at.size(), at.size());
  Vector x = at;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    x[i] = at[i] + step;
    const Vector up = gradient(f, x);
    x[i] = at[i] - step;
    result.col(i) = (up - gradient(f, x)) / (2 * step);
    x[i] = at[i];
  }
  return (result + result.transpose()) / 2;
}

/// Finds the mode by the BFGS method with a search along each direction that halves the step until the value
/// falls.
Vector mode_from(const Posterior& f, Vector x) {
  const auto n = x.size();
  Matrix inverse = Matrix::Identity(n, n) * 1e-2;
  double value = f(x);
  Vector slope = gradient(f, x);
  for (int round = 0; round < 200; ++round) {
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

Vector start_of(const std::vector<DiffusionTrial>& trials, std::size_t difficulties) {
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
  const double early = quantile(all, 0.05), spread = quantile(all, 0.75) - quantile(all, 0.25);
  DiffusionParameters start{0.1, kDiffusionScale * std::clamp(2 * std::sqrt(spread + 0.05), 0.5, 4.0),
                            0.8 * early};
  if (right.size() > 2)
    if (const auto ez = ez_diffusion(static_cast<double>(right.size()) / static_cast<double>(all.size()),
                                     static_cast<int>(all.size()), mean(right), variance(right));
        ez && ez->nondecision_s > 0.1 * early && ez->nondecision_s < early)
      start = *ez;
  Vector x(static_cast<Eigen::Index>(kFirstDrift + difficulties));
  const double a = start.boundary / kDiffusionScale;
  x[kBoundary] = std::log(a);
  x[kNondecision] = std::log(std::max(std::min(start.nondecision_s, 0.9 * early), 1e-3));
  x[kContaminants] = std::log(0.02 / 0.98);
  for (std::size_t i = 0; i < difficulties; ++i) {
    const double p = (correct[i] + 0.5) / (answered[i] + 1.0);
    x[static_cast<Eigen::Index>(kFirstDrift + i)] = std::clamp(std::log(p / (1 - p)) / a, -6.0, 6.0);
  }
  return x;
}

/// Weighted draws from the posterior.
struct WeightedDraws {
  std::vector<Vector> at;
  std::vector<double> weight;  // their sum is 1
  double effective = 0;
};

/// Draws from a t distribution with 6 degrees of freedom, and weights the draws by the posterior density.
WeightedDraws draw(const Posterior& f, const Vector& centre, const Matrix& covariance, random::Draws& draws) {
  constexpr int freedom = 6;
  const auto n = centre.size();
  const Matrix root = covariance.llt().matrixL();
  WeightedDraws sample;
  std::vector<double> log_weight;
  for (int i = 0; i < kPosteriorDraws; ++i) {
    Vector z(n);
    for (Eigen::Index k = 0; k < n; ++k) z[k] = draws.normal();
    double chi2 = 0;
    for (int k = 0; k < freedom; ++k) {
      const double g = draws.normal();
      chi2 += g * g;
    }
    const double stretch = freedom / chi2;
    sample.at.push_back(centre + std::sqrt(stretch) * (root * z));
    const double log_proposal =
        -0.5 * static_cast<double>(freedom + n) * std::log1p(z.squaredNorm() * stretch / freedom);
    const double value = f(sample.at.back());
    log_weight.push_back(value < Posterior::kImpossible ? -value - log_proposal
                                                        : -std::numeric_limits<double>::infinity());
  }
  const double highest = *std::max_element(log_weight.begin(), log_weight.end());
  double sum = 0, squares = 0;
  for (const double w : log_weight) {
    sample.weight.push_back(std::exp(w - highest));
    sum += sample.weight.back();
  }
  for (auto& w : sample.weight) w /= sum, squares += w * w;
  sample.effective = 1 / squares;
  return sample;
}

/// Returns draws of equal weight (systematic resampling), in the order of the sample.
std::vector<Vector> equally_weighted(const WeightedDraws& sample, double offset) {
  std::vector<Vector> result;
  double reached = 0;
  std::size_t i = 0;
  for (int k = 0; k < kPosteriorDraws; ++k) {
    const double wanted = (k + offset) / kPosteriorDraws;
    while (i + 1 < sample.weight.size() && reached + sample.weight[i] < wanted) reached += sample.weight[i++];
    result.push_back(sample.at[i]);
  }
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

DiffusionFit fit_diffusion(const std::vector<DiffusionTrial>& trials, std::size_t difficulties,
                           std::uint64_t seed, int stream, double confidence) {
  DiffusionFit result;
  const auto answers = std::count_if(trials.begin(), trials.end(), [](const auto& trial) {
    return trial.outcome == DiffusionTrial::Outcome::answered;
  });
  if (answers < kFewestAnswers) {
    result.statements.push_back(
        {"diffusion-too-few", texts::phrase("statement.diffusion_too_few", {texts::plain(kFewestAnswers)})});
    return result;
  }
  const Posterior posterior(trials, difficulties);
  auto centre = mode_from(posterior, start_of(trials, difficulties));
  Matrix covariance;
  {
    Matrix curvature = hessian(posterior, centre);
    for (double ridge = 0;; ridge = ridge == 0 ? 1e-3 : ridge * 10) {
      const Eigen::LLT<Matrix> factor(curvature +
                                      ridge * Matrix::Identity(curvature.rows(), curvature.cols()));
      if (factor.info() == Eigen::Success && ridge < 1e6) {
        covariance = factor.solve(Matrix::Identity(curvature.rows(), curvature.cols()));
        break;
      }
      if (!(ridge < 1e6)) {
        covariance = 0.01 * Matrix::Identity(curvature.rows(), curvature.cols());
        break;
      }
    }
    // a nearly flat direction must not send most of the draws to where nothing is possible
    for (Eigen::Index i = 0; i < covariance.rows(); ++i)
      if (const double sd = std::sqrt(covariance(i, i)); sd > 2) {
        covariance.row(i) *= 2 / sd;
        covariance.col(i) *= 2 / sd;
      }
  }
  random::Draws draws({seed, random::Stream::bootstrap, 2000, stream, 0});
  WeightedDraws sample = draw(posterior, centre, 1.2 * covariance, draws);
  for (int round = 1; round < kAdaptations && sample.effective < kEnoughDraws; ++round) {
    Vector mean = Vector::Zero(centre.size());
    for (std::size_t i = 0; i < sample.at.size(); ++i) mean += sample.weight[i] * sample.at[i];
    Matrix spread = 0.02 * covariance;
    for (std::size_t i = 0; i < sample.at.size(); ++i)
      spread += sample.weight[i] * (sample.at[i] - mean) * (sample.at[i] - mean).transpose();
    auto again = draw(posterior, mean, 1.2 * spread, draws);
    if (again.effective > sample.effective) sample = std::move(again);
    covariance = spread;
  }
  const auto log_boundary = estimate(sample, confidence, [](const Vector& x) { return x[kBoundary]; });
  if (sample.effective < 30 || log_boundary.interval.high - log_boundary.interval.low > std::log(20)) {
    result.statements.push_back(
        {"diffusion-not-determined", texts::phrase("statement.diffusion_not_determined")});
    return result;
  }
  DiffusionEstimates found;
  found.effective_draws = sample.effective;
  found.boundary =
      estimate(sample, confidence, [](const Vector& x) { return kDiffusionScale * std::exp(x[kBoundary]); });
  found.nondecision_s =
      estimate(sample, confidence, [](const Vector& x) { return std::exp(x[kNondecision]); });
  found.contaminants =
      estimate(sample, confidence, [](const Vector& x) { return 1 / (1 + std::exp(-x[kContaminants])); });
  for (std::size_t i = 0; i < difficulties; ++i)
    found.drift.push_back(estimate(sample, confidence, [i](const Vector& x) {
      return kDiffusionScale * x[static_cast<Eigen::Index>(kFirstDrift + i)];
    }));
  for (const auto& x : equally_weighted(sample, draws.uniform())) {
    DiffusionDraw one{kDiffusionScale * std::exp(x[kBoundary]),
                      std::exp(x[kNondecision]),
                      1 / (1 + std::exp(-x[kContaminants])),
                      {}};
    for (std::size_t i = 0; i < difficulties; ++i)
      one.drift.push_back(kDiffusionScale * x[static_cast<Eigen::Index>(kFirstDrift + i)]);
    found.draws.push_back(std::move(one));
  }
  result.estimates = std::move(found);
  return result;
}

}  // namespace turnpoint::analysis
