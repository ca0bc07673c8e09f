#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "physics/python/array.hpp"
#include "station/analysis/diffusion.hpp"
#include "station/analysis/first_passage.hpp"
#include "station/analysis/group.hpp"
#include "station/analysis/psychometric_posterior.hpp"
#include "station/analysis/response_signal.hpp"
#include "station/analysis/scaling.hpp"
#include "station/analysis/trade.hpp"

// The fits of station/analysis for arrays. turnpoint/analysis.py checks the arrays, gives them equal lengths and
// numbers conditions and difficulties; NaN is a missing number.
namespace turnpoint::python {

namespace py = pybind11;

namespace {

using namespace analysis;
using Numbers = std::vector<double>;
using Flags = std::vector<bool>;
using Texts = std::vector<std::string>;

std::vector<std::string> sentences(const std::vector<Statement>& statements) {
  std::vector<std::string> all;
  for (const auto& one : statements) all.push_back(core::say(one.text, "en"));
  return all;
}

std::optional<double> known(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

/// Runs a fit while other Python threads run.
template <class Fit>
auto released(const Fit& fit) {
  const py::gil_scoped_release other_threads_run;
  return fit();
}

/// What a time says about a trial, with its deadline and the time from which answers were accepted.
Outcome outcome_of(double time_s, double deadline_s, double earliest_s) {
  if (time_s < earliest_s) return Outcome::anticipation;
  return std::isnan(time_s) || time_s > deadline_s ? Outcome::timeout : Outcome::answered;
}

DiffusionFit diffusion(const Numbers& times_s, const Flags& correct, const std::vector<std::size_t>& difficulty,
                       const Numbers& deadlines_s, const Numbers& earliest_s, std::size_t difficulties,
                       const DiffusionOptions& options, std::uint64_t seed) {
  std::vector<DiffusionTrial> trials;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const auto outcome = outcome_of(times_s[i], deadlines_s[i], earliest_s[i]);
    DiffusionTrial trial{difficulty[i], DiffusionTrial::Outcome::answered, correct[i], times_s[i],
                         known(deadlines_s[i])};
    if (outcome == Outcome::timeout)
      trial.outcome = DiffusionTrial::Outcome::late, trial.time_s = deadlines_s[i];
    else if (outcome == Outcome::anticipation)
      trial.outcome = DiffusionTrial::Outcome::early, trial.time_s = earliest_s[i];
    trials.push_back(trial);
  }
  return released([&] { return fit_diffusion(trials, difficulties, seed, 1, options); });
}

Trade speed_accuracy(const Numbers& times_s, const Flags& correct, const Texts& condition,
                     const Numbers& difficulty, const Numbers& deadlines_s, const Numbers& earliest_s,
                     const TradeOptions& options) {
  std::vector<TrialRecord> trials;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    TrialRecord trial;
    trial.trial_index = static_cast<int>(i);
    trial.instruction = condition[i];
    trial.difficulty = difficulty[i];
    trial.deadline_s = known(deadlines_s[i]);
    trial.anticipation_s = earliest_s[i];
    trial.outcome = outcome_of(times_s[i], deadlines_s[i], earliest_s[i]);
    if (trial.outcome == Outcome::answered) trial.correct = correct[i], trial.response_time_s = times_s[i];
    trials.push_back(trial);
  }
  return released([&] { return trade(trials, options); });
}

std::vector<SpeedAccuracyCurve> signal_curves(const Numbers& times_s, const Numbers& lags_s,
                                              const Flags& present, const Flags& yes, const Texts& condition,
                                              const Texts& order, Detecting detecting) {
  std::vector<TrialRecord> trials;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    TrialRecord trial;
    trial.instruction = condition[i];
    trial.right_choice = present[i];
    trial.response = yes[i];
    trial.correct = present[i] == yes[i];
    trial.response_time_s = times_s[i];
    trial.signal_s = lags_s[i];
    trials.push_back(trial);
  }
  return released([&] { return response_signal(trials, order, detecting, 1); });
}

