#include "station/analysis/dependence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "station/core/least_squares.hpp"

namespace turnpoint::analysis {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// pairs without which nothing is estimated: for choices; beyond the number of predictors for other answers
constexpr std::size_t kFewestPairs = 50, kFewestSpare = 10;
/// errors before a counted trial without which `after_error` is left out
constexpr int kFewestErrors = 5;
/// points of a curve: the most stimuli that have one each, and the fewest pairs for that; for groups of
/// stimuli the most and the fewest groups, and the fewest pairs of a group
constexpr std::size_t kMostStimuli = 12, kFewestOfStimulus = 8, kMostGroups = 7, kFewestGroups = 3,
                      kFewestOfGroup = 15;
/// gains in log-likelihood: of a search that has come to rest, and below which only rounding errors could
/// tell
constexpr double kRest = 1e-13, kSmall = 1e-8;

/// The penalised likelihood at one place: its logarithm, its gradient and the expected information.
struct Local {
  double log_likelihood = 0;
  Vector gradient;
  Matrix information;
};

class Penalised {
 public:
  Penalised(const Matrix& predictors, const Vector& answers) : x_(predictors), y_(answers) {}

  /// Climbs from `at` by scoring. With `held`, that coefficient stays as it is. Empty if the search does not
  /// come to rest.
  std::optional<Local> climb(Vector& at, std::optional<Eigen::Index> held) const {
    auto here = local(at);
    for (int round = 0;; ++round) {
      Vector gradient = here.gradient;
      Matrix information = here.information;
      if (held) {
        gradient[*held] = 0;
        information.row(*held).setZero(), information.col(*held).setZero();
        information(*held, *held) = 1;
      }
      Vector step = information.llt().solve(gradient);
      const double gain = gradient.dot(step) / 2;  // what a whole step would add
      if (!std::isfinite(gain)) return std::nullopt;
      if (gain < kRest || (round == 500 && gain < kSmall)) return here;
      if (round == 500) return std::nullopt;
      auto there = local(at + step);
      // a likelihood has rounding errors, so below kSmall it no longer tells whether a step is one up
      while (gain > kSmall && !(there.log_likelihood >= here.log_likelihood)) {
        if (step.norm() < 1e-12) return std::nullopt;
        step /= 2;
        there = local(at + step);
      }
      at += step, here = std::move(there);
    }
  }

 private:
  Local local(const Vector& at) const {
    const Vector logit = x_ * at;
    const auto p = (1 / (1 + (-logit.array()).exp())).eval();
    // ln(1 + e^z), which does not overflow
    const auto soft = (logit.array().max(0) + (-logit.array().abs()).exp().log1p()).eval();
    const Matrix weighted = (p * (1 - p)).matrix().asDiagonal() * x_;
    Local result;
    result.information = x_.transpose() * weighted;
    const Eigen::LLT<Matrix> solver(result.information);
    const Matrix factor = solver.matrixL();
    // with the penalty, half the logarithm of the determinant of the information
    result.log_likelihood = (y_.array() * logit.array() - soft).sum() + factor.diagonal().array().log().sum();
    if (solver.info() != Eigen::Success) result.log_likelihood = -std::numeric_limits<double>::infinity();
    const auto leverage =
        (weighted.array() * solver.solve(x_.transpose()).transpose().array()).rowwise().sum().eval();
    result.gradient = x_.transpose() * (y_.array() - p + leverage * (0.5 - p)).matrix();
    return result;
  }

