#include <algorithm>
#include <cmath>

#include "station/core/number.hpp"
#include "station/report/json_parts.hpp"
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

std::string answers_table(const Study& study) {
  std::string csv = "participant,excluded,condition,level,axis,trials,positive,weight\n";
  for (const auto& person : study.persons)
    for (const auto& named : person.fits)
      for (const auto& point : named.fit.data) {
        if (point.level == analysis::kNoise) continue;
        const auto& options = named.fit.options;
        csv += csv_field(person.person) + "," + yes_or_no(!person.excluded.empty()) + "," +
               csv_field(named.name) + "," + csv_number(point.level) + "," +
               csv_number(analysis::axis_position(options.function, options.scale, point.level)) + "," +
               std::to_string(point.trials) + "," + csv_number(point.sum()) + "," +
               csv_number(named.fit.weight) + "\n";
      }
  return csv;
}

std::string csv_value(const Json& value) {
  if (value.is_boolean()) return yes_or_no(value.get<bool>());
  if (value.is_number_float()) return csv_number(value.get<double>());
  if (value.is_string()) return csv_field(value.get<std::string>());
  return value.is_null() ? "" : value.dump();
}

/// A table of records of the JSON report. A column has the name of its value, or name=PLACE where that stands
/// deeper.
std::string csv_of(const Json& records, const std::vector<std::string>& columns) {
  std::string csv;
  std::vector<Json::json_pointer> places;
  for (const auto& column : columns) {
    const auto name = column.substr(0, column.find('='));
    csv += (places.empty() ? "" : ",") + name;
    places.emplace_back("/" + (name == column ? name : column.substr(name.size() + 1)));
  }
  for (const auto& record : records) {
    const char* separator = "\n";
    for (const auto& place : places) {
      csv += separator + csv_value(record.contains(place) ? record.at(place) : Json(nullptr));
      separator = ",";
    }
  }
  return csv + "\n";
}

/// What all participants have in this list, with the participant's name before it.
Json of_all(const Json& persons, const char* list) {
  Json all = Json::array();
  for (const auto& person : persons)
    for (const auto& one : person[list]) {
      Json record{{"participant", person["participant"]}, {"excluded", !person["excluded"].empty()}};
      record.update(one);
      all.push_back(std::move(record));
    }
  return all;
}

/// In the order of the conditions, so that a reader of the table can subtract them in the same direction as
/// the report.
Json in_order(Json measures, const std::vector<std::string>& conditions) {
  const auto place = [&](const Json& row) {
    return std::ranges::find(conditions, row["condition"].get<std::string>());
  };
  std::stable_sort(measures.begin(), measures.end(),
                   [&](const Json& a, const Json& b) { return place(a) < place(b); });
  return measures;
}

/// The participants with one text for each list that they have.
Json in_words(Json persons) {
  for (auto& person : persons) {
    std::string reasons, ends;
    for (const auto& reason : person["excluded"])
      reasons += (reasons.empty() ? "" : "; ") + reason.get<std::string>();
    for (const auto& end : person["early_ends"])
      ends += (ends.empty() ? "" : "; ") + end["session"].get<std::string>() + ", " +
              end["block"].get<std::string>() + ", " + end["reason"].get<std::string>();
    person["sessions"] = person["sessions"].size();
    person["excluded"] = !person["excluded"].empty();
    person["reasons"] = reasons, person["early_ends"] = ends;
  }
  return persons;
}

}  // namespace

std::vector<CsvTable> study_tables(const Study& study) {
  const auto json = json_of(study);
  const auto& persons = json["participants"];
  Json fitted = Json::array();
  for (const auto& group : json["groups"])
    if (!group["fit"].is_null()) fitted.push_back(group);
  return {{"answers.csv", answers_table(study)},
          {"measures.csv", csv_of(in_order(of_all(persons, "measures"), study.settings.conditions),
                                  {"participant", "excluded", "condition", "measure", "unit", "value"})},
          {"effects.csv",
           csv_of(json["effects"],
                  {"measure", "unit", "first", "second", "participants", "difference=difference/value",
                   "low_95=difference/interval/low", "high_95=difference/interval/high", "standardised",
                   "between_groups", "p", "corrected_p"})},
          {"estimates.csv",
           csv_of(of_all(persons, "estimates"),
                  {"participant", "excluded", "session", "procedure", "block", "parameter", "mean", "sd",
                   "low_95=interval/low", "high_95=interval/high", "unit", "basis"})},
          {"participants.csv",
           csv_of(in_words(persons), {"participant", "group", "sessions", "presented", "answered", "accuracy",
                                      "catch_accuracy", "timeouts", "anticipations", "median_time_s",
                                      "incomplete", "excluded", "reasons", "early_ends"})},
          {"groups.csv",
           csv_of(fitted, {"condition", "function=fit/function", "guess=fit/guess", "lapse=fit/lapse",
                           "intercept=fit/intercept", "rate=fit/rate", "intercept_se=fit/intercept_se",
                           "rate_se=fit/rate_se", "intercept_sd=fit/intercept_sd", "rate_sd=fit/rate_sd",
                           "correlation=fit/correlation", "log_likelihood=fit/log_likelihood",
                           "threshold=fit/threshold/value"})}};
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