/// One entry for each condition and level, and for each condition as a whole. In trials without a signal the
/// level is ignored if `detecting` is `presence`.
std::vector<Detection> detection(const Flags& present, const Flags& yes, const Numbers& level,
                                 const Texts& condition, const Texts& order, Detecting detecting) {
  std::vector<TrialRecord> trials;
  for (std::size_t i = 0; i < present.size(); ++i) {
    TrialRecord trial;
    trial.instruction = condition[i];
    trial.level = known(level[i]);
    trial.right_choice = present[i];
    trial.response = yes[i];
    trial.correct = present[i] == yes[i];
    trials.push_back(trial);
  }
  return released([&] { return detect(trials, order, detecting, 1); });
}

PosteriorFit psychometric(const Numbers& level, const std::vector<int>& trials, const std::vector<int>& positive,
                          const FitOptions& options, const std::optional<Range>& levels, std::uint64_t seed) {
  std::vector<LevelCount> counts;
  for (std::size_t i = 0; i < level.size(); ++i) counts.push_back({level[i], trials[i], positive[i]});
  return released([&] {
    if (levels)
      return fit_posterior(counts, options, prior_around(options.function, options.scale, *levels, {}), 0);
    const auto fit = fit_psychometric(counts, options);
    BootstrapOptions how;
    how.seed = seed, how.band_points = 0;
    return PosteriorFit{fit, bootstrap(fit, how)};
  });
}

/// A function of first_passage.hpp for each time.
py::array first_passage(const std::string& what, const py::array_t<double>& times_s,
                        const py::array_t<bool>& upper, const Diffusion& d) {
  const auto times = times_s.unchecked<1>();
  const auto sides = upper.unchecked<1>();
  Numbers values(static_cast<std::size_t>(times.shape(0)));
  const auto fill = [&](const auto& of) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto k = static_cast<py::ssize_t>(i);
      values[i] = of(static_cast<bool>(sides(k)), times(k));
    }
  };
  const FirstPassageDensity densities[] = {{d, false}, {d, true}};
  if (what == "density")
    fill([&](bool up, double time_s) { return densities[up ? 1 : 0].log_at(time_s); });
  else if (what == "distribution")
    fill([&](bool up, double time_s) { return log_distribution(d, up, time_s); });
  else if (what == "tail")
    fill([&](bool up, double time_s) { return log_tail(d, up, time_s); });
  else
    fill([&](bool, double time_s) { return log_survival(d, time_s); });
  return physics::python::array(std::move(values));
}

/// A Python class that shows a struct: each add() names a member.
template <class Struct>
class Shown {
 public:
  Shown(py::module_& module, const char* name, const char* what) : class_(module, name, what) {
    class_.def("__repr__", [this_name = std::string(name), fields = fields_](const py::object& self) {
      std::string text = this_name + "(";
      for (const auto& field : *fields)
        text += (text.back() == '(' ? "" : ", ") + field + "=" +
                py::repr(self.attr(field.c_str())).template cast<std::string>();
      return text + ")";
    });
  }
  template <class Get>
  Shown& add(const char* name, const Get& get, const char* what) {
    if constexpr (std::is_member_object_pointer_v<Get>)
      class_.def_readonly(name, get, what);
    else
      class_.def_property_readonly(name, get, what);
    fields_->push_back(name);
    return *this;
  }

 private:
  std::shared_ptr<std::vector<std::string>> fields_ = std::make_shared<std::vector<std::string>>();
  py::class_<Struct> class_;
};

template <class Struct>
auto spoken(const Struct& from) {
  return sentences(from.statements);
}