  const Matrix& x_;
  const Vector& y_;
};

/// Returns where the profile of the coefficient `k` has fallen by what a 95 % interval allows; `direction` is
/// -1 or 1. After few errors the likelihood can have several maxima for a fixed coefficient, so the search
/// goes out from the best place until the profile is low enough, and then each place between is climbed to
/// from both sides. Those are chosen by Newton's rule on the root of twice the fall, which is nearly linear;
/// its slope is that of the penalised likelihood (envelope theorem).
std::optional<double> end_of(const Penalised& model, const Vector& best, double most, Eigen::Index k,
                             double sd, double direction) {
  double inside = 0, outside = std::numeric_limits<double>::infinity();  // distances from the best value
  Vector near = best, far;                                               // the maxima there
  double distance = kZ95 * sd, step = distance;
  for (int i = 0; i < 60; ++i) {
    Vector at = near;
    at[k] = best[k] + direction * distance;
    auto there = model.climb(at, k);
    if (std::isfinite(outside)) {
      far[k] = at[k];
      const auto other = model.climb(far, k);
      if (other && (!there || other->log_likelihood > there->log_likelihood)) there = other, at = far;
    }
    if (!there) return std::nullopt;
    const double root = std::sqrt(std::max(0.0, 2 * (most - there->log_likelihood)));
    const double next = distance - (kZ95 - root) * root / (direction * there->gradient[k]);
    if (root > kZ95)
      outside = distance, far = at;
    else
      inside = distance, near = at;
    if (std::isinf(outside)) {
      distance += step *= 1.5;
      continue;
    }
    const double least = 1e-9 * (sd + std::fabs(best[k])), middle = (inside + outside) / 2;
    if (std::fabs(next - distance) <= least) return best[k] + direction * next;
    if (outside - inside <= least) return best[k] + direction * middle;  // the profile has a step there
    distance = next > inside && next < outside ? next : middle;
  }
  return std::nullopt;
}

Matrix matrix_of(const std::vector<std::vector<double>>& rows) {
  Matrix x(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows.front().size()));
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    for (Eigen::Index k = 0; k < x.cols(); ++k)
      x(i, k) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
  return x;
}

/// Scales each column to a length of the root of its rows, so that steps and tolerances mean the same for all
/// units. Empty if the columns are linearly dependent.
std::optional<Vector> scale(Matrix& x) {
  const Vector unit = (x.colwise().norm() / std::sqrt(static_cast<double>(x.rows()))).transpose();
  if (!(unit.minCoeff() > 0) || !unit.allFinite()) return std::nullopt;
  x = x * unit.cwiseInverse().asDiagonal();
  Eigen::ColPivHouseholderQR<Matrix> solver(x);
  solver.setThreshold(3e-7);  // as core::least_squares()
  return solver.rank() == x.cols() ? std::optional(unit) : std::nullopt;
}

Estimate scaled(Estimate estimate, double unit) {
  estimate.value /= unit, estimate.interval.low /= unit, estimate.interval.high /= unit;
  return estimate;
}

/// Linear regression with intervals by Student's t.
Regression linear(const std::vector<std::vector<double>>& rows, const std::vector<double>& answers) {
  const auto columns = rows.front().size();
  if (rows.size() <= columns) return {{}, true};
  core::LeastSquares fit;
  try {
    fit = core::least_squares(rows, answers, std::vector<double>(rows.size(), 1));
  } catch (const core::UsageError&) {
    return {{}, true};
  }
  const boost::math::students_t law(static_cast<double>(rows.size() - columns));
  Regression result;
  for (std::size_t k = 0; k < fit.value.size(); ++k) {
    const double half = boost::math::quantile(law, 0.975) * fit.sd[k];
    auto& estimate = result.coefficients.emplace_back(
        Estimate{fit.value[k], {fit.value[k] - half, fit.value[k] + half, 0.95}});
    if (fit.sd[k] > 0) estimate.p = 2 * boost::math::cdf(law, -std::fabs(fit.value[k]) / fit.sd[k]);
  }
  return result;
}

/// A trial as the regression sees it.
struct TrialSeen {
  double stimulus = 0, answer = 0;
};

