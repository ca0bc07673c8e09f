#include "station/analysis/scaling.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "physics/nnls.hpp"
#include "station/analysis/proportion.hpp"
#include "station/core/draws.hpp"

namespace turnpoint::analysis {

namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
/// Most entries of a trial's row are 0.
using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Half the 95 % point of chi squared with one degree of freedom.
constexpr double kProfileDrop = kZ95 * kZ95 / 2;

bool in_pairs(ScaleModel model) { return model != ScaleModel::differences; }

/// A trial as the model sees it: a pair, or two differences, each in ascending order, of which the upper one
/// counts as the answer. A triad compares the difference of its first two stimuli with that of its last two.
struct Oriented {
  std::vector<int> stimuli;
  double order = 1;  ///< weight of the tendency to answer "second"; negative if it was turned round
};

Oriented oriented(const std::vector<int>& stimuli) {
  Oriented turned{stimuli, 1};
  auto& s = turned.stimuli;
  if (s.size() == 2) return turned;
  if (s.size() == 3) s.insert(s.begin() + 1, s[1]);
  if (s[0] > s[1]) std::swap(s[0], s[1]);
  if (s[2] > s[3]) std::swap(s[2], s[3]);
  if (std::pair(s[0], s[1]) > std::pair(s[2], s[3]))
    std::swap(s[0], s[2]), std::swap(s[1], s[3]), turned.order = -1;
  return turned;
}

/// The weight of each stimulus in what is compared.
VectorXd weights_of(const std::vector<int>& s, int stimuli) {
  VectorXd weights = VectorXd::Zero(stimuli);
  if (s.size() == 2) {
    weights[s[1]] += 1, weights[s[0]] -= 1;
  } else {
    weights[s[3]] += 1, weights[s[2]] -= 1, weights[s[1]] -= 1, weights[s[0]] += 1;
  }
  return weights;
}

template <class Trial>
void require(const std::vector<Trial>& trials, int stimuli, ScaleModel model) {
  if (stimuli < (in_pairs(model) ? 2 : 3)) throw std::invalid_argument("scale: too few stimuli");
  for (const auto& trial : trials) {
    const auto n = trial.stimuli.size();
    if (in_pairs(model) ? n != 2 : n != 3 && n != 4)
      throw std::invalid_argument("scale: a trial has the wrong number of stimuli");
    for (const int s : trial.stimuli)
      if (s < 0 || s >= stimuli) throw std::invalid_argument("scale: unknown stimulus");
  }
}

/// The trials, with those of the same presentation together. The first stimulus has the value 0, so that the
/// parameters are the values of the others and, last, the tendency to answer "second".
struct Presentations {
  Rows rows;                                 ///< one for each presentation
  VectorXd upper, trials;                    ///< numbers of answers
  std::vector<std::vector<int>> quadruples;  ///< of each presentation; empty for pairs and triads
  std::vector<std::size_t> cell;             ///< the presentation of each trial
  std::vector<bool> answers;                 ///< of each trial
  bool order = false;                        ///< whether the last parameter is the tendency
  bool logistic = false;
  double penalty = 1;  ///< weight of Jeffreys' prior
};

bool has_full_rank(const MatrixXd& rows) {
  if (rows.rows() < rows.cols()) return false;
  Eigen::ColPivHouseholderQR<MatrixXd> solver(rows);
  solver.setThreshold(1e-9);
  return solver.rank() == rows.cols();
}

/// Empty if the trials do not determine the scale.
std::optional<Presentations> presentations_of(const std::vector<ExpectedComparisons>& trials, int stimuli,
                                              ScaleModel model) {
  require(trials, stimuli, model);
  Presentations shown;
  shown.logistic = model == ScaleModel::bradley_terry;
  std::map<std::pair<std::vector<int>, double>, std::size_t> known;
  std::vector<VectorXd> rows;
  std::vector<double> upper, count;
  for (const auto& trial : trials) {
    const auto turned = oriented(trial.stimuli);
    const auto [found, is_new] = known.try_emplace({turned.stimuli, turned.order}, rows.size());
    if (is_new) {
      VectorXd row(stimuli);
      row << weights_of(turned.stimuli, stimuli).tail(stimuli - 1), turned.order;
      rows.push_back(std::move(row)), upper.push_back(0), count.push_back(0);
      shown.quadruples.push_back(trial.stimuli.size() == 4 ? turned.stimuli : std::vector<int>{});
    }
    const double more = turned.order < 0 ? trial.trials - trial.second : trial.second;
    upper[found->second] += more, count[found->second] += trial.trials;
    shown.cell.push_back(found->second), shown.answers.push_back(more > 0.5 * trial.trials);
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  MatrixXd all(n, stimuli);
  for (Eigen::Index i = 0; i < n; ++i) all.row(i) = rows[static_cast<std::size_t>(i)];
  shown.upper = Eigen::Map<const VectorXd>(upper.data(), n);
  shown.trials = Eigen::Map<const VectorXd>(count.data(), n);
  // A tendency can only be told from the scale if pairs, or differences, were presented in both orders.
  int forth = 0, back = 0;
  for (const auto& [presentation, cell] : known) {
    const auto& [s, order] = presentation;
    ++(order < 0 || (s.size() == 2 && s[0] > s[1]) ? back : forth);
  }
  const bool both_orders = forth > 0 && back > 0;
  shown.order = both_orders && has_full_rank(all);
  if (!shown.order) all.conservativeResize(Eigen::NoChange, stimuli - 1);
  if (!shown.order && !has_full_rank(all)) return std::nullopt;
  shown.rows = all.sparseView();
  return shown;
}

std::optional<Presentations> presentations_of(const std::vector<Compared>& trials, int stimuli,
                                              ScaleModel model) {
  std::vector<ExpectedComparisons> single;
  for (const auto& trial : trials) single.push_back({trial.stimuli, 1, trial.second ? 1.0 : 0.0});
  return presentations_of(single, stimuli, model);
}

/// The probability of an answer and what the fit needs of it.
struct Point {
  double log_p = 0, log_q = 0;  ///< logarithms of the probability and of its complement
  double p = 0;
  double score = 0, counter = 0;  ///< derivatives of log_p and, negative, of log_q
  double weight = 0;              ///< information about the place
  double bend = 0;                ///< derivative of the logarithm of the weight
};

Point logistic_at(double x) {
  Point at;
  at.log_p = x > 0 ? -std::log1p(std::exp(-x)) : x - std::log1p(std::exp(x));
  at.log_q = at.log_p - x;
  at.p = std::exp(at.log_p);
  const double q = std::exp(at.log_q);
  at.score = q, at.counter = at.p, at.weight = at.p * q, at.bend = q - at.p;
  return at;
}

/// The logarithm of the normal distribution function, and its derivative.
std::pair<double, double> log_normal_at(double x) {
  constexpr double far = -30;
  if (x > far) {
    const double p = normal_cdf(x);
    return {std::log(p), normal_density(x) / p};
  }
  // Here p would soon be 0 in doubles. Laplace's continued fraction has converged to 1e-14.
  double fraction = -x;
  for (int k = 8; k > 0; --k) fraction = -x + k / fraction;
  return {-x * x / 2 - std::log(2 * std::numbers::pi) / 2 - std::log(fraction), fraction};
}

Point normal_at(double x) {
  Point at;
  std::tie(at.log_p, at.score) = log_normal_at(x);
  std::tie(at.log_q, at.counter) = log_normal_at(-x);
  at.p = std::exp(at.log_p);
  at.weight = at.score * at.counter;
  at.bend = -2 * x - at.score + at.counter;
  return at;
}

Point point_at(double x, bool logistic) { return logistic ? logistic_at(x) : normal_at(x); }

/// The penalised log likelihood of all parameters and its derivatives.
struct Ascent {
  double value = -kInfinite;
  VectorXd gradient;
  MatrixXd information;
};

/// No answers are so sure; a search that comes here goes astray.
constexpr double kFarthest = 1e4;

Ascent ascent_at(const Presentations& shown, const VectorXd& at) {
  Ascent ascent;
  const VectorXd places = shown.rows * at;
  const auto n = places.size();
  if (!(places.cwiseAbs().maxCoeff() < kFarthest)) return ascent;
  std::vector<Point> points;
  VectorXd weights(n);
  double sum = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& point = points.emplace_back(point_at(places[i], shown.logistic));
    weights[i] = shown.trials[i] * point.weight;
    sum += shown.upper[i] * point.log_p + (shown.trials[i] - shown.upper[i]) * point.log_q;
  }
  const auto parameters = at.size();
  ascent.information = MatrixXd::Zero(parameters, parameters);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Rows::InnerIterator a(shown.rows, i); a; ++a)
      for (Rows::InnerIterator b(shown.rows, i); b; ++b)
        ascent.information(a.col(), b.col()) += weights[i] * a.value() * b.value();
  const Eigen::LLT<MatrixXd> solver(ascent.information);
  if (solver.info() != Eigen::Success) return ascent;
  const MatrixXd half = solver.matrixL().solve(MatrixXd::Identity(parameters, parameters));
  VectorXd scores(n), leverage(parameters);
  for (Eigen::Index i = 0; i < n; ++i) {
    leverage.setZero();
    for (Rows::InnerIterator entry(shown.rows, i); entry; ++entry)
      leverage += entry.value() * half.col(entry.col());
    const auto& point = points[static_cast<std::size_t>(i)];
    scores[i] = shown.upper[i] * point.score - (shown.trials[i] - shown.upper[i]) * point.counter +
                shown.penalty * weights[i] * leverage.squaredNorm() * point.bend / 2;
  }
  ascent.gradient = shown.rows.transpose() * scores;
  ascent.value = sum + shown.penalty * MatrixXd(solver.matrixL()).diagonal().array().log().sum();
  return ascent;
}