void add_diffusion(py::module_& module) {
  Shown<Estimate>(module, "Estimate", "A number and its interval. An end that the data do not determine is infinite.")
      .add("value", &Estimate::value, "the estimate")
      .add("low", [](const Estimate& one) { return one.interval.low; }, "lower end of the interval")
      .add("high", [](const Estimate& one) { return one.interval.high; }, "upper end of the interval")
      .add("confidence", [](const Estimate& one) { return one.interval.confidence; }, "of the interval");
  using E = DiffusionEstimates;
  const auto of_draws = [](auto member) {
    return [member](const E& from) {
      Numbers all;
      for (const auto& draw : from.draws) all.push_back(draw.*member);
      return physics::python::array(std::move(all));
    };
  };
  Shown<E>(module, "Diffusion", "A fitted diffusion; see diffusion().")
      .add("boundary", &E::boundary, "separation of the boundaries, scaled for noise of s = 0.1")
      .add("nondecision_s", &E::nondecision_s, "time outside the decision, s; its shortest value if it varies")
      .add("drift", &E::drift, "drift rate of each difficulty, per s, scaled for noise of s = 0.1")
      .add("start", &E::start, "relative start point; 0.5 is half-way")
      .add("contaminants", &E::contaminants, "proportion of trials that were no decision")
      .add("drift_sd", &E::drift_sd, "standard deviation of the drift between trials, s = 0.1")
      .add("nondecision_range_s", &E::nondecision_range_s, "range of the time outside the decision, s")
      .add("log_likelihood", &E::log_likelihood, "at the most probable parameters; densities per s")
      .add("effective_draws", &E::effective_draws, "independent draws that the draws are worth");
  auto shown = py::class_<E>(module.attr("Diffusion"));
  const auto draws = [&](const char* name, auto member, const char* what) {
    shown.def_property_readonly(name, of_draws(member), what);
  };
  draws("boundary_draws", &DiffusionDraw::boundary, "the boundary in each draw of equal weight");
  draws("nondecision_draws_s", &DiffusionDraw::nondecision_s, "the time outside the decision in each draw, s");
  shown.def_property_readonly(
      "drift_draws",
      [](const E& from) {
        py::array_t<double> all({from.draws.size(), from.drift.size()});
        for (std::size_t i = 0; i < from.draws.size(); ++i)
          for (std::size_t k = 0; k < from.drift.size(); ++k)
            all.mutable_at(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(k)) = from.draws[i].drift[k];
        return all;
      },
      "the drifts in each draw: one row per draw, one column per difficulty");
  module.def(
      "diffusion",
      [](const Numbers& times_s, const Flags& correct, const std::vector<std::size_t>& difficulty,
         const Numbers& deadlines_s, const Numbers& earliest_s, std::size_t difficulties, bool contaminants,
         bool start, bool drift_varies, bool nondecision_varies, bool likelihood, double confidence,
         std::uint64_t seed) {
        const DiffusionOptions options{contaminants, start, drift_varies, nondecision_varies,
                                       likelihood ? DiffusionOptions::Method::likelihood
                                                  : DiffusionOptions::Method::posterior,
                                       confidence};
        auto fit = diffusion(times_s, correct, difficulty, deadlines_s, earliest_s, difficulties, options, seed);
        return std::pair(std::move(fit.estimates), sentences(fit.statements));
      });
  module.def("first_passage", [](const std::string& what, const py::array_t<double>& times_s,
                                 const py::array_t<bool>& upper, double drift, double boundary, double start, double drift_sd, double delay_range_s) {
    return first_passage(what, times_s, upper,
                         {drift / kDiffusionScale, boundary / kDiffusionScale, start, drift_sd / kDiffusionScale,
                          delay_range_s});
  });
}

