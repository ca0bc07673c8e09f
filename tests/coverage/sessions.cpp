#include "tests/coverage/sessions.hpp"

#include <algorithm>
#include <cmath>

#include "station/core/draws.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "station/report/stored_trials.hpp"
#include "station/report/summary.hpp"
#include "tests/support/reference_posterior.hpp"

namespace coverage {

namespace {

using namespace turnpoint;

constexpr double kMostLapses = 0.06;
constexpr int kReferenceSteps = 20'000;
/// Block numbers for this program's own random numbers in the observer's stream. No session uses these
/// blocks.
constexpr int kTruthBlock = 1000, kAnswerBlock = 1001;

double share_right(const Truth& truth, double level_dB) {
  return 1 - truth.lapse -
         (0.5 - truth.lapse) * std::exp(-std::pow(10, truth.slope * (level_dB - truth.threshold_dB) / 20));
}

Truth drawn_from(const analysis::Prior& prior, std::uint64_t seed) {
  core::Draws draws({seed, core::Stream::observer, kTruthBlock, 0, 0});
  const auto within = [&](double low, double high) {
    for (;;) {
      const double at = draws.uniform(), nearest = std::min(at, 1 - at);
      if (draws.uniform() * prior.falling_share < nearest) return low + at * (high - low);
    }
  };
  Truth truth;
  truth.threshold_dB = within(prior.threshold_low, prior.threshold_high);
  truth.slope = std::exp(within(std::log(prior.slope_low), std::log(prior.slope_high)));
  truth.lapse = draws.uniform(0, kMostLapses);
  return truth;
}

std::optional<Ends> ends(const std::optional<analysis::ParameterInterval>& found) {
  if (!found) return std::nullopt;
  return Ends{found->interval.low, found->interval.high};
}

/// Returns the values that the report prints for these trials.
Printed printed(const report::SessionData& data) {
  const auto fits = report::fits_of(data);
  const auto& intervals = fits.front().intervals;
  return {{ends(intervals.threshold), ends(intervals.slope), ends(intervals.interval_75)}, {}};
}

void add_reference(const report::SessionData& data, const analysis::Prior& prior, std::uint64_t seed,
                   Printed& into) {
  std::vector<reference::Level> answers;
  for (const auto& trial : data.trials) answers.push_back({*trial.level, 1, *trial.correct ? 1 : 0});
  const auto samples =
      reference::sample(reference::Shape::weibull_dB, reference::merged(answers),
                        {prior.threshold_low, prior.threshold_high, prior.slope_low, prior.slope_high, 0,
                         kMostLapses, 0.5, 0.5, false, prior.falling_share},
                        kReferenceSteps, seed);
  const auto central = [](const std::vector<double>& values) {
    return Ends{reference::quantile(values, 0.025), reference::quantile(values, 0.975)};
  };
  into.reference = {central(samples.threshold), central(samples.slope), central(samples.level_75)};
}

}  // namespace

double Truth::of(Quantity quantity) const {
  if (quantity == Quantity::threshold) return threshold_dB;
  if (quantity == Quantity::slope) return slope;
  return threshold_dB + 20 / slope * std::log10(-std::log(1 - 0.25 / (0.5 - lapse)));
}

const std::vector<Source>& sources() {
  static const std::vector<Source> all{{"drawn from the prior", {}},
                                       {"-25 dB, slope 1, lapses .02", Truth{-25, 1, 0.02}},
                                       {"-22 dB, slope 3, lapses .04", Truth{-22, 3, 0.04}},
                                       {"-7 dB, slope 0.8, lapses .01", Truth{-7, 0.8, 0.01}},
                                       {"-7 dB, slope 4, lapses .02", Truth{-7, 4, 0.02}},
                                       {"-26 dB, slope 5, lapses .02", Truth{-26, 5, 0.02}},
                                       {"-25 dB, slope 2, lapses .02", Truth{-25, 2, 0.02}},
                                       {"-16 dB, slope 0.7, lapses .03", Truth{-16, 0.7, 0.03}},
                                       {"-12 dB, slope 2, lapses .02", Truth{-12, 2, 0.02}}};
  return all;
}

Design::Design(const std::string& procedure)
    : protocol_(protocol::load(std::string(TURNPOINT_SOURCE_DIR) + "/tests/coverage/protocols/" + procedure +
                               ".toml")) {
  report::SessionData empty;
  report::add_trials({}, protocol_, empty);
  prior_ = empty.prior.value();
}

Session Design::run(const Source& source, std::uint64_t seed, bool with_reference,
                    const std::vector<int>& counts) const {
  Session session;
  session.seed = seed;
  session.truth = source.fixed ? *source.fixed : drawn_from(prior_, seed);
  core::Draws draws({seed, core::Stream::observer, kAnswerBlock, 0, 0});
  auto protocol = protocol_;
  const int procedures = static_cast<int>(protocol.procedures.size());
  for (auto& spec : protocol.procedures) spec.stop.trials = counts.back() / procedures;
  const auto answer = [&](const trial::TrialSpec&, const simulation::Question& question) {
    const int right = question.correct.value();
    simulation::Reply reply;
    reply.choice = draws.uniform() < share_right(session.truth, question.level) ? right : 1 - right;
    reply.response_time_s = 0.5;
    return reply;
  };
  const auto rehearsal = rehearsal::rehearse(protocol, 0, seed, {answer, {}});
  report::SessionData data;
  report::add_trials(rehearsal.blocks, protocol_, data);
  data.replicates = 0;  // no bootstrap, because the bands of the fits are not needed
  const auto all = data.trials;
  for (std::size_t i = 0; i < kTrials.size(); ++i) {
    if (std::find(counts.begin(), counts.end(), kTrials[i]) == counts.end()) continue;
    data.trials.assign(all.begin(), all.begin() + kTrials[i]);
    session.after[i] = printed(data);
    if (with_reference) add_reference(data, prior_, seed, session.after[i]);
  }
  return session;
}

}  // namespace coverage
