#include <algorithm>
#include <cmath>

#include "station/core/number.hpp"
#include "station/report/study.hpp"

namespace turnpoint::report {

/// RFC 4180.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csv_number(double value) { return std::isfinite(value) ? core::number(value, 12) : ""; }

std::string csv_number(const std::optional<double>& value) { return value ? csv_number(*value) : ""; }

namespace {

const char* yes_or_no(bool value) { return value ? "yes" : "no"; }

const char* function_name(core::Function function) {
  switch (function) {
    case core::Function::weibull:
      return "weibull";
    case core::Function::normal:
      return "normal";
    case core::Function::logistic:
      break;
  }
  return "logistic";
}

std::string answers_table(const Study& study) {
  std::string csv = "participant,excluded,condition,level,axis,trials,positive\n";
  for (const auto& person : study.persons)
    for (const auto& named : person.fits)
      for (const auto& point : named.fit.data) {
        if (point.level == analysis::kNoise) continue;
        const auto& options = named.fit.options;
        csv += csv_field(person.person) + "," + yes_or_no(!person.excluded.empty()) + "," +
               csv_field(named.name) + "," + csv_number(point.level) + "," +
               csv_number(analysis::axis_position(options.function, options.scale, point.level)) + "," +
               std::to_string(point.trials) + "," + core::number(point.sum()) + "\n";
      }
  return csv;
}

/// The rows are in the order of the conditions, so that a reader of the table can subtract them in the same
/// direction as the report.
std::string measures_table(const Study& study) {
  struct Row {
    const StudyPerson* person;
    const analysis::PersonMeasure* measure;
  };
  std::vector<Row> rows;
  for (const auto& person : study.persons)
    for (const auto& measure : person.measures) rows.push_back({&person, &measure});
  const auto place = [&order = study.settings.conditions](const Row& row) {
    return std::find(order.begin(), order.end(), row.measure->condition) - order.begin();
  };
  std::stable_sort(rows.begin(), rows.end(), [&](const Row& a, const Row& b) { return place(a) < place(b); });
  std::string csv = "participant,excluded,condition,measure,unit,value\n";
  for (const auto& [person, measure] : rows)
    csv += csv_field(person->person) + "," + yes_or_no(!person->excluded.empty()) + "," +
           csv_field(measure->condition) + "," + csv_field(measure->measure) + "," +
           csv_field(measure->unit) + "," + csv_number(measure->value) + "\n";
  return csv;
}

std::string effects_table(const Study& study) {
  std::string csv =
      "measure,unit,first,second,participants,difference,low_95,high_95,standardised,between_groups,p,"
      "corrected_p\n";
  for (const auto& effect : study.effects) {
    const auto& gap = effect.difference;
    csv += csv_field(effect.measure) + "," + csv_field(effect.unit) + "," + csv_field(effect.first) + "," +
           csv_field(effect.second) + "," + std::to_string(effect.persons) + "," +
           (gap ? csv_number(gap->value) + "," + csv_number(gap->interval.low) + "," +
                      csv_number(gap->interval.high)
                : ",,") +
           "," + csv_number(effect.standardised) + "," + yes_or_no(effect.between_groups) + "," +
           (gap ? csv_number(gap->p) : "") + "," + csv_number(effect.corrected_p) + "\n";
  }
  return csv;
}

std::string estimates_table(const Study& study) {
  std::string csv =
      "participant,excluded,session,procedure,block,parameter,mean,sd,low_95,high_95,unit,basis\n";
  for (const auto& person : study.persons)
    for (const auto& [session, own] : person.estimates) {
      const auto ends =
          own.interval ? csv_number(own.interval->low) + "," + csv_number(own.interval->high) : ",";
      csv += csv_field(person.person) + "," + yes_or_no(!person.excluded.empty()) + "," + csv_field(session) +
             "," + csv_field(own.procedure) + "," + csv_field(own.block) + "," + csv_field(own.parameter) +
             "," + csv_number(own.mean) + "," + csv_number(own.sd) + "," + ends + "," + csv_field(own.unit) +
             "," + csv_field(own.basis) + "\n";
    }
  return csv;
}

std::string participants_table(const Study& study) {
  std::string csv =
      "participant,group,sessions,presented,answered,accuracy,catch_accuracy,timeouts,anticipations,median_"
      "time_s,"
      "incomplete,excluded,reasons,early_ends\n";
  for (const auto& person : study.persons) {
    std::string reasons;
    for (const auto& reason : person.excluded) reasons += (reasons.empty() ? "" : "; ") + reason;
    std::string ends;
    for (const auto& [session, end] : person.early_ends)
      ends += (ends.empty() ? "" : "; ") + session + ", " + end.block + ", " + core::say(end.why, "en");
    csv += csv_field(person.person) + "," + csv_field(person.group) + "," +
           std::to_string(person.sessions.size()) + "," + std::to_string(person.presented) + "," +
           std::to_string(person.answered) + "," + csv_number(person.accuracy) + "," +
           csv_number(person.catch_accuracy) + "," + csv_number(person.timeouts) + "," +
           csv_number(person.anticipations) + "," + csv_number(person.median_time_s) + "," +
           yes_or_no(person.incomplete) + "," + yes_or_no(!person.excluded.empty()) + "," +
           csv_field(reasons) + "," + csv_field(ends) + "\n";
  }
  return csv;
}

std::string groups_table(const Study& study) {
  std::string csv =
      "condition,function,guess,lapse,intercept,rate,intercept_se,rate_se,intercept_sd,rate_sd,correlation,"
      "log_likelihood,threshold\n";
  for (const auto& group : study.groups) {
    const auto& fit = group.result.fit;
    if (!fit) continue;
    double guess = 0;
    for (const auto& person : fit->persons)
      guess += person.parameters.guess / static_cast<double>(fit->persons.size());
    csv += csv_field(group.condition) + "," + function_name(fit->options.function) + "," + csv_number(guess) +
           "," + csv_number(fit->lapse) + "," + csv_number(fit->intercept) + "," + csv_number(fit->rate) +
           "," + csv_number(fit->intercept_se) + "," + csv_number(fit->rate_se) + "," +
           csv_number(fit->intercept_sd) + "," + csv_number(fit->rate_sd) + "," +
           csv_number(fit->correlation) + "," + csv_number(fit->log_likelihood) + "," +
           (fit->threshold ? csv_number(fit->threshold->value) : "") + "\n";
  }
  return csv;
}

}  // namespace

std::vector<CsvTable> study_tables(const Study& study) {
  return {{"answers.csv", answers_table(study)},
          {"measures.csv", measures_table(study)},
          {"effects.csv", effects_table(study)},
          {"estimates.csv", estimates_table(study)},
          {"participants.csv", participants_table(study)},
          {"groups.csv", groups_table(study)}};
}

std::string trial_table_header() {
  return "participant,excluded,condition,block,procedure,level,response,correct,outcome,response_time_s\n";
}

std::string trial_table_rows(const StudyPerson& person, const SessionData& data) {
  std::string csv;
  for (const auto& trial : data.trials) {
    if (trial.type != analysis::TrialType::experimental) continue;
    const auto choice = trial.response ? static_cast<std::size_t>(*trial.response) : data.choices.size();
    csv += csv_field(person.person) + "," + yes_or_no(!person.excluded.empty()) + "," +
           csv_field(trial.instruction) + "," + csv_field(trial.block) + "," + csv_field(trial.procedure) +
           "," + csv_number(trial.level) + "," +
           (choice < data.choices.size() ? csv_field(data.choices[choice]) : "") + "," +
           (trial.correct ? (*trial.correct ? "1" : "0") : "") + "," + core::name(trial.outcome) + "," +
           csv_number(trial.response_time_s) + "\n";
  }
  return csv;
}

}  // namespace turnpoint::report