void add_speed_accuracy(py::module_& module) {
  using C = DifficultyCell;
  Shown<C>(module, "Cell", "The answers to one difficulty in one condition.")
      .add("difficulty", &C::difficulty, "as it was given")
      .add("answered", &C::answered, "number of answers whose times are kept")
      .add("correct", &C::correct, "number of right ones among them")
      .add("accuracy",
           [](const C& cell) { return Estimate{cell.proportion_correct, cell.accuracy}; },
           "proportion correct, with Wilson's interval")
      .add("mean_correct_s", &C::mean_correct_s, "mean time of right answers, s")
      .add("drift", &C::drift, "drift rate per s, s = 0.1");
  using I = InstructionResult;
  Shown<I>(module, "Condition", "One condition; see speed_accuracy().")
      .add("condition", &I::instruction, "its name")
      .add("presented", &I::presented, "number of trials")
      .add("answered", &I::answered, "number of trials that were answered in time")
      .add("late", &I::timeouts, "number of answers that came too late, or never")
      .add("early", &I::anticipations, "number of answers that came too early")
      .add("excluded", &I::excluded, "number of answers whose time the exclusion rule removes")
      .add("accuracy", &I::proportion_correct, "proportion correct, with Wilson's interval")
      .add("median_s", &I::median_s, "median response time, s, with a bootstrap interval")
      .add("lisas_s", &I::lisas_s, "linear integrated speed-accuracy score, s (Vandierendonck 2017)")
      .add("inverse_efficiency_s", &I::inverse_efficiency_s, "mean correct time / accuracy, s (Townsend & Ashby 1978)")
      .add("boundary", &I::boundary, "of the diffusion, s = 0.1")
      .add("nondecision_s", &I::nondecision_s, "time outside the decision, s")
      .add("drift", &I::drift, "mean drift rate over difficulties, per s, s = 0.1")
      .add("contaminants", &I::contaminants, "proportion of trials that were no decision")
      .add("post_error_s", &I::post_error_s, "slower after an error than before it, s (Dutilh et al. 2012)")
      .add("repetition", &I::repetition,
           "share of answers that repeat the last one minus the share of right answers that would; None without choices")
      .add("cells", &I::cells, "by difficulty")
      .add("statements", spoken<I>, "remarks, as in the report");
  Shown<Difference>(module, "Difference", "The second condition minus the first one.")
      .add("first", &Difference::first, "name of a condition")
      .add("second", &Difference::second, "name of a condition")
      .add("measure", &Difference::measure, "what differs")
      .add("unit", &Difference::unit, "of the measure")
      .add("estimate", &Difference::estimate, "the difference; None if it cannot be determined")
      .add("p", [](const Difference& one) { return one.estimate ? one.estimate->p : std::nullopt; },
           "two-sided p value, not corrected for the number of comparisons; holm() does");
  Shown<Trade>(module, "SpeedAccuracy", "Speed and accuracy by condition; see speed_accuracy().")
      .add("conditions", &Trade::instructions, "in order")
      .add("differences", &Trade::differences, "one for each measure and pair of conditions")
      .add("model_p", &Trade::model_p, "share of simulated sessions that the diffusion describes as badly as this one")
      .add("statements", spoken<Trade>, "remarks, as in the report");
  module.def("speed_accuracy", [](const Numbers& times_s, const Flags& correct, const Texts& condition,
                                  const Numbers& difficulty, const Numbers& deadlines_s, const Numbers& earliest_s,
                                  const Texts& order, std::optional<double> mad, double confidence,
                                  std::uint64_t seed) {
    TradeOptions options;
    options.order = order, options.confidence = confidence, options.seed = seed;
    if (mad) options.exclusion.mad = *mad;
    return speed_accuracy(times_s, correct, condition, difficulty, deadlines_s, earliest_s, options);
  });
}