std::optional<TrialSeen> seen(const TrialRecord& trial, const DependenceOptions& options) {
  const bool noise = options.noise && trial.right_choice && *trial.right_choice != options.positive;
  if (!counted(trial) || !(trial.level || noise)) return std::nullopt;
  double level = noise ? 0 : options.decibel ? std::pow(10, *trial.level / 20) : *trial.level;
  switch (options.answers) {
    case Answers::sides:
      if (!trial.response) return std::nullopt;
      level = std::fabs(level - options.cut);
      if (level > 0 && !trial.right_choice) return std::nullopt;
      return TrialSeen{trial.right_choice == options.positive ? level : -level,
                       *trial.response == options.positive ? 0.5 : -0.5};
    case Answers::choices:
      if (!trial.response) return std::nullopt;
      return TrialSeen{level - options.cut, *trial.response == options.positive ? 0.5 : -0.5};
    case Answers::values:
    case Answers::settings:
      if (!trial.setting) return std::nullopt;
      return TrialSeen{level, *trial.setting};
    case Answers::logarithms:
      if (!trial.setting || !(*trial.setting > 0) || !(level > 0)) return std::nullopt;
      return TrialSeen{std::log10(level), std::log10(*trial.setting)};
  }
  return std::nullopt;
}

struct PairOfTrials {
  TrialSeen before, now;
  bool error = false;    ///< the answer before was wrong
  std::size_t mean = 0;  ///< number of the level or condition that has a mean of its own
};

/// The predictors of one answer: those of Dependence that vary, then the others: the constant or a mean for
/// each level and, beside after_error, the error itself.
struct Design {
  std::vector<std::optional<Estimate> Dependence::*> what;
  std::vector<std::vector<double>> rows;
};

Design design_of(const std::vector<PairOfTrials>& pairs, const DependenceOptions& options) {
  const bool means = options.answers == Answers::values || options.answers == Answers::logarithms;
  const auto varies = [&pairs](double TrialSeen::*what, TrialSeen PairOfTrials::*of) {
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const PairOfTrials& pair) { return pair.*of.*what != pairs.front().*of.*what; });
  };
  std::set<std::size_t> mean_of;
  int errors = 0;
  for (const auto& pair : pairs) mean_of.insert(pair.mean), errors += pair.error;
  const bool now = !means && varies(&TrialSeen::stimulus, &PairOfTrials::now),
             before = varies(&TrialSeen::stimulus, &PairOfTrials::before),
             answer = varies(&TrialSeen::answer, &PairOfTrials::before);
  const bool after = options.after_error && now && errors >= kFewestErrors;
  Design design;
  if (now) design.what.push_back(&Dependence::stimulus);
  if (before) design.what.push_back(&Dependence::previous_stimulus);
  if (answer) design.what.push_back(&Dependence::previous_answer);
  if (after) design.what.push_back(&Dependence::after_error);
  for (const auto& pair : pairs) {
    auto& row = design.rows.emplace_back();
    if (now) row.push_back(pair.now.stimulus);
    if (before) row.push_back(pair.before.stimulus);
    if (answer) row.push_back(pair.before.answer);
    if (after) row.push_back(pair.error ? pair.now.stimulus : 0);
    if (after) row.push_back(pair.error ? 1 : 0);  // a shift of the answers is no change of weight
    for (const auto number : mean_of) row.push_back(pair.mean == number ? 1 : 0);
  }
  return design;
}

bool is_logistic(const DependenceOptions& options) {
  return options.answers == Answers::sides || options.answers == Answers::choices;
}

/// The points of a curve without their shifts, and the number of the point to which each pair belongs.
struct Grouping {
  std::vector<AfterStimulus> points;
  std::vector<std::size_t> point_of;
};

