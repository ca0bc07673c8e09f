#include "station/simulation/observer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "station/core/elementary.hpp"
#include "station/core/limits.hpp"
#include "station/core/usage_error.hpp"
#include "station/simulation/first_passage.hpp"

namespace turnpoint::simulation {
namespace {

constexpr double kLogStrongest = 4.6;         // ln 99: at 99 times the threshold nobody makes errors
constexpr double kZ75 = 0.67448975019608171;  // the 75 % quantile of the standard normal distribution
constexpr double kLn2 = 0.69314718055994531;
// largest |z| that is used: beyond it the tail of the normal distribution is below 1e-9, and its logarithm
// loses precision
constexpr double kSurest_sd = 6;
// distance between the criteria of neighbouring ratings, also of confidence
constexpr double kRatingStep_sd = 0.5;
constexpr double kLinePoints = 9;
constexpr double kSqrt2 = 1.4142135623730951, kSqrt6 = 2.4494897427831779;
constexpr double kNormalPeak = 0.39894228040143268;  // density of the standard normal distribution at 0
constexpr double kLn10 = 2.302585092994046;
constexpr int kMoves = 5;
constexpr double kLook_s = 1.6;       // typical time to slide the finger across the surface and back
constexpr double kLookSpread = 0.25;  // SD of the logarithm of the time kLook_s

/// Returns half the log odds that a standard normal variable is above -x.
double half_logit_of_normal(double x) {
  const double inside = std::clamp(x, -kSurest_sd, kSurest_sd);
  const double rarer = core::normal_cdf(-std::fabs(inside));
  const double half = 0.5 * (core::log(1 - rarer) - core::log(rarer));
  return inside < 0 ? -half : half;
}

/// Returns the proportion correct of an observer who chooses the largest of `answers` noisy observations, of
/// which the right one is d' higher on average. It is the integral of phi(x) Phi(x + d')^(answers - 1), where
/// phi and Phi are the normal density and distribution function, by the trapezoidal rule.
double largest_is_right(double d_prime, int answers) {
  constexpr double step = 0.125;
  constexpr int half = 64;
  static const auto density = [] {
    std::array<double, 2 * half + 1> all{};
    for (int i = -half; i <= half; ++i)
      all[static_cast<std::size_t>(i + half)] = core::exp(-0.5 * step * i * step * i);
    return all;
  }();
  double sum = 0;
  for (int i = -half; i <= half; ++i) {
    const double smaller = core::normal_cdf(step * i + d_prime);
    double below = density[static_cast<std::size_t>(i + half)];
    for (int other = 1; other < answers; ++other) below *= smaller;
    sum += below;
  }
  return sum * step * kNormalPeak;
}

/// Returns the proportion correct in ABX of an observer who chooses the smaller difference (Macmillan &
/// Creelman 2005, eq. 9.7). A negative d' means that the difference is felt the wrong way round; then the
/// proportion correct with two intervals is returned.
double nearest_is_right(double d_prime, double of_two) {
  if (d_prime <= 0) return of_two;
  const double apart = core::normal_cdf(d_prime / kSqrt2), beside = core::normal_cdf(d_prime / kSqrt6);
  return apart * beside + (1 - apart) * (1 - beside);
}

/// The inverse of core::normal_cdf(), between -kSurest_sd and kSurest_sd.
double normal_quantile(double p) {
  double low = -kSurest_sd, high = kSurest_sd;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (core::normal_cdf(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Returns d' of an observer who is right this often with two intervals.
double d_prime_of_two(double right) { return kSqrt2 * normal_quantile(right); }

/// Returns the proportion correct of a task, given the probability `upper` that a diffusion ends at its upper
/// boundary. That probability is the proportion correct with two answers. For any number of answers, a
/// Weibull function has the same shape above the guess rate.
double share_right(double upper, const Question& q) {
  if (q.finding == Finding::largest) return largest_is_right(d_prime_of_two(upper), q.answers);
  if (q.finding == Finding::nearest) return nearest_is_right(d_prime_of_two(upper), upper);
  const double chance = 1.0 / q.answers;
  return std::max(0.0, chance + (1 - chance) * (2 * upper - 1));
}

/// share_right() at evenly spaced probabilities `upper` from 0 to 1.
using ShareGrid = std::array<double, 257>;

ShareGrid shares_of(Finding finding, int answers) {
  Question question;
  question.finding = finding, question.answers = answers;
  ShareGrid shares{};
  for (std::size_t i = 0; i < shares.size(); ++i)
    shares[i] = share_right(static_cast<double>(i) / static_cast<double>(shares.size() - 1), question);
  return shares;
}

/// Returns the grid of a task whose share_right() takes long; null for the others.
const ShareGrid* share_grid(const Question& q) {
  if (q.finding == Finding::nearest) {
    static const auto nearest = shares_of(Finding::nearest, 2);
    return &nearest;
  }
  if (q.finding == Finding::largest && q.answers == 3) {
    static const auto of_three = shares_of(Finding::largest, 3);
    return &of_three;
  }
  if (q.finding == Finding::largest && q.answers == 4) {
    static const auto of_four = shares_of(Finding::largest, 4);
    return &of_four;
  }
  return nullptr;
}

/// Returns whether `share` is below share_right(). That function rises with `upper`, so its values at the
/// ends of a cell of the grid bound it there, and it is computed only if `share` lies between these bounds.
/// The margin is far above the rounding errors of all values.
bool is_below_share_right(double share, double upper, const Question& q) {
  constexpr double margin = 1e-12;
  if (const auto* grid = share_grid(q)) {
    const std::size_t cells = grid->size() - 1;
    const auto cell = std::min(cells - 1, static_cast<std::size_t>(upper * static_cast<double>(cells)));
    if (share < (*grid)[cell] - margin) return true;
    if (share > (*grid)[cell + 1] + margin) return false;
  }
  return share < share_right(upper, q);
}

/// Averages a function of the drift over the drift's normal distribution, by the trapezoidal rule.
template <class Function>
double mean_over_drift(double drift, double sd, Function function) {
  if (sd == 0) return function(drift);
  double sum = 0, weights = 0;
  for (int i = -50; i <= 50; ++i) {
    const double z = 0.12 * i, weight = core::exp(-0.5 * z * z);
    sum += weight * function(drift + sd * z), weights += weight;
  }
  return sum / weights;
}

/// Returns the range of felt levels for which the observer gives this answer: it ends halfway to the levels
/// of the neighbouring answers. For the lowest and the highest answer, the range has no outer end.
std::pair<double, double> ends_of_category(const Question& q, int choice) {
  const double own = q.categories.at(static_cast<std::size_t>(choice));
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  for (const double other : q.categories) {
    if (other < own) low = std::max(low, 0.5 * (other + own));
    if (other > own) high = std::min(high, 0.5 * (other + own));
  }
  return {low, high};
}

int category_of(const Question& q, double level) {
  int choice = 0;
  while (choice + 1 < q.answers &&
         !(level >= ends_of_category(q, choice).first && level < ends_of_category(q, choice).second))
    ++choice;
  return choice;
}

/// Returns the criterion between rating `rating` and the next higher one, in SDs from the mean sensation
/// without a signal. The criteria of the ratings lie symmetrically around `centre`.
double rating_criterion(double centre, int rating, int ratings) {
  return centre + kRatingStep_sd * (rating - 0.5 * (ratings - 2));
}

}  // namespace

/// The threshold at the trial's value of the second dimension.
double Observer::threshold(const Question& q) const {
  double at = parameters_.threshold.value_or(q.default_threshold);
  if (q.decides == Decides::side) return at;
  const double rise = parameters_.gradient * q.second;
  if (q.log_step != 0)
    at *= core::exp(std::clamp(q.log_step * rise, -600.0, 600.0));
  else
    at += rise;
  if (parameters_.floor) at = std::max(at, *parameters_.floor);
  // a threshold cannot fall to 0, except for levels in dB
  return q.decibel || rise == 0 ? at : std::max(at, 1e-9);
}

/// The bias at the trial's value of the second dimension.
double Observer::bias(const Question& q) const {
  const double at = q.cut + parameters_.bias + parameters_.gradient * q.second;
  return parameters_.floor ? std::max(at, *parameters_.floor) : at;
}

/// The level as the observer feels it: that of the question or, of stimuli that are compared, their
/// difference on the observer's scale.
double Observer::level(const Question& q) const {
  if (q.compared.empty()) return q.level;
  std::vector<double> at;
  for (const double place : q.compared)
    at.push_back(parameters_.slope == 1 || place <= 0 ? place
                                                      : core::exp(parameters_.slope * core::log(place)));
  const auto last = at.size() - 1;
  if (at.size() == 2) return q.range * (at[1] - at[0]);
  return q.range * (std::fabs(at[last] - at[last - 1]) - std::fabs(at[1] - at[0]));
}

double Observer::strength(const Question& q, double from) const {
  const double threshold = this->threshold(q);
  const auto capped = [](double exponent) { return core::exp(std::min(exponent, kLogStrongest)); };
  if (q.decibel && q.decides != Decides::side)
    return capped((q.level - threshold) * 0.11512925464970228 * parameters_.slope);
  const double ratio = std::fabs(level(q) - from) / std::fabs(threshold);
  const double exponent = q.compared.empty() ? parameters_.slope : 1;  // the scale has the slope already
  return ratio > 0 ? capped(exponent * core::log(ratio)) : 0;
}

double Observer::sensitivity(const Question& q) const {
  if (q.absent) return 0;
  switch (q.middle) {
    case Middle::criterion:
      return 2 * kZ75 * strength(q, 0);
    case Middle::threshold:
      return 2 * kZ75 * core::log(std::max(strength(q, 0), 1e-9));
    case Middle::bias:
      break;
  }
  return (q.level < bias(q) ? -2 : 2) * kZ75 * strength(q, bias(q));
}

/// The sensation in the middle of a rating scale, in SDs from the mean sensation without a signal.
double Observer::centre(const Question& q) const {
  return q.middle == Middle::criterion ? parameters_.criterion : 0;
}

/// The standard deviation of the level that the observer feels.
double Observer::category_sd(const Question& q) const {
  return std::fabs(parameters_.threshold.value_or(q.default_threshold)) / (2 * kZ75);
}

/// Returns the number that the observer gives as answer. A place on a line scatters as much as a rating on a
/// scale of kLinePoints points.
double Observer::value(const Question& q, core::Draws& draws) const {
  const auto& v = *q.value;
  double value = 0;
  if (v.typed) {
    const double ratio =
        core::log(std::max(strength(q, 0), 1e-9)) + parameters_.scatter * kLn10 * draws.normal();
    value = v.modulus * core::exp(ratio);
  } else {
    const double felt = sensitivity(q) + draws.normal() - centre(q);
    value = v.low + (v.high - v.low) * (0.5 + felt / (kLinePoints * kRatingStep_sd));
  }
  double scale = 1;
  for (int i = 0; i < v.decimals; ++i) scale *= 10;
  return std::round(std::clamp(value, v.low, v.high) * scale) / scale;
}

int Observer::confidence(const Question& q, int choice, core::Draws& draws) const {
  // The evidence has SD 1, and is above 0 as often as this answer is given. It was above 0 in this trial, so
  // it comes from that part of its distribution.
  const double given = share(q, choice);
  const double evidence = normal_quantile(given) - normal_quantile(draws.uniform() * given);
  return 1 + std::min(q.confidence - 1, static_cast<int>(std::max(0.0, evidence) / kRatingStep_sd));
}

double Observer::drift(const Question& q) const {
  double half_logit = 0;
  switch (q.decides) {
    case Decides::right_answer:  // with two answers, the proportion correct is 1 - 2^-(1 + strength)
      half_logit = 0.5 * core::log(2 * core::exp(kLn2 * strength(q, 0)) - 1);
      break;
    case Decides::side:
      half_logit = half_logit_of_normal(kZ75 * strength(q, bias(q)));
      if (level(q) < bias(q)) half_logit = -half_logit;
      break;
    case Decides::presence:
      half_logit = half_logit_of_normal(sensitivity(q) - parameters_.criterion);
      break;
    case Decides::category:
      const auto [low, high] = ends_of_category(q, category_of(q, q.level));
      half_logit = half_logit_of_normal(std::min(q.level - low, high - q.level) / category_sd(q));
      break;
  }
  return half_logit / parameters_.bound;
}

double Observer::bound(const Question& q) const {
  if (q.caution) return *q.caution * parameters_.bound;
  if (q.deadline_s <= 0 || q.signal_s) return parameters_.bound;
  // Without drift, the proportion of decisions later than t is P(T > t) <= 4/pi exp(-pi^2 t / (8 bound^2)).
  // The bound is chosen so that this is 4 %.
  const double left_s = std::max(0.02, q.deadline_s - nondecision_range_s().second);
  return std::min(parameters_.bound, std::sqrt(0.35 * left_s));
}

double Observer::upper(const Question& q, double drift) const {
  if (q.signal_s) return upper_by(drift, bound(q), *q.signal_s);
  return upper_probability(drift, bound(q), parameters_.start_range);
}

double Observer::latency_s(const Question& q) const {
  const double usual_s = 0.5 * parameters_.residual_s + parameters_.travel_s;
  return q.deadline_s > 0 ? std::min(usual_s, 0.8 * (q.deadline_s - *q.signal_s)) : usual_s;
}

double Observer::share(const Question& q, int choice) const {
  const auto& p = parameters_;
  const auto upper = [&](double drift) { return this->upper(q, drift); };
  const auto mean = [&](auto function) { return mean_over_drift(drift(q), p.drift_sd, function); };
  const double chance = 1.0 / q.answers;
  double share = chance;
  if (q.decides == Decides::right_answer && q.correct) {
    const double right = mean([&](double drift) { return share_right(upper(drift), q); });
    share = choice == *q.correct ? right : (1 - right) / std::max(1, q.answers - 1);
  } else if (q.rating) {
    const auto below = [&](int rating) {
      if (rating < 0) return 0.0;
      if (rating >= q.answers - 1) return 1.0;
      return core::normal_cdf(rating_criterion(centre(q), rating, q.answers) - sensitivity(q));
    };
    share = below(choice) - below(choice - 1);
  } else if (q.decides == Decides::category) {
    const auto [low, high] = ends_of_category(q, choice);
    const double sd = category_sd(q);
    share = core::normal_cdf((high - q.level) / sd) - core::normal_cdf((low - q.level) / sd);
  } else if (q.decides != Decides::right_answer) {
    const double positive = mean(upper);
    share = choice == q.positive ? positive : 1 - positive;
  }
  return (1 - p.lapse) * share + p.lapse * chance;
}

/// Draws how often the observer asks for the intervals again. The draws are its own, so that answers and
/// settings are the same, however often it asks.
int Observer::asks_again(core::DrawKey key, int most) const {
  key.stream = core::Stream::asking_again;
  core::Draws draws(key);
  int times = 0;
  while (times < most && draws.uniform() < parameters_.again) ++times;
  return times;
}

Reply Observer::answer(const Question& q) const {
  const auto& p = parameters_;
  auto key = q.key;
  key.stream = core::Stream::observer;
  core::Draws draws(key);
  const bool lapses = draws.uniform() < p.lapse;
  const bool anticipates = draws.uniform() < p.anticipation;
  const auto any = static_cast<int>(draws.below(static_cast<std::uint64_t>(q.answers)));
  const auto other = static_cast<int>(draws.below(static_cast<std::uint64_t>(std::max(1, q.answers - 1))));
  const double u = draws.uniform(), felt = draws.normal();
  const double jitter_s = p.residual_range_s * (draws.uniform() - 0.5), residual_s = p.residual_s + jitter_s;
  const double start = p.start_range * (2 * draws.uniform() - 1);
  const double pull = drift(q) + p.drift_sd * draws.normal();
  const auto passage = q.signal_s ? Passage{draws.uniform() < upper(q, pull), *q.signal_s}
                                  : first_passage(pull, bound(q), start, draws);
  Reply reply;
  if (q.decides == Decides::right_answer) {
    // With three or more answers, and in ABX, fewer answers are right than with two intervals. So some walks
    // that end at the upper boundary must give a wrong answer; their share is chosen such that the proportion
    // correct equals share_right().
    const double upper = this->upper(q, pull);
    const bool found = passage.upper && is_below_share_right(u * upper, upper, q);
    const int right = q.correct.value_or(any);
    reply.choice = found ? right : (right + 1 + other) % q.answers;
    // All wrong answers are guesses, and of the right ones as many as guesses happen to find.
    if (q.unsure && q.correct) {
      const double share = share_right(upper, q), lucky = (1 - share) / std::max(1, q.answers - 1);
      const bool guessed = !found || draws.uniform() * share < lucky;
      if (guessed && draws.uniform() < p.unsure) reply.choice = q.answers;
    }
  } else if (q.rating) {
    const double seems = sensitivity(q) + felt;
    int rating = 0;
    while (rating < q.answers - 1 && seems > rating_criterion(centre(q), rating, q.answers)) ++rating;
    reply.choice = rating;
  } else if (q.decides == Decides::category) {
    reply.choice = category_of(q, q.level + category_sd(q) * felt);
  } else {
    reply.choice = passage.upper ? q.positive : 1 - q.positive;
  }
  if (lapses || anticipates) reply.choice = any;
  reply.response_time_s = anticipates ? 0.05 : passage.time_s + residual_s + p.travel_s;
  reply.travel_s = p.travel_s;
  if (q.signal_s && !anticipates) reply.response_time_s = *q.signal_s + latency_s(q) + jitter_s;
  if (q.value) {
    auto asked = q;
    if (lapses) asked.level = q.middle == Middle::bias ? p.bias : p.threshold.value_or(q.default_threshold);
    reply.choice = 0, reply.value = value(asked, draws);
  }
  if (q.confidence > 0) {
    reply.confidence = confidence(q, *reply.choice, draws);
    reply.confidence_time_s = std::max(p.residual_s + p.travel_s, core::kConfidenceGuard_s);
  }
  if (!anticipates) reply.again = asks_again(q.key, q.again);
  return reply;
}

Setting Observer::adjust(const Adjustment& a) const {
  auto key = a.key;
  key.stream = core::Stream::observer;
  core::Draws draws(key);
  const double threshold = parameters_.threshold.value_or(0.1 * (a.high - a.low));
  const double sigma = std::fabs(threshold) / kZ75;
  const bool lapses = draws.uniform() < parameters_.lapse;
  const double anywhere = draws.uniform(a.low, a.high);
  const double felt = a.equal + parameters_.bias + sigma * draws.normal();
  const double wanted = std::clamp(lapses ? anywhere : felt, a.low, a.high);
  Setting setting;
  double time_s = parameters_.residual_s;
  for (int k = 1; k <= kMoves; ++k) {
    // Overshoots the target and comes back, each time by a smaller amount, as people do when they adjust a
    // slider.
    const double overshoot = k == kMoves ? 0 : (a.start - wanted) * (k % 2 == 1 ? -0.5 : 0.5) / k;
    time_s += kLook_s * core::exp(kLookSpread * draws.normal());
    setting.moves.push_back({time_s, std::clamp(wanted + overshoot, a.low, a.high)});
  }
  setting.done_s = time_s + parameters_.travel_s;
  setting.again = asks_again(a.key, a.again);
  setting.again_s = nondecision_s();
  if (a.within_s <= 0) return setting;
  const double share = std::min(1.0, 0.9 * a.within_s / setting.done_s);
  setting.again_s = std::min(setting.again_s, 0.9 * a.within_s);
  for (auto& move : setting.moves) move.time_s *= share;
  setting.done_s *= share;
  return setting;
}

namespace {

/// Throws core::UsageError that names the parameter out of range.
void check(const Parameters& p) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw core::UsageError(std::string("--observer: ") + what);
  };
  require(!p.threshold || *p.threshold != 0, "threshold must not be 0");
  require(p.slope > 0, "slope must be above 0");
  require(p.scatter >= 0, "scatter must be 0 or more");
  require(p.lapse >= 0 && p.lapse <= 1 && p.anticipation >= 0 && p.anticipation <= 1,
          "lapse and anticipation must be probabilities from 0 to 1");
  require(p.unsure >= 0 && p.unsure <= 1, "unsure must be a proportion from 0 to 1");
  require(p.again >= 0 && p.again <= 1, "again must be a probability from 0 to 1");
  require(p.bound > 0 && p.residual_s >= 0 && p.travel_s >= 0,
          "bound must be above 0, and residual and travel 0 or more");
  require(p.drift_sd >= 0 && p.start_range >= 0 && p.start_range < 1,
          "drift_sd must be 0 or more, and start_range at least 0 and below 1");
  require(p.residual_range_s >= 0 && p.residual_range_s <= 2 * p.residual_s,
          "residual_range must be from 0 to twice the residual");
}

}  // namespace

namespace {

/// A parameter by its name. Of `number` and `maybe` one is set.
struct Key {
  const char* name;
  double Parameters::*number;
  std::optional<double> Parameters::*maybe;
  bool in_its_unit;  ///< people differ in its value, not in its logarithm
};
constexpr Key kKeys[] = {{"threshold", nullptr, &Parameters::threshold, true},
                         {"gradient", &Parameters::gradient, nullptr, true},
                         {"floor", nullptr, &Parameters::floor, true},
                         {"slope", &Parameters::slope, nullptr, false},
                         {"lapse", &Parameters::lapse, nullptr, false},
                         {"bias", &Parameters::bias, nullptr, true},
                         {"criterion", &Parameters::criterion, nullptr, true},
                         {"scatter", &Parameters::scatter, nullptr, false},
                         {"unsure", &Parameters::unsure, nullptr, false},
                         {"again", &Parameters::again, nullptr, false},
                         {"bound", &Parameters::bound, nullptr, false},
                         {"residual", &Parameters::residual_s, nullptr, false},
                         {"travel", &Parameters::travel_s, nullptr, false},
                         {"drift_sd", &Parameters::drift_sd, nullptr, false},
                         {"start_range", &Parameters::start_range, nullptr, false},
                         {"residual_range", &Parameters::residual_range_s, nullptr, false},
                         {"anticipation", &Parameters::anticipation, nullptr, false}};

const Key* key_of(const std::string& name) {
  const auto* found =
      std::find_if(std::begin(kKeys), std::end(kKeys), [&name](const Key& key) { return name == key.name; });
  return found == std::end(kKeys) ? nullptr : found;
}

std::string all_keys() {
  std::string names;
  for (const auto& key : kKeys) names += (names.empty() ? "" : ", ") + std::string(key.name);
  return names;
}

/// Calls take(key, value) for each `name=number` of a list with commas. Throws core::UsageError, which begins
/// with the option's name and ends with what is allowed.
template <class Take>
void read_list(const std::string& list, const char* option, const std::string& allowed, const Take& take) {
  for (std::size_t at = 0; at != std::string::npos;) {
    const auto end = list.find(',', at);
    const auto part = list.substr(at, end == std::string::npos ? end : end - at);
    const auto equals = part.find('=');
    const auto* found = key_of(part.substr(0, equals));
    double value = 0;
    const char* first = part.data() + (equals == std::string::npos ? part.size() : equals + 1);
    const auto [last, error] = std::from_chars(first, part.data() + part.size(), value);
    if (found == nullptr || error != std::errc{} || last != part.data() + part.size() ||
        !std::isfinite(value))
      throw core::UsageError(std::string(option) + ": \"" + part + "\" is not understood; write " + allowed);
    take(*found, value);
    at = end == std::string::npos ? end : end + 1;
  }
}

}  // namespace

Parameters parse(const std::string& text) {
  Parameters p;
  const std::string allowed =
      "sim, or sim: and " + all_keys() + " with numbers, as in sim:threshold=6,slope=1.2";
  const auto colon = text.find(':');
  if (text.substr(0, colon) != "sim") throw core::UsageError("--observer " + text + ": " + allowed);
  if (colon == std::string::npos) return p;
  read_list(text.substr(colon + 1), "--observer", allowed, [&p](const Key& key, double value) {
    if (key.maybe != nullptr)
      p.*key.maybe = value;
    else
      p.*key.number = value;
  });
  check(p);
  return p;
}

Spread parse_spread(const std::string& text) {
  Spread spread;
  read_list(text, "--between", all_keys() + " with standard deviations, as in threshold=0.03,bound=0.15",
            [&spread](const Key& key, double value) {
              if (!(value > 0))
                throw core::UsageError(std::string("--between: the standard deviation of ") + key.name +
                                       " must be above 0");
              spread[key.name] = value;
            });
  return spread;
}

Parameters draw_person(const Parameters& middle, const Spread& spread, core::Draws& draws) {
  Parameters person = middle;
  for (const auto& key : kKeys) {
    const double z = draws.normal();  // drawn for each parameter, so that one more to vary changes no other
    const auto found = spread.find(key.name);
    if (found == spread.end()) continue;
    if (key.maybe != nullptr && !(middle.*key.maybe))
      throw core::UsageError(std::string("--between: people cannot differ in ") + key.name +
                             " if --observer does not say it; write sim:" + key.name + "=...");
    double& value = key.maybe != nullptr ? *(person.*key.maybe) : person.*key.number;
    const double usual = value;
    if (!key.in_its_unit) {
      value *= core::exp(found->second * z);
      continue;
    }
    value += found->second * z;
    if (key.maybe != nullptr && usual != 0 && value / usual < 0.1) value = 0.1 * usual;
  }
  person.lapse = std::min(person.lapse, 1.0), person.anticipation = std::min(person.anticipation, 1.0);
  person.start_range = std::min(person.start_range, 0.95);
  person.residual_range_s = std::min(person.residual_range_s, 2 * person.residual_s);
  return person;
}

}  // namespace turnpoint::simulation