void add_detection(py::module_& module) {
  py::enum_<Detecting>(module, "Detecting")
      .value("presence", Detecting::presence)
      .value("sides", Detecting::sides)
      .value("forced_choice", Detecting::forced_choice);
  const auto count = [](int YesNoCounts::*which) {
    return [which](const Detection& from) { return from.counts.*which; };
  };
  Shown<Detection>(module, "Detection", "Sensitivity in one condition; see detection().")
      .add("condition", &Detection::condition, "its name")
      .add("level", &Detection::level, "absolute value of the level; None for all levels together")
      .add("hits", count(&YesNoCounts::hits), "number of trials")
      .add("misses", count(&YesNoCounts::misses), "number of trials")
      .add("false_alarms", count(&YesNoCounts::false_alarms), "number of trials")
      .add("correct_rejections", count(&YesNoCounts::correct_rejections), "number of trials")
      .add("d_prime", &Detection::d_prime, "sensitivity, in standard deviations")
      .add("criterion", &Detection::criterion, "above 0 if \"yes\" is said too rarely");
  module.def("detection", &detection);
  Shown<RatingFit>(module, "Ratings", "The normal model of ratings; see ratings().")
      .add("mean", &RatingFit::mean, "mean with a signal; without, mean 0 and standard deviation 1")
      .add("sensitivity", &RatingFit::sensitivity, "d', or d_a with unequal variances")
      .add("sd", &RatingFit::sd, "standard deviation with a signal")
      .add("area", &RatingFit::area, "area under the curve of the model")
      .add("criteria", &RatingFit::criteria, "ascending")
      .add("log_likelihood", &RatingFit::log_likelihood, "without multinomial coefficients");
  module.def("ratings", [](const std::vector<int>& noise, const std::vector<int>& signal, bool unequal) {
    return fit_ratings(noise, signal, unequal ? Variances::unequal : Variances::equal);
  });
  module.def("area", [](const std::vector<int>& noise, const std::vector<int>& signal) {
    const auto curve = roc(noise, signal);
    return curve ? std::optional(curve->area) : std::nullopt;
  });
  using S = SpeedAccuracyCurve;
  Shown<LagPoint>(module, "Lag", "The answers at one lag.")
      .add("lag_s", &LagPoint::lag_s, "time of the signal, s")
      .add("time_s", &LagPoint::time_s, "mean time of the answers, s")
      .add("d_prime", &LagPoint::d_prime, "sensitivity");
  Shown<S>(module, "Curve", "How sensitivity grows with time; see response_signal().")
      .add("condition", &S::condition, "its name")
      .add("lags", &S::points, "ascending")
      .add("asymptote", &S::asymptote, "sensitivity that the curve approaches")
      .add("rate_per_s", &S::rate_per_s, "rate of approach, per s")
      .add("intercept_s", &S::intercept_s, "time at which the curve leaves 0, s")
      .add("statements", spoken<S>, "remarks, as in the report");
  module.def("response_signal", &signal_curves);
  using D = CurveDifference;
  const auto p_of = [](std::size_t which) { return [which](const D& pair) { return pair.p[which]; }; };
  Shown<D>(module, "CurveDifference", "The second curve compared with the first one; see compare_curves().")
      .add("first", &D::first, "name of a condition")
      .add("second", &D::second, "name of a condition")
      .add("asymptote", &D::asymptote, "the difference; None if a curve lacks it")
      .add("rate_ratio", &D::rate_ratio, "the second rate divided by the first one")
      .add("intercept_s", &D::intercept_s, "the difference, s")
      .add("asymptote_p", p_of(0), "p value of the model with one asymptote and everything else free")
      .add("rate_p", p_of(1), "p value of the model with one rate")
      .add("intercept_p", p_of(2), "p value of the model with one intercept");
  module.def("compare_curves", [](const std::vector<S>& curves) { return curve_differences(curves); });
  module.def("holm", [](const Numbers& p, const Texts& family) {
    std::vector<Tested> tests;
    for (std::size_t i = 0; i < p.size(); ++i) tests.push_back({family[i], known(p[i])});
    Numbers found;
    for (const auto& one : holm(tests)) found.push_back(one.value_or(std::numeric_limits<double>::quiet_NaN()));
    return physics::python::array(std::move(found));
  });
}

void add_psychometric(py::module_& module) {
  using P = PosteriorFit;
  // the estimate of a parameter with the interval that the report shows; without an interval, NaN at its ends
  const auto of = [](double Psychometric::*which, std::optional<ParameterInterval> PsychometricIntervals::*ends) {
    return [which, ends](const P& from) -> std::optional<Estimate> {
      if (!from.fit.parameters) return std::nullopt;
      constexpr double nan = std::numeric_limits<double>::quiet_NaN();
      const auto& interval = from.intervals.*ends;
      return Estimate{(*from.fit.parameters).*which, interval ? interval->interval : Interval{nan, nan, 0.95}};
    };
  };
  using I = PsychometricIntervals;
  Shown<P>(module, "Psychometric", "A psychometric function; see psychometric().")
      .add("threshold", of(&Psychometric::threshold, &I::threshold), "in the unit of the level")
      .add("slope", of(&Psychometric::slope, &I::slope),
           "Weibull: exponent; normal: standard deviation; logistic: 1 / scale")
      .add("guess", of(&Psychometric::guess, &I::guess), "lower asymptote")
      .add("lapse", of(&Psychometric::lapse, &I::lapse), "1 - upper asymptote")
      .add("deviance", [](const P& from) { return from.fit.deviance; }, "from one proportion per level")
      .add("deviance_p", [](const P& from) { return from.intervals.deviance_p; },
           "share of replicates with a deviance as large; None for a posterior")
      .add("negative_log_likelihood", [](const P& from) { return from.fit.negative_log_likelihood; },
           "of the individual answers, in nats")
      .add("statements",
           [](const P& from) {
             auto all = sentences(from.fit.statements);
             for (auto& one : sentences(from.intervals.statements)) all.push_back(std::move(one));
             return all;
           },
           "remarks, as in the report");
  module.def("psychometric", [](const Numbers& level, const std::vector<int>& trials, const std::vector<int>& positive,
                                const std::string& function, bool log10, const std::string& guess, double guess_value,
                                double lapse_high, const std::optional<Range>& levels, std::uint64_t seed) {
    FitOptions options;
    options.function = core::function_named(function);
    options.scale = log10 ? Scale::log10 : Scale::linear;
    options.guess = guess == "fixed" ? Guess::fixed : guess == "fitted" ? Guess::fitted : Guess::tied_to_lapse;
    options.guess_value = guess_value, options.lapse_high = lapse_high;
    return psychometric(level, trials, positive, options, levels, seed);
  });
}

