#include "station/procedure/quest_plus.hpp"

#include <algorithm>
#include <cmath>

#include "station/procedure/description.hpp"
#include "station/procedure/grid.hpp"
#include "station/procedure/keys.hpp"
#include "station/procedure/state_hash.hpp"

namespace turnpoint::procedure {

namespace {

constexpr int kUnansweredInARow = 3;

}  // namespace

QuestPlus::QuestPlus(const Spec& spec) : spec_(spec), posterior_(spec), stimulus_(chosen()) {}

std::size_t QuestPlus::chosen() const {
  if (spec_.kind == Kind::zest)
    return posterior_.nearest_stimulus(posterior_.estimate(Posterior::threshold).mean, spec_.scale);
  if (spec_.kind == Kind::best_pest)
    return posterior_.nearest_stimulus(posterior_.most_likely_threshold(), spec_.scale);
  return posterior_.best_stimulus();
}

bool QuestPlus::done() const {
  const auto& stop = spec_.stop;
  const int trials = recorded_ + spent_;
  const bool by_trials = stop.trials && trials >= *stop.trials;
  if (by_trials && stop.rule == StopRule::any) return true;
  if (stop.min_trials && trials < *stop.min_trials) return false;
  const bool by_sd = stop.threshold_sd && *posterior_.estimate(Posterior::threshold).sd <= *stop.threshold_sd;
  const bool by_entropy = stop.entropy_nats && posterior_.entropy_nats() <= *stop.entropy_nats;
  const bool by_right =
      enough_right(stop, history_.size(), [this](std::size_t i) { return history_[i] % 2 == 1; });
  if (stop.rule == StopRule::any) return by_trials || by_sd || by_entropy || by_right;
  return (!stop.right || by_right) && (!stop.trials || by_trials) && (!stop.threshold_sd || by_sd) &&
         (!stop.entropy_nats || by_entropy);
}

std::optional<Proposal> QuestPlus::next() const {
  if (done()) return std::nullopt;
  return Proposal{posterior_.stimuli()[stimulus_], {}};
}

void QuestPlus::record(Answer answer) {
  if (answer == Answer::none) {
    if (++unanswered_ > kUnansweredInARow) unanswered_ = 0, ++spent_;
    return;
  }
  unanswered_ = 0;
  ++recorded_;
  const bool one = answer == Answer::one;
  posterior_.update(stimulus_, one);
  history_.push_back(2 * stimulus_ + (one ? 1 : 0));
  stimulus_ = chosen();
}

int QuestPlus::expected() const { return std::max(spec_.stop.trials.value_or(60), recorded_ + spent_); }

std::map<std::string, Estimate> QuestPlus::estimates() const {
  std::map<std::string, Estimate> all;
  all["threshold"] = posterior_.estimate(Posterior::threshold);
  if (posterior_.varies(Posterior::slope)) all["slope"] = posterior_.estimate(Posterior::slope);
  if (posterior_.varies(Posterior::guess)) all["guess"] = posterior_.estimate(Posterior::guess);
  if (posterior_.varies(Posterior::lapse)) all["lapse"] = posterior_.estimate(Posterior::lapse);
  return all;
}

std::uint64_t QuestPlus::state_hash() const {
  StateHash hash;
  for (const auto word : history_) hash.add(word);
  hash.add(stimulus_);
  hash.add(static_cast<std::uint64_t>(unanswered_));
  return hash.value();
}

namespace {

void read_axes(text::TableReader& reader, Spec& spec) {
  if (const auto* grid = reader.table("grid", "give grid.threshold, grid.slope, grid.guess and grid.lapse")) {
    text::TableReader inner(*grid, reader.path("grid"), reader.findings());
    const auto axis = [&](const char* key, Grid& into) {
      if (const auto* value = inner.require(key, "write a grid: { from, to, step } or { values = [...] }"))
        into = read_grid(*value, inner.path(key), Axis::parameter, reader.findings());
    };
    axis("threshold", spec.threshold), axis("slope", spec.slope), axis("guess", spec.guess),
        axis("lapse", spec.lapse);
    inner.finish();
  }
  if (const auto* prior = reader.maybe_table("prior")) {
    text::TableReader inner(*prior, reader.path("prior"), reader.findings());
    const auto axis = [&](const char* key, Prior& into) {
      if (const auto* value = inner.take(key)) into = read_prior(*value, inner.path(key), reader.findings());
    };
    axis("threshold", spec.prior_threshold), axis("slope", spec.prior_slope), axis("guess", spec.prior_guess),
        axis("lapse", spec.prior_lapse);
    inner.finish();
  }
}

/// Reads the keys of every procedure with a posterior.
void read_grids(text::TableReader& reader, Spec& spec) {
  read_tracks(reader, spec);
  read_scale(reader, spec);
  const auto function = reader.word("function", {"weibull", "normal", "logistic"});
  spec.function = function == "normal"     ? terms::Function::normal
                  : function == "logistic" ? terms::Function::logistic
                                           : terms::Function::weibull;
  if (const auto* stimuli =
          reader.require("stimuli", "give the levels from which to choose: { from, to, step }"))
    spec.stimuli = read_grid(*stimuli, reader.path("stimuli"), Axis::stimuli, reader.findings());
  read_axes(reader, spec);
  read_stop(reader, spec);
}

void read_posterior(text::TableReader& reader, Spec& spec) {
  read_grids(reader, spec);
  const std::vector<std::string> parameters{"threshold", "slope", "guess", "lapse"};
  spec.nuisance = reader.maybe_strings("nuisance");
  for (const auto& name : spec.nuisance)
    if (std::find(parameters.begin(), parameters.end(), name) == parameters.end())
      reader.problem("nuisance", "\"" + name + "\" is not a parameter of the psychometric function",
                     "allowed: " + text::quoted_list(parameters));
  reader.word("select", {"min-expected-entropy"}, "min-expected-entropy");
}

void validate_rate(const char* key, const Grid& grid, std::vector<Problem>& problems) {
  for (const double rate : grid.values)
    if (!(rate >= 0 && rate < 1))
      return problems.push_back({key, "a rate is outside the range from 0 to 1",
                                 "write probabilities of at least 0 and less than 1"});
}

void validate_prior(const char* key, const Prior& prior, const Grid& grid, std::vector<Problem>& problems) {
  if (prior.weights.empty()) return;
  const auto values = grid.values.size();
  if (prior.weights.size() != values)
    problems.push_back({key, std::to_string(prior.weights.size()) + " weights",
                        "there must be one weight for each value of the grid: " + std::to_string(values)});
  else if (std::none_of(prior.weights.begin(), prior.weights.end(), [](double w) { return w > 0; }))
    problems.push_back({key, "all weights are 0", "at least one weight must be above 0"});
}

void validate_posterior(const Spec& spec, std::vector<Problem>& problems) {
  if (spec.stimuli.values.empty())
    problems.push_back({"stimuli", "missing", "give the levels from which to choose"});
  if (spec.threshold.values.empty())
    problems.push_back({"grid.threshold", "missing", "give the values of the threshold"});
  if (spec.slope.values.empty())
    problems.push_back({"grid.slope", "missing", "give the values of the slope"});
  if (!positive(spec.slope.values))
    problems.push_back({"grid.slope", "each slope must be above 0", "above 0"});
  validate_rate("grid.guess", spec.guess, problems);
  validate_rate("grid.lapse", spec.lapse, problems);
  validate_prior("prior.threshold", spec.prior_threshold, spec.threshold, problems);
  validate_prior("prior.slope", spec.prior_slope, spec.slope, problems);
  validate_prior("prior.guess", spec.prior_guess, spec.guess, problems);
  validate_prior("prior.lapse", spec.prior_lapse, spec.lapse, problems);
  // Largest number of combinations that may have to be evaluated per trial. Evaluating that many takes some
  // seconds on a small computer.
  constexpr double most = 5e7;
  double size = static_cast<double>(spec.stimuli.values.size());
  for (const auto* grid : {&spec.threshold, &spec.slope, &spec.guess, &spec.lapse})
    size *= static_cast<double>(std::max<std::size_t>(1, grid->values.size()));
  if (size > most)
    problems.push_back({"grid.threshold",
                        "the stimuli and grids have too many combinations to choose a level in time",
                        "allow at most 50 million combinations"});
  if (!spec.stop.trials && !spec.stop.threshold_sd && !spec.stop.entropy_nats && !spec.stop.right)
    problems.push_back({"stop", "no rule ends the procedure", "add trials or threshold_sd"});
}

void validate_at_threshold(const Spec& spec, std::vector<Problem>& problems) {
  validate_posterior(spec, problems);
  for (const auto& [key, grid] : {std::pair("grid.slope", &spec.slope), std::pair("grid.guess", &spec.guess),
                                  std::pair("grid.lapse", &spec.lapse)})
    if (grid->values.size() > 1)
      problems.push_back({key, "only the threshold is estimated", "one value, or quest-plus or psi instead"});
  const auto& prior = spec.prior_threshold;
  if (spec.kind == Kind::best_pest && (prior.normal || !prior.weights.empty()))
    problems.push_back({"prior.threshold", "the most likely threshold has no prior",
                        "leave it out, or write kind = \"zest\""});
}

std::unique_ptr<Procedure> make_quest_plus(const Spec& spec, const Context&, const random::Key&) {
  return std::make_unique<QuestPlus>(spec);
}

/// Returns the probability of an answer of 1 at the threshold of the assumed function, whose asymptotes are
/// `least` and `most`.
std::optional<double> share_at_threshold(const Spec& spec, double least, double most) {
  const double way = spec.function == Function::weibull ? 1 - std::exp(-1.0) : 0.5;
  return least + way * (most - least);
}

}  // namespace

extern const Description quest_plus{Kind::quest_plus,   "quest-plus",    Choice::posterior, read_posterior,
                                    validate_posterior, make_quest_plus, share_at_threshold};

extern const Description psi{Kind::psi,          "psi",           Choice::posterior, read_posterior,
                             validate_posterior, make_quest_plus, share_at_threshold};

extern const Description psi_marginal{Kind::psi_marginal, "psi-marginal",  Choice::posterior, read_posterior,
                                      validate_posterior, make_quest_plus, share_at_threshold};

extern const Description zest{
    Kind::zest,        "zest", Choice::posterior, read_grids, validate_at_threshold, make_quest_plus,
    share_at_threshold};

extern const Description best_pest{Kind::best_pest,       "best-pest",     Choice::posterior, read_grids,
                                   validate_at_threshold, make_quest_plus, share_at_threshold};

}  // namespace turnpoint::procedure