/// A linear restriction of the parameters: along . parameters = value. Without one, `along` is empty.
struct Restriction {
  VectorXd along;
  double value = 0;
};

/// A basis of the parameters that a restriction leaves free.
MatrixXd free_of(const Restriction& restriction, Eigen::Index parameters) {
  if (restriction.along.size() == 0) return MatrixXd::Identity(parameters, parameters);
  const Eigen::HouseholderQR<MatrixXd> turned(restriction.along);
  const MatrixXd all = turned.householderQ() * MatrixXd::Identity(parameters, parameters);
  return all.rightCols(parameters - 1);
}

struct Summit {
  VectorXd at;
  double value = -kInfinite;
};

/// The place nearest to `from` that meets the restriction.
VectorXd onto(const Restriction& restriction, VectorXd from) {
  if (restriction.along.size() > 0)
    from += restriction.along * (restriction.value - restriction.along.dot(from)) /
            restriction.along.squaredNorm();
  return from;
}

/// Climbs by Fisher's scoring, with shorter steps where a whole one would not lead upwards.
std::optional<Summit> summit(const Presentations& shown, const VectorXd& from,
                             const Restriction& restriction = {}) {
  const MatrixXd free = free_of(restriction, shown.rows.cols());
  VectorXd at = onto(restriction, from);
  auto here = ascent_at(shown, at);
  if (here.value == -kInfinite) {
    at = onto(restriction, VectorXd::Zero(shown.rows.cols()));
    here = ascent_at(shown, at);
  }
  if (here.value == -kInfinite) return std::nullopt;
  for (int round = 0; round < 200; ++round) {
    if (free.cols() == 0) return Summit{at, here.value};
    const VectorXd gradient = free.transpose() * here.gradient;
    const MatrixXd information = free.transpose() * here.information * free;
    VectorXd step = free * information.llt().solve(gradient);
    const double gain = here.gradient.dot(step) / 2;
    if (!std::isfinite(gain)) return std::nullopt;
    if (gain < 1e-13) return Summit{at, here.value};
    auto there = ascent_at(shown, at + step);
    for (int halved = 0; halved < 40 && !(there.value >= here.value); ++halved) {
      step /= 2;
      there = ascent_at(shown, at + step);
    }
    if (!(there.value > here.value) && gain < 1e-7)  // only rounding errors are left
      return Summit{at, here.value};
    if (!(there.value >= here.value)) return std::nullopt;
    at += step, here = std::move(there);
  }
  return std::nullopt;
}

