#include "station/procedure/procedure_keys.hpp"

#include "station/procedure/grid.hpp"
#include "station/procedure/keys.hpp"
#include "station/procedure/spec.hpp"

namespace turnpoint::procedure {

// The short names of this file are nobody else's.
namespace declarations {
namespace {

using core::Key;
using core::Keys;
using core::Range;
using namespace core::key;
using Ends = Range::Ends;
using Words = std::vector<std::string>;

const Range positive_step{0, 1e6, Ends::open_low};

const Words listed{"constant-stimuli", "adjustment"};
const Words staircases{"up-down", "weighted-up-down"};
const Words tracks{"up-down", "weighted-up-down", "accelerated-stochastic-approximation"};
const Words two_dimensions{"quest-plus", "psi", "psi-marginal"};
const Words posteriors{"quest-plus", "psi", "psi-marginal", "zest", "best-pest"};

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// The forms of a grid of values.
std::vector<Key> grid_forms() {
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

Key grid(const char* name, const char* help) { return several(name, grid_forms(), help); }

Key parameter_grid(const char* name, const char* help) {
  auto forms = grid_forms();
  forms.push_back(
      table("", {word("tied", {"lapse"}, "the same value as the lapse rate: for guess").required()}, ""));
  return several(name, std::move(forms), help);
}

Key prior(const char* name) {
  Keys keys{table("normal",
                  {number("mean", any_level, "mean").required(),
                   number("sd", positive_step, "standard deviation").required()},
                  "a normal distribution"),
            numbers("weights", {0, 1e12}, "one weight for each value of the grid")};
  return table(name, keys.one_of({"normal", "weights"}), "how plausible each value is beforehand")
      .without_it("all alike");
}

Key order(bool listed_levels) {
  Keys keys;
  if (listed_levels) {
    keys.list.push_back(
        word("shuffle", {"within-repeat", "within-block", "none"}, "among which trials the order is drawn")
            .by_default("\"within-repeat\"")
            .only_without("after_each_other"));
    keys.list.push_back(
        strings("after_each_other",
                "factors of which each combination of values comes equally often after each other "
                "one; the level, or those of \"balance\""));
    keys.list.push_back(
        integer("back", 1, 5, "how many trials back that holds: 2 for each value after each pair of values")
            .by_default("1")
            .only_with("after_each_other"));
    keys.list.push_back(table(
        "never_after",
        Keys{}.with_free_names(list("FACTOR",
                                    {numbers("", any_level, "").holding(2, 2), strings("", "").holding(2, 2)},
                                    "pairs of its values")),
        "pairs of values, of which the second never comes right after the first"));
  }
  keys.list.push_back(several(
      "max_run",
      {integer("", 1, 1000, ""),
       table("",
             Keys{}.with_free_names(integer("FACTOR", 1, 1000, "longest run of one value of this factor")),
             "")},
      "most trials in a row with the same right answer; or with the same value of each named factor"));
  return table("order", keys, "the order of the trials");
}

Keys right_of_last() {
  return {
      integer("right", 1, 1000, "ends as soon as so many answers were right (or those that it tracks) ...")
          .only_with("of_last"),
      integer("of_last", 1, 1000, "... of so many last ones; suits training").only_with("right")};
}

Keys rules(bool steps) {
  Keys keys{
      integer("trials", 1, 100000, "ends after so many trials"),
      integer("reversals", 1, 10000, "ends after so many reversals"),
      integer("min_trials", 1, 100000, "but not before so many trials"),
      integer("max_trials", 1, 100000, "but in any case after so many trials")
          .without_it(
              "400, or four times what the rules ask for if that is more (10 trials for each reversal)"),
      number("threshold_sd", positive_step,
             "QUEST+, psi and others with a posterior: ends when the threshold's standard deviation is at "
             "most this"),
      number("entropy_nats", {-100, 100}, "the same for the entropy of the posterior")};
  if (steps)
    keys.list.push_back(
        integer("limit_steps", 1, 1000, "ends after so many steps in a row that min or max refuses")
            .by_default("10"));
  keys.and_also(right_of_last());
  keys.list.push_back(word("rule", {"or", "and"}, "whether one of several rules is enough")
                          .without_it("needed with several rules"));
  return keys;
}

Key starts(const char* name, const char* help) {
  return several(
             name,
             {numbers("", any_level, ""),
              table("",
                    {interval("uniform", any_level, "each series draws its start between these").required()},
                    "")},
             help)
      .only_with("kind", {"limits"});
}

Keys all() {
  Words parameters;
  for (const auto& parameter : kParameters) parameters.emplace_back(parameter.name);
  Keys grids{
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
  Keys priors;
  for (const auto& name : parameters) priors.list.push_back(prior(name.c_str()));
  const auto spanned = joined(tracks, {"limits", "program"});
  const auto answering = joined(joined(tracks, posteriors), {"program"});
  return {
      string("tracks", "id of the answer that is more frequent at higher levels")
          .required()
          .only_with("kind", {"limits"}),
      string("tracks", "id of the answer that it follows instead of correctness")
          .only_with("kind", answering),
      numbers("values", any_level, "the levels").required().only_with("kind", {"constant-stimuli"}),
      numbers("values", any_level, "the stimuli that are compared with each other")
          .required()
          .only_with("kind", {"comparisons"}),
      strings("against",
              "the factors of the other intervals, in order: one for all pairs of the values (in both "
              "orders), two "
              "for all triads, three for all quadruples")
          .holding(1, 3)
          .required()
          .only_with("kind", {"comparisons"}),
      integer("repeats", 1, 10000, "how often each level is presented").required().only_with("kind", listed),
      integer("repeats", 1, 10000,
              "how often each pair is presented in each order, or each triad or quadruple")
          .required()
          .only_with("kind", {"comparisons"}),
      strings("balance",
              "factors whose levels are combined equally often with each level (and with each other)")
          .holding(0)
          .only_with("kind", listed),
      order(true).only_with("kind", listed),
      order(false).only_with("kind", joined(answering, {"limits"})),
      numbers("start", any_level,
              "where the slider starts: below or above, as seen from the middle of the list")
          .only_with("kind", {"adjustment"}),
      numbers("start_below", any_level, "where the slider starts below").only_with("kind", {"adjustment"}),
      numbers("start_above", any_level, "where the slider starts above; as many as below")
          .only_with("kind", {"adjustment"}),
      number("start", any_level, "the first level").required().only_with("kind", tracks),
      number("min", any_level, "lowest level").required().only_with("kind", spanned),
      number("max", any_level, "highest level").required().only_with("kind", spanned),
      numbers("step", positive_step,
              "step sizes in both directions: each reversal moves on to the next, and the last stays")
          .only_with("kind", staircases),
      number("step", positive_step, "the step")
          .required()
          .only_with("kind", {"accelerated-stochastic-approximation", "limits"}),
      numbers("step_down", positive_step,
              "step sizes down, if those up differ; weighted-up-down needs these only")
          .only_with("kind", staircases),
      numbers("step_up", positive_step, "step sizes up").only_with("kind", {"up-down"}),
      integer("n_down", 1, 20, "right answers in a row that lower the level")
          .required()
          .only_with("kind", {"up-down"}),
      integer("n_up", 1, 20, "wrong answers in a row that raise the level")
          .by_default("1")
          .only_with("kind", {"up-down"}),
      integer("initial_down", 1, 20, "`n_down` before the first reversal")
          .without_it("`n_down`")
          .only_with("kind", {"up-down"}),
      integer("discard_reversals", 0, 1000,
              "first reversals that the estimate leaves out; 4 if the start is far from the threshold")
          .by_default("0")
          .only_with("kind", staircases),
      starts("start_ascending",
             "levels at which ascending series start: each is used equally often, or each series draws one"),
      starts("start_descending", "levels at which descending series start, in the same forms"),
      integer("series", 1, 1000, "number of series; with both directions, half of them each")
          .required()
          .only_with("kind", {"limits"}),
      integer("n_change", 1, 20, "new answers in a row that end a series; with 2, a slip does not")
          .by_default("1")
          .only_with("kind", {"limits"}),
      word("directions", {"alternate", "random"},
           "the directions take turns (the first is drawn), or are shuffled, each equally often")
          .by_default("\"alternate\"")
          .only_with("kind", {"limits"}),
      number("target", {0, 1, Ends::open},
             "proportion of right answers (or of those that it tracks) on which it converges")
          .required()
          .only_with("kind", {"weighted-up-down", "accelerated-stochastic-approximation"}),
      word("scale", {"linear", "log10", "dB"},
           "on which scale steps are counted, and level and threshold compared: \"linear\" for differences "
           "(also of levels in dB), else for ratios")
          .by_default("\"linear\"")
          .only_with("kind", joined(joined(tracks, posteriors), {"limits"})),
      word("function", {"weibull", "normal", "logistic", "signal-detection"},
           "the assumed psychometric function")
          .required()
          .only_with("kind", posteriors),
      grid("stimuli", "the levels from which it chooses").required().only_with("kind", posteriors),
      table(
          "second",
          {string("level", "the second factor that it sets").required(),
           grid("stimuli", "the values from which it chooses").required(),
           number("origin", any_level, "the value at which grid.threshold applies; choose it near the middle")
               .by_default("0")},
          "a second dimension, along which the threshold changes")
          .only_with("kind", two_dimensions),
      table("grid", grids, "the values of each parameter").required().only_with("kind", posteriors),
      table("prior", priors, "what is believed before the first trial, for each parameter; even without it")
          .only_with("kind", posteriors),
      words("nuisance", parameters, "psi-marginal: parameters that are not to be estimated")
          .only_with("kind", two_dimensions),
      word("select", {"min-expected-entropy"}, "how it chooses the next level")
          .by_default("\"min-expected-entropy\"")
          .only_with("kind", two_dimensions),
      string("program", "file of a separate program that chooses the levels, as seen from this file")
          .required()
          .only_with("kind", {"program"}),
      number("limit_s", {0.05, 60, Ends::closed, "s"},
             "longest time that the program may take for each reply")
          .by_default("2")
          .only_with("kind", {"program"}),
      table("settings", Keys{}.with_free_names(any("NAME", "what the program gets as it is")),
            "what the program gets as it is")
          .only_with("kind", {"program"}),
      table("stop", rules(true), "when it ends").required().only_with("kind", tracks),
      table("stop", rules(false), "when it ends")
          .required()
          .only_with("kind", joined(posteriors, {"program"})),
      table("stop", right_of_last(), "when it ends before all trials")
          .only_with("kind", {"constant-stimuli"}),
  };
}

}  // namespace
}  // namespace declarations

core::Keys procedure_keys() { return declarations::all(); }

}  // namespace turnpoint::procedure
