#include "station/report/study.hpp"

#include <algorithm>
#include <cmath>

#include "station/analysis/quantile.hpp"
#include "station/core/number.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/meaning.hpp"
#include "station/report/measures.hpp"

namespace turnpoint::report {

namespace {

using analysis::Outcome;
using analysis::PersonMeasure;
using analysis::TrialType;

constexpr const char* kMeanCorrect = "mean time of right answers";

void count_trials(const SessionData& data, StudyPerson& person) {
  int right = 0, scored = 0, timeouts = 0, anticipations = 0;
  std::vector<double> times;
  int with_catches = 0;
  for (const auto& trial : data.trials) {
    const bool catches = trial.type == TrialType::catch_trial;
    if ((trial.type != TrialType::experimental && !catches) || trial.outcome == Outcome::fault ||
        trial.outcome == Outcome::aborted)
      continue;
    // Whoever leaves catch trials unanswered is too late as well.
    ++with_catches;
    timeouts += trial.outcome == Outcome::timeout;
    anticipations += trial.outcome == Outcome::anticipation;
    if (catches) continue;
    ++person.presented;
    if (trial.outcome != Outcome::answered) continue;
    ++person.answered;
    if (trial.response_time_s) times.push_back(*trial.response_time_s);
    if (!trial.correct) continue;
    ++scored;
    right += *trial.correct;
  }
  if (with_catches > 0) {
    person.timeouts = static_cast<double>(timeouts) / with_catches;
    person.anticipations = static_cast<double>(anticipations) / with_catches;
  }
  if (scored > 0 && data.scored) person.accuracy = static_cast<double>(right) / scored;
  if (!times.empty()) person.median_time_s = analysis::quantile(std::move(times), 0.5);
  if (const auto catches = analysis::catch_accuracy(data.trials)) person.catch_accuracy = catches->value;
}

std::string percent(double share) { return core::number(100 * share, 3) + " %"; }

/// One rule of exclusion: the rule in words, and how one participant breaks it ("" if the participant does
/// not break it).
struct StudyRule {
  std::string words, broken;
};

/// Adds the exclusion rule that a proportion, such as accuracy, must not be below (or above) a limit.
void add_share(std::vector<StudyRule>& rules, const std::string& what, const std::optional<double>& limit,
               const char* side, const std::optional<double>& found) {
  if (!limit) return;
  const bool below = std::string(side) == "below";
  const bool broken = found && (below ? *found < *limit : *found > *limit);
  rules.push_back({what + " " + side + " " + percent(*limit), broken ? what + " " + percent(*found) : ""});
}

void add_time(std::vector<StudyRule>& rules, const std::optional<double>& limit, const char* side,
              const std::optional<double>& found) {
  if (!limit) return;
  const bool below = std::string(side) == "below";
  const bool broken = found && (below ? *found < *limit : *found > *limit);
  rules.push_back({std::string("median response time ") + side + " " + core::number(*limit, 4) + " s",
                   broken ? "median response time " + core::number(*found, 3) + " s" : ""});
}

std::vector<StudyRule> applied(const protocol::Exclusion& rules, const StudyPerson& person) {
  std::vector<StudyRule> all;
  if (rules.fewer_trials_than)
    all.push_back({"fewer than " + std::to_string(*rules.fewer_trials_than) + " answered trials",
                   person.answered < *rules.fewer_trials_than
                       ? std::to_string(person.answered) + " answered trials"
                       : ""});
  add_share(all, "proportion correct", rules.accuracy_below, "below", person.accuracy);
  add_share(all, "catch trials right", rules.catch_accuracy_below, "below", person.catch_accuracy);
  add_share(all, "timeouts", rules.timeouts_above, "above", person.timeouts);
  add_share(all, "anticipations", rules.anticipations_above, "above", person.anticipations);
  add_time(all, rules.median_time_below_s, "below", person.median_time_s);
  add_time(all, rules.median_time_above_s, "above", person.median_time_s);
  if (rules.incomplete)
    all.push_back(
        {"a session that was not completed", person.incomplete ? "a session was not completed" : ""});
  return all;
}

/// Collects the measures of one participant.
class Measures {
 public:
  explicit Measures(StudyPerson& person) : person_(person) {}
  void add(const std::string& condition, const std::string& measure, const std::string& unit,
           const std::optional<double>& value) {
    if (value && std::isfinite(*value))
      person_.measures.push_back({person_.person, condition, measure, unit, *value});
  }
  void add(const std::string& condition, const std::string& measure, const std::string& unit,
           const std::optional<analysis::Estimate>& estimate) {
    if (estimate) add(condition, measure, unit, std::optional<double>(estimate->value));
  }