Grouping grouped(const std::vector<PairOfTrials>& pairs) {
  std::map<double, std::size_t> counts;
  for (const auto& pair : pairs) ++counts[pair.before.stimulus];
  const bool each = counts.size() <= kMostStimuli && std::ranges::all_of(counts, [](const auto& entry) {
                      return entry.second >= kFewestOfStimulus;
                    });
  const auto groups =
      each ? counts.size() : std::min({kMostGroups, counts.size(), pairs.size() / kFewestOfGroup});
  if (groups < kFewestGroups) return {};
  // Equal stimuli stay together: each belongs where the middle of its pairs lies in their order.
  std::map<double, std::size_t> group_of;
  std::size_t before = 0;
  for (const auto& [stimulus, count] : counts) {
    group_of[stimulus] = each ? group_of.size() : (2 * before + count) * groups / (2 * pairs.size());
    before += count;
  }
  std::map<std::size_t, AfterStimulus> points;  // a stimulus with many pairs can leave a group empty
  for (const auto& pair : pairs) {
    auto& point = points[group_of[pair.before.stimulus]];
    ++point.pairs, point.stimulus += pair.before.stimulus;
  }
  Grouping result;
  std::map<std::size_t, std::size_t> number;
  for (auto& [group, point] : points) {
    if (!each && point.pairs < static_cast<int>(kFewestOfGroup)) return {};
    point.stimulus /= point.pairs;
    number[group] = result.points.size();
    result.points.push_back(point);
  }
  if (result.points.size() < kFewestGroups) return {};
  for (const auto& pair : pairs) result.point_of.push_back(number[group_of[pair.before.stimulus]]);
  return result;
}

/// The regression of estimate() with a shift for each point of the curve in place of a slope over the
/// stimulus before. The shifts add up to 0, so a column has 1 for its point and -1 for the last one. The last
/// point's shift comes from the same regression with another point in its place.
std::vector<AfterStimulus> curve_of(const std::vector<PairOfTrials>& pairs, const std::vector<double>& values,
                                    DependenceOptions options) {
  options.after_error = false;
  auto grouping = grouped(pairs);
  auto& points = grouping.points;
  if (points.empty()) return {};
  const auto design = design_of(pairs, options);
  const auto before = std::ranges::find(design.what, &Dependence::previous_stimulus) - design.what.begin();
  const auto shifts = [&](std::size_t without, std::size_t wanted) -> std::vector<Estimate> {
    std::vector<std::vector<double>> rows;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      auto& row = rows.emplace_back();
      const auto own = grouping.point_of[i];
      for (std::size_t k = 1; k < points.size(); ++k)
        row.push_back(own == without ? -1 : own == (without + k) % points.size() ? 1 : 0);
      for (std::size_t k = 0; k < design.rows[i].size(); ++k)
        if (static_cast<std::ptrdiff_t>(k) != before) row.push_back(design.rows[i][k]);
    }
    if (!is_logistic(options)) return linear(rows, values).coefficients;
    std::vector<bool> choices;
    for (const double value : values) choices.push_back(value > 0);
    return penalised_logistic(rows, choices, wanted).coefficients;
  };
  const auto last = points.size() - 1;
  auto found = shifts(last, last);           // those of the points 0 to last - 1
  const auto of_last = shifts(last - 1, 1);  // begins with that of the last point
  if (found.size() < last || of_last.empty()) return {};
  found.resize(last);
  found.push_back(of_last.front());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(found[i].interval.low) || !std::isfinite(found[i].interval.high)) return {};
    points[i].shift = found[i];
  }
  return std::move(points);
}