/// The end of an interval, on one side of the estimate: where the profile has fallen by kProfileDrop. Steps
/// of growing length find a value beyond it. Then the root of the fall, which is nearly a straight line, says
/// where to look. Infinite if the profile does not fall so far.
double profile_end(const Presentations& shown, const Summit& best, double estimate, double step,
                   const std::function<Restriction(double)>& restricted) {
  const double wanted = std::sqrt(kProfileDrop);
  VectorXd near = best.at;
  const auto root_at = [&](double value) {
    const auto found = summit(shown, near, restricted(value));
    if (!found) return kInfinite;
    near = found->at;
    return std::sqrt(std::max(0.0, best.value - found->value));
  };
  double inside = estimate, outside = estimate + step, root_in = 0, root_out = root_at(outside);
  for (int steps = 0; root_out < wanted; ++steps) {
    if (steps == 24) return step > 0 ? kInfinite : -kInfinite;
    step *= 1.5;
    inside = outside, root_in = root_out;
    outside = inside + step, root_out = root_at(outside);
  }
  for (int tries = 0; tries < 60; ++tries) {
    const double share = std::isfinite(root_out) ? (wanted - root_in) / (root_out - root_in) : 0.5;
    // Every third value is the middle, in case the line is bent.
    const double value = inside + (outside - inside) * (tries % 3 == 2 ? 0.5 : share);
    const double root = root_at(value);
    if (std::fabs(root - wanted) < 1e-6) return value;
    (root < wanted ? inside : outside) = value;
    (root < wanted ? root_in : root_out) = root;
  }
  return (inside + outside) / 2;
}