 private:
  StudyPerson& person_;
};

void add_measures(const Summary& summary, StudyPerson& person) {
  Measures measures(person);
  const auto& data = summary.data;
  for (const auto& named : summary.fits) {
    if (!named.fit.parameters) continue;
    const auto& part = analysis_of(named, data);
    // only numbers that mean the same are compared: those of one analysis
    const auto of = part.name.empty() ? "" : " of " + part.name;
    const bool normal = named.fit.options.function == core::Function::normal;
    measures.add(named.name, (part.design == Design::two_sided ? "PSE" : "threshold") + of, part.level_unit,
                 std::optional<double>(named.fit.parameters->threshold));
    if (slope_estimated(named))
      measures.add(named.name, (normal ? "spread" : "slope") + of, normal ? part.level_unit : "",
                   std::optional<double>(named.fit.parameters->slope));
  }
  for (const auto& entry : summary.trade.instructions) {
    for (const auto& row : kSpeedAndAccuracy) {
      const bool in_detections = row.value == &Result::d_prime && !summary.detections.empty();
      if (*row.name != '\0' && !in_detections && (data.scored || row.value == &Result::median_s))
        measures.add(entry.instruction, row.name, row.unit, entry.*row.value);
    }
    if (data.scored && entry.correct_times)
      measures.add(entry.instruction, kMeanCorrect, "s", std::optional<double>(entry.correct_times->mean_s));
    for (std::size_t i = 0; i < entry.caf.size(); ++i) {
      const auto& bin = entry.caf[i];
      const auto of = std::to_string(i + 1) + " of " + std::to_string(entry.caf.size());
      measures.add(entry.instruction, analysis::kBinMeasure + of, "",
                   std::optional(static_cast<double>(bin.correct) / bin.trials));
      measures.add(entry.instruction, kBinTime + of, "s", std::optional(bin.mean_time_s));
    }
  }
  for (const auto& detection : summary.detections)
    if (!detection.level) {
      measures.add(detection.condition, analysis::kSensitivity, "", detection.d_prime);
      measures.add(detection.condition, "criterion c", "", detection.criterion);
    }
  for (const auto& entry : summary.rocs) {
    if (entry.level) continue;
    measures.add(entry.condition, analysis::kRocArea, "", std::optional(entry.roc.area.value));
    if (entry.equal)
      measures.add(entry.condition, "d' of ratings", "", std::optional(entry.equal->sensitivity));
    if (!entry.unequal) continue;
    measures.add(entry.condition, "d_a of ratings", "", std::optional(entry.unequal->sensitivity));
    measures.add(entry.condition, "SD with a signal", "SD without", std::optional(entry.unequal->sd));
  }
  for (const auto& entry : summary.discriminations)
    if (!entry.level)
      for (const auto& [model, d_prime] : entry.d_primes)
        measures.add(entry.condition, std::string("d' (") + analysis::name(model) + ")", "",
                     std::optional(d_prime.value));
  for (const auto& curve : summary.curves) {
    measures.add(curve.condition, "asymptote of d'", "", curve.asymptote);
    measures.add(curve.condition, "rate of d'", "1/s", curve.rate_per_s);
    measures.add(curve.condition, "intercept of d'", "s", curve.intercept_s);
    for (const auto& point : curve.points) {
      const auto at = core::number(point.lag_s, 4) + " s";
      measures.add(curve.condition, kLagSensitivity + at, "", point.d_prime);
      measures.add(curve.condition, kLagTime + at, "s", std::optional(point.time_s));
    }
  }
  for (const auto& entry : summary.followed)
    for (const auto& row : kFollowing)
      measures.add(entry.condition, row.name, row.unit, entry.*row.value);
  for (const auto& entry : summary.dependences)
    for (const auto& row : kBefore)
      if (*row.name != '\0')
        measures.add(entry.condition, row.name + (entry.analysis.empty() ? "" : " of " + entry.analysis),
                     row.unit, entry.*row.value);
  // With several procedures, name the procedure too: a measure can have only one value in each condition.
  for (const auto& settings : summary.settings) {
    const auto condition = settings.condition.empty() || summary.settings.size() == 1
                               ? (summary.settings.size() == 1 ? settings.condition : settings.procedure)
                               : settings.procedure + ", " + settings.condition;
    measures.add(condition, "mean setting", data.level_unit, settings.mean);
    measures.add(condition, "scatter of settings", data.level_unit, settings.sd);
    measures.add(condition, "settings from below minus from above", data.level_unit,
                 settings.side_difference);
  }
  for (const auto& scale : summary.scales) {
    for (const auto& remark : scale.statements) person.scale_remarks.emplace_back(scale.condition, remark);
    const auto unit = scale_unit(scale.model);
    for (const auto& [stimulus, place] : places_of(scale))
      measures.add(scale.condition, place_name(stimulus, data.level_unit), unit, std::optional(place));
    if (scale.fit) measures.add(scale.condition, kScaleNoise, "", scale.fit->noise);
    if (scale.fit)
      measures.add(scale.condition, kFavoursSecond, tendency_unit(scale.model), scale.fit->favours_second);
  }
  for (const auto& judged : summary.judgements) {
    measures.add(judged.condition, "exponent of Stevens' law", "", judged.exponent);
    const std::string what = data.design == Design::ratings ? "mean rating" : "geometric mean";
    for (const auto& level : judged.levels)
      measures.add(judged.condition,
                   what + " at " + core::number(level.level, 4) + (data.level_unit.empty() ? "" : " ") +
                       data.level_unit,
                   "", level.mean);
  }
}

/// Returns the lower asymptote of the psychometric function, which the hierarchical fit takes as known.
double known_guess(const NamedFit& named) {
  if (named.fit.options.guess == analysis::Guess::fixed) return named.fit.options.guess_value;
  if (named.fit.options.guess == analysis::Guess::tied_to_lapse) return 0;
  for (const auto& point : named.fit.data)
    if (point.level == analysis::kNoise) return (point.sum() + 0.5) / (point.trials + 1.0);
  return named.fit.parameters ? named.fit.parameters->guess : 0;
}

/// The same answers, counted by the other of two choices. A guess that was not made would have chosen either
/// in half of the cases.
std::vector<analysis::LevelCount> turned(std::vector<analysis::LevelCount> counts) {
  for (auto& point : counts) {
    const int unsure = static_cast<int>(std::lround(2 * point.admitted));
    point.positive = point.trials - unsure - point.positive;
  }
  return counts;
}

GroupFit group_fit(const Study& study, const std::string& condition) {
  GroupFit group{condition, "", 0, {}};
  std::vector<analysis::PersonCounts> people;
  analysis::MixedOptions options;
  for (const auto& person : study.persons)
    for (const auto& named : person.fits) {
      if (!person.excluded.empty() || named.name != condition) continue;
      const auto& fitted = named.fit.options;
      // the protocol decides the options, so they are the same for every participant
      if (people.empty()) {
        options = {fitted.function, fitted.scale, fitted.lapse_low, fitted.lapse_high,
                   fitted.guess == analysis::Guess::tied_to_lapse};
        group.positive = named.positive, group.part = named.part;
      }
      people.push_back({person.person,
                        named.positive == group.positive ? named.fit.data : turned(named.fit.data),
                        known_guess(named), named.fit.weight});
    }
  group.result = analysis::fit_mixed(people, options);
  return group;
}

}  // namespace

std::vector<RowCount> row_counts(const Study& study) {
  if (study.design_rows == 1) return {};
  std::map<int, RowCount> rows;
  if (study.design_rows <= 100)
    for (int row = 0; row < study.design_rows; ++row) rows[row];
  for (const auto& person : study.persons) {
    auto& row = rows[person.row];
    ++row.started;
    row.completed += person.completed;
    row.used += person.completed && person.excluded.empty();
  }
  std::vector<RowCount> list;
  for (auto& [number, row] : rows) row.row = number, list.push_back(row);
  return list;
}

StudyPerson study_person(const SessionData& data, const protocol::Exclusion& rules, bool incomplete) {
  StudyPerson person;
  person.person = data.participant;
  person.incomplete = incomplete;
  count_trials(data, person);
  auto summary = summarise(data, 0);
  add_measures(summary, person);
  for (auto& named : summary.fits) {
    named.intervals.band_level.clear(), named.intervals.band_low.clear(), named.intervals.band_high.clear();
    person.fits.push_back(std::move(named));
  }
  auto judged = person;
  if (!data.other_trials.empty()) {  // rules are about the person, not about one of the tasks
    SessionData all;
    all.trials = data.trials;
    all.trials.insert(all.trials.end(), data.other_trials.begin(), data.other_trials.end());
    judged = {};
    judged.incomplete = incomplete;
    count_trials(all, judged);
  }
  for (const auto& rule : applied(rules, judged))
    if (!rule.broken.empty()) person.excluded.push_back(rule.broken);
  return person;
}

std::vector<std::string> rules_in_words(const protocol::Exclusion& rules) {
  std::vector<std::string> words;
  for (const auto& rule : applied(rules, {})) words.push_back(rule.words);
  return words;
}

protocol::Protocol by_group(protocol::Protocol protocol) {
  auto& by = protocol.analysis.by;
  std::vector<std::string> groups;
  for (const auto& factor : protocol.factors)
    if (factor.draw == protocol::FactorDraw::per_participant &&
        std::find(by.begin(), by.end(), factor.name) == by.end())
      groups.push_back(factor.name);
  if (groups.empty()) return protocol;
  // An empty `by` means that the conditions are the instructions. Keep that when groups are added.
  const auto is_instruction = [](const protocol::Factor& factor) { return factor.name == "instruction"; };
  if (by.empty() && std::any_of(protocol.factors.begin(), protocol.factors.end(), is_instruction) &&
      std::find(groups.begin(), groups.end(), "instruction") == groups.end())
    by.push_back("instruction");
  by.insert(by.begin(), groups.begin(), groups.end());
  for (auto& one : protocol.by_task) one = by_group(std::move(one));
  protocol.meanings =
      protocol.by_task.empty() ? protocol::meanings_of(protocol) : protocol::meanings_of_tasks(protocol);
  return protocol;
}

namespace {

/// The group of participants to which a condition belongs; "" if to all. The name of an analysis or a
/// procedure may come before that of the condition.
std::string group_of(const std::string& condition, const std::map<std::string, std::string>& groups) {
  std::size_t longest = 0;
  std::string found;
  for (const auto& [name, group] : groups)
    if ((condition == name || condition.ends_with(", " + name)) && name.size() > longest)
      longest = name.size(), found = group;
  return found;
}

/// Adds the balanced integration scores to the measures of the participants who are not excluded. They
/// standardise over these participants and their conditions, so no participant has them alone.
void add_balanced(Study& study) {
  if (!study.settings.scored || !shows(study.settings, "bis") || study.settings.conditions.size() < 2) return;
  std::vector<double> proportions, times_s;
  struct Cell {
    StudyPerson* person;
    std::string condition;
  };
  std::vector<Cell> cells;
  for (auto& person : study.persons) {
    if (!person.excluded.empty()) continue;
    for (const auto& proportion : person.measures)
      for (const auto& time : person.measures)
        if (proportion.measure == analysis::kCorrect && time.measure == kMeanCorrect &&
            proportion.condition == time.condition) {
          proportions.push_back(proportion.value), times_s.push_back(time.value);
          cells.push_back({&person, time.condition});
        }
  }
  const auto scores = analysis::balanced_integration(proportions, times_s);
  if (!scores) {
    study.statements.push_back({"no-bis", core::phrase("statement.no_bis")});
    return;
  }
  for (std::size_t i = 0; i < cells.size(); ++i)
    cells[i].person->measures.push_back(
        {cells[i].person->person, cells[i].condition, "BIS", "SD", (*scores)[i]});
}

/// Says of how many participants their scales of a condition have each remark.
void add_scale_remarks(const std::vector<std::string>& conditions, Study& study) {
  const auto counting =
      std::ranges::count_if(study.persons, [](const auto& p) { return p.excluded.empty(); });
  std::vector<std::pair<std::string, analysis::Statement>> remarks;
  std::map<std::pair<std::string, std::string>, int> people;  // by condition and code
  for (const auto& person : study.persons) {
    if (!person.excluded.empty()) continue;
    for (const auto& remark : person.scale_remarks)
      if (people[{remark.first, remark.second.code}]++ == 0) remarks.push_back(remark);
  }
  std::ranges::stable_sort(remarks, {}, [&](const auto& remark) {
    return std::ranges::find(conditions, remark.first) - conditions.begin();
  });
  for (const auto& [condition, remark] : remarks) {
    const auto count = core::plain(people.at({condition, remark.code}));
    study.statements.push_back(
        {remark.code, condition.empty()
                          ? core::phrase("statement.of_people", {count, core::plain(counting), remark.text})
                          : core::phrase("statement.of_people_in", {count, core::plain(counting),
                                                                    core::plain(condition), remark.text})});
  }
}

}  // namespace

void finish_study(Study& study) {
  add_balanced(study);
  std::vector<PersonMeasure> measures;
  std::vector<std::string> conditions;
  for (const auto& name : study.settings.conditions) conditions.push_back(name);
  for (const auto& person : study.persons) {
    if (!person.excluded.empty()) continue;
    measures.insert(measures.end(), person.measures.begin(), person.measures.end());
    for (const auto& named : person.fits)
      if (std::find(conditions.begin(), conditions.end(), named.name) == conditions.end())
        conditions.push_back(named.name);
  }
  // sort by condition in the order of the protocol, because the first participant may have had another order
  const auto place = [&conditions](const PersonMeasure& measure) {
    return std::find(conditions.begin(), conditions.end(), measure.condition) - conditions.begin();
  };
  std::stable_sort(measures.begin(), measures.end(),
                   [&place](const PersonMeasure& a, const PersonMeasure& b) { return place(a) < place(b); });
  add_scale_remarks(conditions, study);
  study.means = analysis::group_means(measures);
  if (study.means.empty()) study.statements.push_back({"no-measures", core::phrase("statement.no_measures")});
  const auto& groups = study.groups_of_conditions;
  std::erase_if(measures,
                [](const PersonMeasure& one) {  // where figures put their points; nothing to compare
                  return one.measure.starts_with(kBinTime) || one.measure.starts_with(kLagTime);
                });
  study.effects = analysis::effects(measures, [&groups](const std::string& first, const std::string& second) {
    return group_of(first, groups) != group_of(second, groups);
  });
  std::vector<analysis::Tested> tests;
  for (const auto& effect : study.effects)
    tests.push_back({effect.measure, effect.difference ? effect.difference->p : std::nullopt});
  const auto p = corrected(study.settings, std::move(tests));
  for (std::size_t i = 0; i < p.size(); ++i) study.effects[i].corrected_p = p[i];
  for (const auto& condition : conditions) {
    const bool fitted = std::any_of(study.persons.begin(), study.persons.end(), [&](const auto& person) {
      return person.excluded.empty() &&
             std::any_of(person.fits.begin(), person.fits.end(),
                         [&](const auto& named) { return named.name == condition; });
    });
    if (fitted) study.groups.push_back(group_fit(study, condition));
  }
}

}  // namespace turnpoint::report