void estimate(const std::vector<PairOfTrials>& pairs, const DependenceOptions& options, Dependence& into) {
  const bool logistic = is_logistic(options);
  auto design = pairs.empty() ? Design{} : design_of(pairs, options);
  const auto columns = design.rows.empty() ? 0 : design.rows.front().size();
  if (const auto fewest = logistic ? kFewestPairs : columns + kFewestSpare; pairs.size() < fewest) {
    into.statements.push_back({"few-pairs", core::phrase("statement.few_pairs", {core::plain(fewest)})});
    return;
  }
  std::vector<bool> choices;
  std::vector<double> values;
  for (const auto& pair : pairs) choices.push_back(pair.now.answer > 0), values.push_back(pair.now.answer);
  const auto regression = [&]() -> Regression {
    if (design.what.empty()) return {{}, true};
    return logistic ? penalised_logistic(design.rows, choices, design.what.size())
                    : linear(design.rows, values);
  };
  auto found = regression();
  if (found.dependent && options.after_error) {  // perhaps only the errors cannot be told apart
    auto fewer = options;
    fewer.after_error = false;
    design = design_of(pairs, fewer);
    found = regression();
  }
  const auto& effects = found.coefficients;
  for (std::size_t i = 0; i < design.what.size() && i < effects.size(); ++i)
    into.*design.what[i] = effects[i];
  if (found.dependent)
    into.statements.push_back({"confounded-pairs", core::phrase("statement.confounded_pairs")});
  else if (effects.empty())
    into.statements.push_back({"search-failed", core::phrase("statement.search_failed")});
  if (into.previous_stimulus && options.answers != Answers::settings)
    into.curve = curve_of(pairs, values, options);
}

}  // namespace

Regression penalised_logistic(const std::vector<std::vector<double>>& rows, const std::vector<bool>& answers,
                              std::size_t wanted) {
  if (rows.empty()) return {};
  auto x = matrix_of(rows);
  const auto unit = scale(x);
  if (!unit) return {{}, true};
  Vector y(x.rows());
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = answers[static_cast<std::size_t>(i)] ? 1 : 0;
  const Penalised model(x, y);
  Vector best = Vector::Zero(x.cols());
  const auto top = model.climb(best, std::nullopt);
  if (!top) return {};
  const Matrix covariance = top->information.inverse();
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  Regression result;
  for (Eigen::Index k = 0; k < std::min(x.cols(), static_cast<Eigen::Index>(wanted)); ++k) {
    const double sd = std::sqrt(covariance(k, k));
    const auto low = end_of(model, best, top->log_likelihood, k, sd, -1),
               high = end_of(model, best, top->log_likelihood, k, sd, 1);
    Vector without = best;
    without[k] = 0;
    const auto null = model.climb(without, k);
    Estimate estimate{best[k], {low.value_or(-kUnknown), high.value_or(kUnknown), 0.95}};
    if (null) estimate.p = std::erfc(std::sqrt(std::max(0.0, top->log_likelihood - null->log_likelihood)));
    result.coefficients.push_back(scaled(estimate, (*unit)[k]));
  }
  return result;
}

std::vector<Dependence> serial_dependence(const std::vector<TrialRecord>& trials,
                                          const std::vector<std::string>& order,
                                          const DependenceOptions& options) {
  const auto conditions = conditions_of(trials, order);
  const bool pooled = options.answers == Answers::settings;
  const bool by_level = options.answers == Answers::values || options.answers == Answers::logarithms;
  std::vector<std::vector<PairOfTrials>> pairs(pooled ? 1 : conditions.size());
  std::map<double, std::size_t> levels;
  for (std::size_t i = 1; i < trials.size(); ++i) {
    const auto &before = trials[i - 1], &now = trials[i];
    if (!follows(before, now)) continue;
    const auto first = seen(before, options), second = seen(now, options);
    if (!first || !second) continue;
    const auto condition =
        static_cast<std::size_t>(std::ranges::find(conditions, now.instruction) - conditions.begin());
    PairOfTrials pair{*first, *second, before.correct == false};
    if (pooled) pair.mean = condition;
    if (by_level) pair.mean = levels.try_emplace(second->stimulus, levels.size()).first->second;
    pairs[pooled ? 0 : condition].push_back(pair);
  }
  std::vector<Dependence> all;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    auto& one = all.emplace_back();
    one.how = options;
    if (!pooled) one.condition = conditions[i];
    one.pairs = static_cast<int>(pairs[i].size());
    estimate(pairs[i], options, one);
  }
  return all;
}

}  // namespace turnpoint::analysis