Estimate profile_interval(const Presentations& shown, const Summit& best, double estimate, double sd,
                          const std::function<Restriction(double)>& restricted) {
  return {estimate,
          {profile_end(shown, best, estimate, -kZ95 * sd, restricted),
           profile_end(shown, best, estimate, kZ95 * sd, restricted), 0.95}};
}

/// The interval of a weighted sum of the parameters.
Estimate interval_along(const Presentations& shown, const Summit& best, const MatrixXd& covariance,
                        const VectorXd& along) {
  const double sd = std::sqrt(along.dot(covariance * along));
  return profile_interval(shown, best, along.dot(best.at), sd, [&](double value) {
    return Restriction{along, value};
  });
}

/// What a parameter of 1 is in the unit of the scale: Thurstone's unit is the standard deviation of one
/// stimulus, not of a difference.
double unit_of(ScaleModel model) { return model == ScaleModel::thurstone ? std::sqrt(2.0) : 1; }

Estimate in_unit(Estimate estimate, double unit) {
  for (auto* number : {&estimate.value, &estimate.interval.low, &estimate.interval.high}) *number *= unit;
  return estimate;
}

void add_pair_values(const Presentations& shown, const Summit& best, const MatrixXd& covariance, int stimuli,
                     double unit, ScaleFit& fit) {
  for (int i = 0; i < stimuli; ++i) {
    VectorXd along = VectorXd::Zero(shown.rows.cols());
    along.head(stimuli - 1).setConstant(-1.0 / stimuli);
    if (i > 0) along[i - 1] += 1;
    fit.values.push_back(in_unit(interval_along(shown, best, covariance, along), unit));
  }
}

/// The values relative to that of the last stimulus. A ratio is held at r where the value minus r times the
/// last one is 0. False if the last one is not reliably above 0.
bool add_difference_values(const Presentations& shown, const Summit& best, const MatrixXd& covariance,
                           int stimuli, ScaleFit& fit) {
  const auto last = static_cast<Eigen::Index>(stimuli) - 2;
  VectorXd whole = VectorXd::Zero(shown.rows.cols());
  whole[last] = 1;
  const auto range = interval_along(shown, best, covariance, whole);
  if (!(range.interval.low > 0)) return false;
  fit.noise = Estimate{1 / range.value, {1 / range.interval.high, 1 / range.interval.low, 0.95}};
  fit.values.push_back({0, {0, 0, 0.95}});
  for (Eigen::Index i = 0; i < last; ++i) {
    const double ratio = best.at[i] / range.value;
    const auto restricted = [&](double value) {
      Restriction held{VectorXd::Zero(shown.rows.cols()), 0};
      held.along[i] = 1, held.along[last] = -value;
      return held;
    };
    const VectorXd along = restricted(ratio).along;
    const double sd = std::sqrt(along.dot(covariance * along)) / range.value;
    fit.values.push_back(profile_interval(shown, best, ratio, sd, restricted));
  }
  fit.values.push_back({1, {1, 1, 0.95}});
  return true;
}

