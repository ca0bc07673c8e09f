#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "station/core/number.hpp"
#include "station/procedure/description.hpp"
#include "station/procedure/grid.hpp"
#include "station/procedure/keys.hpp"
#include "station/procedure/psychometric.hpp"
#include "station/procedure/quest_plus.hpp"

// The descriptions of all procedures with a posterior: their keys, and which specifications are wrong.
namespace turnpoint::procedure {

using core::phrase, core::plain;

namespace {

/// The forms of a grid of values.
std::vector<core::Key> grid_forms() {
  using namespace core::key;
  const auto whole = [](const char* name) {
    return integer(name, 2, most_grid_points, "number of values").required();
  };
  return {
      table("",
            {number("from", any_level, "first value").required(),
             number("to", any_level, "last value").required(),
             number("step", positive_step, "from each value to the next").required()},
            ""),
      table("",
            {number("from", any_level, "first value").required(),
             number("to", any_level, "last value").required(), whole("count")},
            ""),
      table("",
            {number("log_from", {1e-9, 1e9}, "first value").required(),
             number("log_to", {1e-9, 1e9}, "last value; the ratio from each value to the next is the same")
                 .required(),
             whole("count")},
            ""),
      table("", {numbers("values", any_level, "the values, in ascending order").required()}, "")};
}

core::Key grid(const char* name, const char* help) { return core::key::several(name, grid_forms(), help); }

core::Key parameter_grid(const char* name, const char* help) {
  using namespace core::key;
  auto forms = grid_forms();
  forms.push_back(
      table("", {word("tied", {"lapse"}, "the same value as the lapse rate: for guess").required()}, ""));
  return several(name, std::move(forms), help);
}

core::Key prior(const char* name) {
  using namespace core::key;
  core::Keys keys{table("normal",
                        {number("mean", any_level, "mean").required(),
                         number("sd", positive_step, "standard deviation").required()},
                        "a normal distribution"),
                  numbers("weights", {0, 1e12}, "one weight for each value of the grid")};
  return table(name, keys.one_of({"normal", "weights"}), "how plausible each value is beforehand")
      .without_it("all alike");
}

/// The keys of every procedure with a posterior, and those of this kind.
core::Keys grid_keys(const core::Keys& second, const core::Keys& choosing) {
  using namespace core::key;
  core::Keys grids{
      parameter_grid("threshold", "threshold"),
      parameter_grid(
          "gradient",
          "change of the threshold per unit of the second factor; with a scale of ratios in decades or dB"),
      parameter_grid("floor", "lowest threshold, with a second factor"),
      parameter_grid("slope", "slope; let the values begin at 0.5"),
      parameter_grid("criterion",
                     "with function = \"signal-detection\", instead of guess: the criterion in standard "
                     "deviations of the noise"),
      parameter_grid("guess", "guess rate: 0.5 for two answers, 0.333 for three"),
      parameter_grid("lapse", "lapse rate")};
  core::Keys priors;
  for (const auto& parameter : kParameters) priors.list.push_back(prior(parameter.name));
  core::Keys keys{tracks_key(), scale_key(),
                  word("function", {"weibull", "normal", "logistic", "signal-detection"},
                       "the assumed psychometric function")
                      .required(),
                  grid("stimuli", "the levels from which it chooses").required()};
  keys.and_also(second);
  keys.and_also({table("grid", grids, "the values of each parameter").required(),
                 table("prior", priors,
                       "what is believed before the first trial, for each parameter; even without it")});
  keys.and_also(choosing);
  return keys.and_also({stop_key()});
}

core::Keys threshold_keys() { return grid_keys({}, {}); }

core::Keys posterior_keys() {
  using namespace core::key;
  std::vector<std::string> parameters;
  for (const auto& parameter : kParameters) parameters.emplace_back(parameter.name);
  return grid_keys({table("second",
                          {string("level", "the second factor that it sets").required(),
                           grid("stimuli", "the values from which it chooses").required(),
                           number("origin", any_level,
                                  "the value at which grid.threshold applies; choose it near the middle")
                               .by_default("0")},
                          "a second dimension, along which the threshold changes")},
                   {words("nuisance", parameters, "psi-marginal: parameters that are not to be estimated"),
                    word("select", {"min-expected-entropy"}, "how it chooses the next level")
                        .by_default("\"min-expected-entropy\"")});
}

/// True if this parameter must have a grid: `grid.gradient` with a second dimension, `grid.criterion` with
/// signal detection, and all others except the floor. With signal detection there is no guess rate.
bool needs_grid(const Spec& spec, const std::string& parameter) {
  if (parameter == "gradient") return spec.second.has_value();
  if (parameter == "criterion") return spec.signal_detection;
  if (parameter == "guess") return !spec.signal_detection;
  return parameter != "floor";
}

void read_axes(core::TableReader& reader, Spec& spec) {
  std::string needed;  // besides the lapse rate, which is the last parameter
  for (const auto& parameter : kParameters)
    if (needs_grid(spec, parameter.name) && std::string(parameter.name) != "lapse")
      needed += (needed.empty() ? "grid." : ", grid.") + std::string(parameter.name);
  if (const auto* grid = reader.table("grid")) {
    core::TableReader inner(*grid, reader.path("grid"), reader.findings(), reader.keys("grid"));
    for (const auto& [key, axis, prior] : kParameters) {
      const auto* value = needs_grid(spec, key) ? inner.require(key) : inner.take(key);
      if (value) spec.*axis = read_grid(*value, inner, key);
    }
    inner.finish();
  }
  if (const auto* table = reader.maybe_table("prior")) {
    core::TableReader inner(*table, reader.path("prior"), reader.findings(), reader.keys("prior"));
    for (const auto& [key, axis, prior] : kParameters)
      if (const auto* value = inner.take(key)) spec.*prior = read_prior(*value, inner, key);
    inner.finish();
  }
}

void read_second(core::TableReader& reader, Spec& spec) {
  const auto* table = reader.maybe_table("second");
  if (!table) return;
  core::TableReader inner(*table, reader.path("second"), reader.findings(), reader.keys("second"));
  auto& second = spec.second.emplace();
  second.level = inner.string("level");
  if (const auto* stimuli = inner.require(
          "stimuli", phrase("give the values from which to choose: %1", {plain("{ from, to, step }")})))
    second.stimuli = read_grid(*stimuli, inner, "stimuli");
  second.origin = inner.number("origin");
  inner.finish();
}

/// Reads the keys of every procedure with a posterior.
void read_grids(core::TableReader& reader, Spec& spec) {
  read_tracks(reader, spec);
  read_scale(reader, spec);
  const auto function = reader.word("function");
  spec.signal_detection = function == "signal-detection";
  spec.function = core::function_named(function);
  if (const auto* stimuli = reader.require(
          "stimuli", phrase("give the levels from which to choose: %1", {plain("{ from, to, step }")})))
    spec.stimuli = read_grid(*stimuli, reader, "stimuli");
  read_axes(reader, spec);
  read_stop(reader, spec);
}

void read_posterior(core::TableReader& reader, Spec& spec) {
  read_second(reader, spec);
  read_grids(reader, spec);
  const auto& parameters = reader.words("nuisance");
  spec.nuisance = reader.maybe_strings("nuisance");
  for (const auto& name : spec.nuisance)
    if (std::find(parameters.begin(), parameters.end(), name) == parameters.end())
      reader.problem("nuisance",
                     phrase("\"%1\" is not a parameter of the psychometric function", {plain(name)}),
                     phrase("allowed: %1", {core::quoted_list(parameters)}));
  reader.word("select");
}

void validate_rate(const char* key, const Grid& grid, std::vector<Problem>& problems) {
  for (const double rate : grid.values)
    if (!(rate >= 0 && rate < 1))
      return problems.push_back({key, phrase("a rate is outside the range from 0 to 1"),
                                 phrase("write probabilities of at least 0 and less than 1")});
}

void validate_prior(const std::string& key, const Prior& prior, const Grid& grid,
                    std::vector<Problem>& problems) {
  if (prior.weights.empty()) return;
  const auto values = grid.values.size();
  if (prior.weights.size() != values)
    problems.push_back({key, phrase("%1 weights", {plain(prior.weights.size())}),
                        phrase("there must be one weight for each value of the grid: %1", {plain(values)})});
  else if (std::none_of(prior.weights.begin(), prior.weights.end(), [](double w) { return w > 0; }))
    problems.push_back({key, phrase("all weights are 0"), phrase("at least one weight must be above 0")});
}

/// Adds a problem if the tables of the posterior would be too large: choosing a stimulus would take too long,
/// or the memory of a small computer would not be enough.
void validate_size(const Spec& spec, std::vector<Problem>& problems) {
  constexpr double most = 5e7, most_distances = 5e6, bytes_each = 8;
  const auto count = [](const Grid& grid) {
    return static_cast<double>(std::max<std::size_t>(1, grid.values.size()));
  };
  const double stimuli = count(spec.stimuli) * (spec.second ? count(spec.second->stimuli) : 1);
  double parameters = 1;
  for (const auto& parameter : kParameters) parameters *= count(spec.*parameter.grid);
  const double places = count(spec.threshold) * count(spec.gradient) * count(spec.floor);
  if (stimuli * parameters > most)
    problems.push_back({"grid.threshold",
                        phrase("%1 stimuli and %2 points of the grid make %3 combinations, too many to "
                               "choose a level in time (up to %4 MB)",
                               {plain(core::number(stimuli)), plain(core::number(parameters)),
                                plain(core::number(stimuli * parameters, 3)),
                                plain(core::number(stimuli * parameters * bytes_each / 1e6, 3))}),
                        phrase("allow at most 50 million combinations (up to 400 MB)")});
  else if (stimuli * places > most_distances)
    problems.push_back({"grid.threshold",
                        spec.second
                            ? phrase("%1 stimuli and %2 thresholds, gradients and floors make %3 pairs, too "
                                     "many for the memory",
                                     {plain(core::number(stimuli)), plain(core::number(places)),
                                      plain(core::number(stimuli * places, 3))})
                            : phrase("%1 stimuli and %2 thresholds make %3 pairs, too many for the memory",
                                     {plain(core::number(stimuli)), plain(core::number(places)),
                                      plain(core::number(stimuli * places, 3))}),
                        phrase("allow at most 5 million pairs")});
}

void validate_second(const Spec& spec, std::vector<Problem>& problems) {
  const auto unused = [&](const char* parameter, const Grid& grid, const Prior& prior) {
    for (const auto& [table, given] :
         {std::pair("grid.", !grid.values.empty() || !grid.tied.empty()),
          std::pair("prior.", prior.normal.has_value() || !prior.weights.empty())})
      if (given && !spec.second)
        problems.push_back({table + std::string(parameter), phrase("there is no second dimension"),
                            phrase("leave it out, or add %1", {plain("second = { level, stimuli }")})});
  };
  unused("gradient", spec.gradient, spec.prior_gradient);
  unused("floor", spec.floor, spec.prior_floor);
  if (!spec.second) return;
  if (spec.second->stimuli.values.empty())
    problems.push_back({"second.stimuli", plain("missing"), phrase("give the values from which to choose")});
  if (spec.second->level == spec.level)
    problems.push_back({"second.level", phrase("\"%1\" is the first dimension too", {plain(spec.level)}),
                        phrase("another factor")});
  if (spec.gradient.values.empty())
    problems.push_back(
        {"grid.gradient", plain("missing"),
         phrase("give the values of the change of the threshold per unit of the second dimension")});
  if (spec.scale != Scale::linear && !positive(spec.floor.values))
    problems.push_back({"grid.floor", phrase("on a logarithmic scale each floor must be above 0"),
                        phrase("above %1", {plain("0")})});
}

void validate_detection(const Spec& spec, std::vector<Problem>& problems) {
  if (!spec.signal_detection) {
    if (!spec.criterion.values.empty() || !spec.criterion.tied.empty())
      problems.push_back({"grid.criterion",
                          phrase("only %1 has a criterion", {plain("function = \"signal-detection\"")}),
                          phrase("leave it out, or set this function")});
    return;
  }
  if (!spec.guess.values.empty() || !spec.guess.tied.empty())
    problems.push_back({"grid.guess", phrase("in signal detection, false alarms follow from the criterion"),
                        phrase("leave it out, and give grid.criterion")});
  if (spec.criterion.values.empty())
    problems.push_back(
        {"grid.criterion", plain("missing"), phrase("give the values of the criterion, such as 0 to 2")});
  if (spec.tracks.empty())
    problems.push_back({"tracks", plain("missing"), phrase("write the id of the answer that means \"yes\"")});
  for (const double lapse : spec.lapse.values)
    if (lapse >= 0.5)
      return problems.push_back(
          {"grid.lapse", phrase("both asymptotes would be on the wrong side"), phrase("less than 0.5")});
}

void validate_posterior(const Spec& spec, std::vector<Problem>& problems) {
  if (spec.stimuli.values.empty())
    problems.push_back({"stimuli", plain("missing"), phrase("give the levels from which to choose")});
  if (spec.threshold.values.empty())
    problems.push_back({"grid.threshold", plain("missing"), phrase("give the values of the threshold")});
  if (spec.slope.values.empty())
    problems.push_back({"grid.slope", plain("missing"), phrase("give the values of the slope")});
  if (!positive(spec.slope.values))
    problems.push_back(
        {"grid.slope", phrase("each slope must be above 0"), phrase("above %1", {plain("0")})});
  for (const auto& parameter : kParameters)
    if (const auto& tied = (spec.*parameter.grid).tied;
        !tied.empty() && std::string(parameter.name) != "guess" && std::string(parameter.name) != "lapse")
      problems.push_back({std::string("grid.") + parameter.name,
                          phrase("only the guess rate can be tied to the lapse rate"),
                          phrase("write the values of this parameter")});
  validate_rate("grid.guess", spec.guess, problems);
  validate_rate("grid.lapse", spec.lapse, problems);
  for (const auto& [key, grid, prior] : kParameters)
    validate_prior(std::string("prior.") + key, spec.*prior, spec.*grid, problems);
  validate_second(spec, problems);
  validate_detection(spec, problems);
  validate_size(spec, problems);
  if (!spec.stop.trials && !spec.stop.threshold_sd && !spec.stop.entropy_nats && !spec.stop.right)
    problems.push_back({"stop", phrase("no rule ends the procedure"), phrase("add trials or threshold_sd")});
}

void validate_at_threshold(const Spec& spec, std::vector<Problem>& problems) {
  validate_posterior(spec, problems);
  for (const auto& [key, grid, unused] : kParameters)
    if (grid != &Spec::threshold && (spec.*grid).values.size() > 1)
      problems.push_back({std::string("grid.") + key, phrase("only the threshold is estimated"),
                          phrase("one value, or quest-plus or psi instead")});
  const auto& prior = spec.prior_threshold;
  if (spec.kind == Kind::best_pest && (prior.normal || !prior.weights.empty()))
    problems.push_back({"prior.threshold", phrase("the most likely threshold has no prior"),
                        phrase("leave it out, or write %1", {plain("kind = \"zest\"")})});
}

std::unique_ptr<Procedure> make_quest_plus(const Spec& spec, const Context&, const core::DrawKey&) {
  return std::make_unique<QuestPlus>(spec);
}

/// Returns the probability of an answer of 1 at the threshold of the assumed function, whose asymptotes are
/// `least` and `most`. In signal detection, `least` is the rate of false alarms, from which the criterion
/// follows; d' is 1 at the threshold.
std::optional<double> share_at_threshold(const Spec& spec, double least, double most) {
  if (spec.signal_detection) {
    const double lapse = 1 - most, between = 1 - 2 * lapse;
    if (!(between > 0) || !(least > lapse)) return std::nullopt;
    return lapse + between * normal_cdf(1 + normal_quantile((least - lapse) / between));
  }
  const double way = spec.function == Function::weibull ? 1 - std::exp(-1.0) : 0.5;
  return least + way * (most - least);
}

}  // namespace

extern const Description quest_plus{"quest-plus",       Choice::posterior, posterior_keys,    read_posterior,
                                    validate_posterior, make_quest_plus,   share_at_threshold};

extern const Description psi{
    "psi",           Choice::posterior, posterior_keys, read_posterior, validate_posterior,
    make_quest_plus, share_at_threshold};

extern const Description psi_marginal{"psi-marginal",    Choice::posterior,  posterior_keys,
                                      read_posterior,    validate_posterior, make_quest_plus,
                                      share_at_threshold};

extern const Description zest{
    "zest",          Choice::posterior, threshold_keys, read_grids, validate_at_threshold,
    make_quest_plus, share_at_threshold};

extern const Description best_pest{"best-pest",           Choice::posterior, threshold_keys,    read_grids,
                                   validate_at_threshold, make_quest_plus,   share_at_threshold};

}  // namespace turnpoint::procedure