void add_scale(py::module_& module) {
  using S = StimulusScale;
  const auto of_fit = [](auto which) {
    return [which](const S& from) { return from.fit ? std::optional((*from.fit).*which) : std::nullopt; };
  };
  const auto of_check = [](auto which) {
    return [which](const S& from) { return from.check ? std::optional((*from.check).*which) : std::nullopt; };
  };
  const auto of_triples = [](auto which) {
    return [which](const S& from) {
      return from.transitivity ? std::optional((*from.transitivity).*which) : std::nullopt;
    };
  };
  Shown<S>(module, "Scale", "The scale of one condition; see scale().")
      .add("condition", &S::condition, "its name")
      .add("stimuli", &S::stimuli, "values of the stimuli, ascending")
      .add("values", of_fit(&ScaleFit::values), "place of each stimulus on the scale")
      .add(
          "noise", [](const S& from) { return from.fit ? from.fit->noise : std::nullopt; },
          "differences: standard deviation of the noise of a comparison; otherwise None")
      .add(
          "favours_second", [](const S& from) { return from.fit ? from.fit->favours_second : std::nullopt; },
          "how much the order favours the answer \"second\", in the unit of the values, or (differences) "
          "standard deviations of "
          "the noise; None if not every order came")
      .add("log_likelihood", of_fit(&ScaleFit::log_likelihood), "of the answers")
      .add("deviance", of_fit(&ScaleFit::deviance), "from one proportion per presentation")
      .add("degrees", of_fit(&ScaleFit::degrees), "degrees of freedom of the deviance")
      .add("deviance_p", of_check(&ScaleCheck::deviance_p),
           "share of simulated sessions with a deviance as large")
      .add("runs", of_check(&ScaleCheck::runs), "runs of answers, in the order of what is expected")
      .add("runs_p", of_check(&ScaleCheck::runs_p), "share of simulated sessions with as few runs")
      .add(
          "six_points_p", [](const S& from) { return from.check ? from.check->six_points_p : std::nullopt; },
          "quadruples: share of simulated sessions with answers as unlikely in the sets of the six-point "
          "property")
      .add("triples", of_triples(&Transitivity::triples), "pairs: number of triples")
      .add("circular", of_triples(&Transitivity::circular), "pairs: triples that violate weak transitivity")
      .add("moderate", of_triples(&Transitivity::moderate),
           "pairs: triples that violate moderate transitivity")
      .add("strong", of_triples(&Transitivity::strong), "pairs: triples that violate strong transitivity")
      .add(
          "consistence",
          [](const S& from) { return from.transitivity ? from.transitivity->consistence : std::nullopt; },
          "pairs: Kendall's coefficient, 1 without circular triples")
      .add("statements", spoken<S>, "remarks, as in the report");
  module.def("scale", [](const std::vector<Numbers>& stimuli, const Flags& second, const Texts& condition,
                         const Texts& order, const std::string& model, int sessions) {
    std::vector<TrialRecord> trials;
    for (std::size_t i = 0; i < stimuli.size(); ++i) {
      TrialRecord trial;
      trial.compared = stimuli[i], trial.response = second[i] ? 1 : 0, trial.instruction = condition[i];
      trials.push_back(trial);
    }
    const auto by = model == "thurstone"     ? ScaleModel::thurstone
                    : model == "differences" ? ScaleModel::differences
                                             : ScaleModel::bradley_terry;
    return released([&] { return scales(trials, order, by, sessions); });
  });
}

}  // namespace

}  // namespace turnpoint::python

PYBIND11_MODULE(_analysis, module) {
  turnpoint::physics::python::require_suitable_numpy();
  module.doc() = "Fits of the report for arrays. Use turnpoint.analysis.";
  turnpoint::python::add_diffusion(module);
  turnpoint::python::add_speed_accuracy(module);
  turnpoint::python::add_detection(module);
  turnpoint::python::add_psychometric(module);
  turnpoint::python::add_scale(module);
}