/// Whether the answers set no limit to some distance: there is a direction of the parameters in which the
/// probability of no trial's answer falls, and that of some rises (Albert & Anderson 1984, Biometrika
/// 71:1-10). The sum of the trials' directions, made as short as possible by adding more of them, is such a
/// direction, unless it becomes 0. Only trials that have to be added are: those that the direction found so
/// far contradicts.
bool is_separated(const Presentations& shown) {
  std::vector<VectorXd> upwards;  // for each trial, the direction in which its answer becomes more probable
  VectorXd sum = VectorXd::Zero(shown.rows.cols());
  for (Eigen::Index i = 0; i < shown.rows.rows(); ++i) {
    const VectorXd row = VectorXd(shown.rows.row(i)).normalized();
    const bool one_answer = shown.upper[i] == 0 || shown.upper[i] == shown.trials[i];
    if (shown.upper[i] > 0) upwards.push_back(row);
    if (shown.upper[i] < shown.trials[i]) upwards.push_back(-row);
    if (one_answer) sum += upwards.back();
  }
  constexpr double none = 1e-6, rounding = 1e-9;
  VectorXd direction = sum;
  std::vector<double> columns;
  std::set<std::size_t> added;
  while (direction.norm() > none * sum.norm()) {
    std::vector<std::pair<double, std::size_t>> against;
    for (std::size_t i = 0; i < upwards.size(); ++i)
      if (const double along = upwards[i].dot(direction);
          along < -rounding * direction.norm() && !added.contains(i))
        against.emplace_back(along, i);
    if (against.empty()) return true;
    std::ranges::sort(against);
    if (std::ssize(against) > 2 * sum.size()) against.resize(static_cast<std::size_t>(2 * sum.size()));
    for (const auto& [along, i] : against) {
      added.insert(i);
      columns.insert(columns.end(), upwards[i].begin(), upwards[i].end());
    }
    const VectorXd wanted = -sum;
    const auto rows = static_cast<std::size_t>(sum.size());
    const auto found = physics::nnls(columns, rows, {wanted.data(), rows}, rounding);
    direction = sum + Eigen::Map<const MatrixXd>(columns.data(), sum.size(), std::ssize(found.x)) *
                          Eigen::Map<const VectorXd>(found.x.data(), std::ssize(found.x));
  }
  return false;
}

struct Likelihoods {
  double model = 0, saturated = 0;
};

Likelihoods likelihoods_at(const Presentations& shown, const VectorXd& at) {
  Likelihoods sums;
  const VectorXd places = shown.rows * at;
  for (Eigen::Index i = 0; i < places.size(); ++i) {
    const double k = shown.upper[i], n = shown.trials[i];
    const auto point = point_at(places[i], shown.logistic);
    sums.model += k * point.log_p + (n - k) * point.log_q;
    if (k > 0) sums.saturated += k * std::log(k / n);
    if (k < n) sums.saturated += (n - k) * std::log((n - k) / n);
  }
  return sums;
}

double deviance_of(const Presentations& shown, const VectorXd& at) {
  const auto sums = likelihoods_at(shown, at);
  return 2 * (sums.saturated - sums.model);
}

/// Runs of answers of the same sign, with the trials in order of the expected probability.
int runs_of(const std::vector<std::size_t>& order, const std::vector<bool>& answers) {
  int runs = order.empty() ? 0 : 1;
  for (std::size_t i = 1; i < order.size(); ++i) runs += answers[order[i]] != answers[order[i - 1]] ? 1 : 0;
  return runs;
}

std::vector<std::size_t> by_place(const Presentations& shown, const VectorXd& at) {
  const VectorXd places = shown.rows * at;
  std::vector<std::size_t> order(shown.cell.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return places[static_cast<Eigen::Index>(shown.cell[a])] <
           places[static_cast<Eigen::Index>(shown.cell[b])];
  });
  return order;
}

/// Replaces the answers by some drawn with these probabilities of the presentations.
void draw_answers(const VectorXd& probabilities, core::Draws& draws, Presentations& shown) {
  shown.upper.setZero();
  for (std::size_t i = 0; i < shown.cell.size(); ++i) {
    const auto cell = static_cast<Eigen::Index>(shown.cell[i]);
    const bool upper = draws.uniform() < probabilities[cell];
    shown.answers[i] = upper;
    shown.upper[cell] += upper ? 1 : 0;
  }
}

/// The presentations of the trials whose answers the six-point property restricts.
struct SixPoints {
  int sets = 0;
  VectorXd times;  ///< by presentation: number of sets to which it belongs
};

