#include "station/observer/observer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>

#include "station/random/elementary.hpp"

namespace turnpoint::observer {

namespace {

constexpr double kStrongest = 100;
constexpr double kZ75 = 0.67448975019608171;  // 75 % point of the normal
constexpr int kMoves = 5;
constexpr double kLook_s = 1.6;              // one slide of the finger across the surface and back
constexpr double kLn3 = 1.0986122886681098;  // odds of 75 %

double strength(const Parameters& p, const Question& q) {
  const double threshold = p.threshold.value_or(q.default_threshold);
  // Beyond any strength that tells answers apart; the exponential need not go there.
  if (q.decibel)
    return random::exp(std::min((q.level - threshold) * 0.11512925464970228 * p.slope, kStrongest));
  const double ratio = std::fabs(q.level - (q.signed_level ? p.bias : 0)) / std::fabs(threshold);
  return ratio > 0 ? random::exp(std::min(p.slope * random::log(ratio), kStrongest)) : 0;
}

/// The bound that leaves time: with nothing felt the decision takes bound^2 s on the mean, which shall be 60
/// % of what the deadline leaves.
double bound_for(const Parameters& p, double deadline_s) {
  if (deadline_s <= 0) return p.bound;
  const double left_s = std::max(0.02, 0.6 * (deadline_s - p.residual_s - p.travel_s));
  return std::min(p.bound, std::sqrt(left_s));
}

}  // namespace

double accuracy(double bound, double kx) {
  const double e = std::min(2 * bound * std::fabs(kx), 700.0);
  return 1 / (1 + random::exp(-e));
}

double mean_decision_s(double bound, double kx) {
  const double x = std::fabs(kx);
  if (bound * x < 1e-6) return bound * bound;
  const double e = random::exp(-std::min(2 * bound * x, 700.0));
  return bound / x * (1 - e) / (1 + e);
}

double Observer::share(const Question& q, int choice) const {
  const double kx = strength(parameters_, q) * kLn3 / (2 * parameters_.bound);
  const double p2 = accuracy(bound_for(parameters_, q.deadline_s), kx);
  const double chance = 1.0 / q.answers;
  double p = chance;
  if (q.signed_level) {
    const int likely = q.level < parameters_.bias ? q.negative_answer : 1 - q.negative_answer;
    p = choice == likely ? p2 : 1 - p2;
  } else if (q.correct) {
    const double right = chance + (1 - chance) * (2 * p2 - 1);
    p = choice == *q.correct ? right : (1 - right) / std::max(1, q.answers - 1);
  }
  return (1 - parameters_.lapse) * p + parameters_.lapse * chance;
}

Reply Observer::answer(const Question& q) const {
  auto key = q.key;
  key.stream = random::Stream::observer;
  random::Draws draws(key);
  const double kx = strength(parameters_, q) * kLn3 / (2 * parameters_.bound);
  const double bound = bound_for(parameters_, q.deadline_s);
  const double p2 = accuracy(bound, kx);
  const bool lapses = draws.uniform() < parameters_.lapse;
  const bool anticipates = draws.uniform() < parameters_.anticipation;
  const double u = draws.uniform();
  const auto any = static_cast<int>(draws.below(static_cast<std::uint64_t>(q.answers)));
  const double spread = random::exp(parameters_.spread * draws.normal());
  Reply reply;
  if (q.signed_level) {
    const bool seems_negative = q.level < parameters_.bias;
    const int likely = seems_negative ? q.negative_answer : 1 - q.negative_answer;
    reply.choice = u < p2 ? likely : 1 - likely;
  } else {
    const double chance = 1.0 / q.answers;
    const double p = chance + (1 - chance) * (2 * p2 - 1);
    const int right = q.correct.value_or(any);
    const int wrong = (right + 1 + any % std::max(1, q.answers - 1)) % q.answers;
    reply.choice = u < p ? right : wrong;
  }
  if (lapses || anticipates) reply.choice = any;
  reply.response_time_s =
      anticipates ? 0.05
                  : mean_decision_s(bound, kx) * spread + parameters_.residual_s + parameters_.travel_s;
  return reply;
}

Setting Observer::adjust(const Adjustment& a) const {
  auto key = a.key;
  key.stream = random::Stream::observer;
  random::Draws draws(key);
  const double threshold = parameters_.threshold.value_or(0.1 * (a.high - a.low));
  const double sigma = std::fabs(threshold) / kZ75;
  const bool lapses = draws.uniform() < parameters_.lapse;
  const double anywhere = draws.uniform(a.low, a.high);
  const double felt = parameters_.bias + sigma * draws.normal();
  const double wanted = std::clamp(lapses ? anywhere : felt, a.low, a.high);
  Setting setting;
  double time_s = parameters_.residual_s;
  for (int k = 1; k <= kMoves; ++k) {
    // Past the aim and back, each time by half as much: people bracket what they look for.
    const double overshoot = k == kMoves ? 0 : (a.start - wanted) * (k % 2 == 1 ? -0.5 : 0.5) / k;
    time_s += kLook_s * random::exp(parameters_.spread * draws.normal());
    setting.moves.push_back({time_s, std::clamp(wanted + overshoot, a.low, a.high)});
  }
  setting.done_s = time_s + parameters_.travel_s;
  return setting;
}

Parameters parse(const std::string& text) {
  Parameters p;
  double threshold = 0;
  const std::map<std::string, double*> known{
      {"threshold", &threshold}, {"slope", &p.slope},   {"lapse", &p.lapse},
      {"bias", &p.bias},         {"bound", &p.bound},   {"residual", &p.residual_s},
      {"travel", &p.travel_s},   {"spread", &p.spread}, {"anticipation", &p.anticipation}};
  const std::string allowed =
      "sim, or sim: and threshold, slope, lapse, bias, bound, residual, travel, spread, anticipation with "
      "numbers, as in sim:threshold=6,slope=1.2";
  const auto colon = text.find(':');
  if (text.substr(0, colon) != "sim") throw std::invalid_argument("--observer " + text + ": " + allowed);
  for (std::size_t at = colon; at != std::string::npos;) {
    const auto end = text.find(',', at + 1);
    const auto part = text.substr(at + 1, end == std::string::npos ? end : end - at - 1);
    const auto equals = part.find('=');
    const auto found = known.find(part.substr(0, equals));
    double value = 0;
    const char* first = part.data() + (equals == std::string::npos ? part.size() : equals + 1);
    const auto [last, error] = std::from_chars(first, part.data() + part.size(), value);
    if (found == known.end() || error != std::errc{} || last != part.data() + part.size() ||
        !std::isfinite(value))
      throw std::invalid_argument("--observer: \"" + part + "\" is not understood; allowed is " + allowed);
    *found->second = value;
    if (found->first == "threshold") p.threshold = value;
    at = end;
  }
  const auto check = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(std::string("--observer: ") + what);
  };
  check(!p.threshold || *p.threshold != 0, "threshold must not be 0");
  check(p.slope > 0, "slope must be above 0");
  check(p.lapse >= 0 && p.lapse <= 1 && p.anticipation >= 0 && p.anticipation <= 1,
        "lapse and anticipation are probabilities from 0 to 1");
  check(p.bound > 0 && p.residual_s >= 0 && p.travel_s >= 0 && p.spread >= 0,
        "bound is above 0, residual, travel and spread are 0 or more");
  return p;
}

}  // namespace turnpoint::observer