SixPoints six_points_of(const Presentations& shown, int stimuli) {
  using Quadruple = std::array<int, 4>;
  std::map<Quadruple, std::vector<Eigen::Index>> cells;
  for (std::size_t i = 0; i < shown.quadruples.size(); ++i)
    if (const auto& s = shown.quadruples[i]; !s.empty())
      cells[{s[0], s[1], s[2], s[3]}].push_back(static_cast<Eigen::Index>(i));
  SixPoints found{0, VectorXd::Zero(shown.rows.rows())};
  const auto of = [&cells](int a, int b, int d, int e) {
    return cells.find(std::pair(a, b) < std::pair(d, e) ? Quadruple{a, b, d, e} : Quadruple{d, e, a, b});
  };
  for (auto first = cells.cbegin(); first != cells.cend(); ++first) {
    const auto [a, b, d, e] = first->first;
    if (a >= d || b == a || e == d) continue;
    for (int c = b + 1; c < stimuli; ++c)
      for (int f = e + 1; f < stimuli; ++f) {
        const auto second = of(b, c, e, f);
        if (second == cells.end()) continue;
        const auto both = of(a, c, d, f);
        if (both == cells.end()) continue;
        ++found.sets;
        for (const auto& trial : {first->second, second->second, both->second})
          for (const auto cell : trial) ++found.times[cell];
      }
  }
  return found;
}

/// The log likelihood of the answers of all sets.
double likelihood_of(const SixPoints& sets, const Presentations& shown, const VectorXd& at) {
  const VectorXd places = shown.rows * at;
  double sum = 0;
  for (Eigen::Index i = 0; i < places.size(); ++i) {
    const auto point = point_at(places[i], shown.logistic);
    sum += sets.times[i] * (shown.upper[i] * point.log_p + (shown.trials[i] - shown.upper[i]) * point.log_q);
  }
  return sum;
}

}  // namespace

std::optional<LimitingScale> limiting_scale(const std::vector<ExpectedComparisons>& trials, int stimuli,
                                            ScaleModel model) {
  auto shown = presentations_of(trials, stimuli, model);
  if (!shown) return std::nullopt;
  shown->penalty = 0;
  const auto parameters = shown->rows.cols();
  const auto best = summit(*shown, VectorXd::Zero(parameters));
  if (!best) return std::nullopt;
  LimitingScale scale;
  scale.values.push_back(0);
  for (Eigen::Index i = 0; i < stimuli - 1; ++i) scale.values.push_back(best->at[i]);
  const double unit = unit_of(model);
  if (shown->order) scale.favours_second = unit * best->at[parameters - 1];
  const double whole = scale.values.back();
  if (model == ScaleModel::differences) {
    if (!(whole > 0)) return std::nullopt;
    scale.noise = 1 / whole;
    for (auto& value : scale.values) value /= whole;
    return scale;
  }
  const double mean = std::accumulate(scale.values.begin(), scale.values.end(), 0.0) / stimuli;
  for (auto& value : scale.values) value = (value - mean) * unit;
  return scale;
}

std::optional<ScaleFit> fit_scale(const std::vector<Compared>& trials, int stimuli, ScaleModel model) {
  const auto shown = presentations_of(trials, stimuli, model);
  if (!shown) return std::nullopt;
  const auto parameters = shown->rows.cols();
  const auto best = summit(*shown, VectorXd::Zero(parameters));
  if (!best) return std::nullopt;
  const MatrixXd covariance =
      ascent_at(*shown, best->at).information.llt().solve(MatrixXd::Identity(parameters, parameters));
  ScaleFit fit;
  if (in_pairs(model))
    add_pair_values(*shown, *best, covariance, stimuli, unit_of(model), fit);
  else if (!add_difference_values(*shown, *best, covariance, stimuli, fit))
    return std::nullopt;
  if (shown->order) {
    VectorXd along = VectorXd::Zero(parameters);
    along[parameters - 1] = 1;
    fit.favours_second = in_unit(interval_along(*shown, *best, covariance, along), unit_of(model));
  }
  fit.log_likelihood = likelihoods_at(*shown, best->at).model;
  fit.deviance = deviance_of(*shown, best->at);
  fit.degrees = static_cast<int>(shown->rows.rows() - parameters);
  fit.separated = is_separated(*shown);
  const VectorXd places = shown->rows * best->at;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const double p = point_at(places[static_cast<Eigen::Index>(shown->cell[i])], shown->logistic).p;
    fit.probabilities.push_back(shown->answers[i] == trials[i].second ? p : 1 - p);
  }
  return fit;
}

ScaleCheck check_scale(const std::vector<Compared>& trials, int stimuli, ScaleModel model,
                       const ScaleFit& fit, int sessions) {
  ScaleCheck check;
  const auto shown = presentations_of(trials, stimuli, model);
  const auto best = shown ? summit(*shown, VectorXd::Zero(shown->rows.cols())) : std::nullopt;
  if (!best) throw std::invalid_argument("scale: the trials are not those of the fit");
  const VectorXd places = shown->rows * best->at;
  const VectorXd probabilities =
      places.unaryExpr([&](double place) { return point_at(place, shown->logistic).p; });
  check.runs = runs_of(by_place(*shown, best->at), shown->answers);
  const auto sets = six_points_of(*shown, stimuli);
  const double likelihood = likelihood_of(sets, *shown, best->at);
  core::Draws draws({1, core::Stream::bootstrap, 0, 0, 0});
  auto other = *shown;
  int deviances = 1, runs = 1, six_points = 1;  // the session itself counts as one of them
  for (int k = 0; k < sessions; ++k) {
    draw_answers(probabilities, draws, other);
    const auto found = summit(other, best->at);
    if (!found) continue;
    ++check.sessions;
    deviances += deviance_of(other, found->at) >= fit.deviance ? 1 : 0;
    runs += runs_of(by_place(other, found->at), other.answers) <= check.runs ? 1 : 0;
    if (sets.sets > 0) six_points += likelihood_of(sets, other, found->at) <= likelihood ? 1 : 0;
  }
  check.six_points = sets.sets;
  if (sets.sets > 0) check.six_points_p = static_cast<double>(six_points) / (check.sessions + 1);
  check.deviance_p = static_cast<double>(deviances) / (check.sessions + 1);
  check.runs_p = static_cast<double>(runs) / (check.sessions + 1);
  return check;
}

Transitivity transitivity(const std::vector<Compared>& trials, int stimuli) {
  require(trials, stimuli, ScaleModel::bradley_terry);
  MatrixXd chosen = MatrixXd::Zero(stimuli, stimuli);
  for (const auto& trial : trials) {
    const int first = trial.stimuli[0], second = trial.stimuli[1];
    ++(trial.second ? chosen(second, first) : chosen(first, second));
  }
  const auto compared = [&](int a, int b) { return chosen(a, b) + chosen(b, a) > 0; };
  const auto share = [&](int a, int b) { return chosen(a, b) / (chosen(a, b) + chosen(b, a)); };
  Transitivity result;
  bool complete = true;
  for (int i = 0; i < stimuli; ++i)
    for (int j = i + 1; j < stimuli; ++j) complete = complete && compared(i, j);
  for (int i = 0; i < stimuli; ++i)
    for (int j = i + 1; j < stimuli; ++j)
      for (int k = j + 1; k < stimuli; ++k) {
        if (!compared(i, j) || !compared(j, k) || !compared(i, k)) continue;
        ++result.triples;
        // With ties, several orders of the three are possible; the triple counts by the best of them.
        int met = 0;
        int order[] = {i, j, k};
        do {
          const double above = share(order[0], order[1]), below = share(order[1], order[2]);
          if (above < 0.5 || below < 0.5) continue;
          const double both = share(order[0], order[2]);
          met = std::max(met, (both >= 0.5) + (both >= 0.5 && both >= std::min(above, below)) +
                                  (both >= 0.5 && both >= std::max(above, below)));
        } while (std::next_permutation(std::begin(order), std::end(order)));
        result.circular += met < 1, result.moderate += met < 2, result.strong += met < 3;
      }
  if (complete && stimuli > 2) {
    const double n = stimuli, most = (n * n * n - (stimuli % 2 == 0 ? 4 : 1) * n) / 24;
    result.consistence = 1 - result.circular / most;
  }
  return result;
}

namespace {

/// The places of these values in the ascending list of stimuli.
std::vector<int> places_of(const std::vector<double>& values, const std::vector<double>& stimuli) {
  std::vector<int> places;
  for (const double value : values)
    places.push_back(static_cast<int>(std::ranges::lower_bound(stimuli, value) - stimuli.begin()));
  return places;
}

/// Why trials have no scale: a code and a text.
std::pair<const char*, const char*> no_scale_reason(const std::vector<Compared>& trials, int stimuli,
                                                    ScaleModel model) {
  const bool enough = stimuli >= (in_pairs(model) ? 2 : 3);
  const auto shown = enough ? presentations_of(trials, stimuli, model) : std::nullopt;
  if (!shown || in_pairs(model)) return {"no-scale", "statement.no_scale"};
  const double upper = shown->upper.sum() / shown->trials.sum();
  if (std::max(upper, 1 - upper) > 0.9) return {"one-sided", "statement.no_scale_one_sided"};
  return {"no-range", "statement.no_scale_range"};
}

StimulusScale scale_of(const std::vector<const TrialRecord*>& trials, const std::string& condition,
                       ScaleModel model, int sessions,
                       const std::map<std::string, std::vector<double>>& designs) {
  StimulusScale scale;
  scale.condition = condition, scale.model = model;
  std::set<std::string> procedures;
  for (const auto* trial : trials) {
    scale.stimuli.insert(scale.stimuli.end(), trial->compared.begin(), trial->compared.end());
    procedures.insert(trial->procedure);
  }
  for (const auto& [procedure, values] : designs)
    if (procedures.contains(procedure))
      scale.stimuli.insert(scale.stimuli.end(), values.begin(), values.end());
  std::ranges::sort(scale.stimuli);
  scale.stimuli.erase(std::ranges::unique(scale.stimuli).begin(), scale.stimuli.end());
  scale.trials = static_cast<int>(trials.size());
  std::vector<Compared> compared;
  for (const auto* trial : trials)
    compared.push_back({places_of(trial->compared, scale.stimuli), *trial->response == 1});
  const auto n = static_cast<int>(scale.stimuli.size());
  const auto say = [&scale](const char* code, const char* text) {
    scale.statements.push_back({code, core::phrase(text)});
  };
  if (compared.empty()) return say("no-trials", "statement.no_trials"), scale;
  if (in_pairs(model)) {
    scale.chosen.resize(scale.stimuli.size()), scale.presented.resize(scale.stimuli.size());
    for (const auto& trial : compared) {
      for (const int s : trial.stimuli) ++scale.presented[static_cast<std::size_t>(s)];
      ++scale.chosen[static_cast<std::size_t>(trial.stimuli[trial.second ? 1 : 0])];
    }
    scale.transitivity = transitivity(compared, n);
  }
  const auto seconds = std::ranges::count_if(compared, &Compared::second);
  if (compared.size() > 5 && (seconds == 0 || seconds == std::ssize(compared)))
    say("one-answer", "statement.scale_one_answer");
  if (n >= (in_pairs(model) ? 2 : 3)) scale.fit = fit_scale(compared, n, model);
  if (!scale.fit) return std::apply(say, no_scale_reason(compared, n, model)), scale;
  if (sessions > 0 && scale.fit->degrees > 0)
    scale.check = check_scale(compared, n, model, *scale.fit, sessions);
  if (scale.fit->separated) say(kSeparated, "statement.scale_separated");
  if (scale.check && scale.check->deviance_p < 0.05) say("poor-fit", "statement.scale_poor_fit");
  if (!in_pairs(model) && scale.check && scale.check->runs_p < 0.05)
    say("few-runs", "statement.scale_few_runs");
  if (scale.check && scale.check->six_points_p && *scale.check->six_points_p < 0.05)
    say("six-points", "statement.scale_six_points");
  return scale;
}

}  // namespace

std::vector<StimulusScale> scales(const std::vector<TrialRecord>& trials,
                                  const std::vector<std::string>& order, ScaleModel model, int sessions,
                                  const std::map<std::string, std::vector<double>>& designs) {
  std::vector<StimulusScale> all;
  for (const auto& condition : conditions_of(trials, order)) {
    std::vector<const TrialRecord*> counting;
    for (const auto& trial : trials)
      if (counted(trial) && trial.response && !trial.compared.empty() && trial.instruction == condition)
        counting.push_back(&trial);
    all.push_back(scale_of(counting, condition, model, sessions, designs));
  }
  return all;
}

}  // namespace turnpoint::analysis
