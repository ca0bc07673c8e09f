#include <cmath>
#include <nlohmann/json.hpp>

#include "station/report/json_parts.hpp"
#include "station/report/study.hpp"

namespace turnpoint::report {

namespace {

Json person_json(const StudyPerson& person) {
  Json json{{"participant", person.person},
            {"sessions", person.sessions},
            {"group", person.group.empty() ? Json(nullptr) : Json(person.group)},
            {"presented", person.presented},
            {"answered", person.answered},
            {"timeouts", value(person.timeouts)},
            {"anticipations", value(person.anticipations)},
            {"accuracy", value(person.accuracy)},
            {"catch_accuracy", value(person.catch_accuracy)},
            {"median_time_s", value(person.median_time_s)},
            {"incomplete", person.incomplete},
            {"excluded", person.excluded}};
  json["fits"] = list_of(person.fits, [](const auto& named) -> Json {
    const auto& p = named.fit.parameters;
    return {{"condition", named.name},
            {"threshold", p ? value(p->threshold) : Json(nullptr)},
            {"threshold_interval", value(named.intervals.threshold)},
            {"slope", p && slope_estimated(named) ? value(p->slope) : Json(nullptr)},
            {"slope_interval", value(named.intervals.slope)},
            {"lapse", p ? value(p->lapse) : Json(nullptr)},
            {"statements", value(named.fit.statements)}};
  });
  const auto of_session = [](const auto& one) {
    const auto& [session, said] = one;
    Json own{{"session", session}};
    own.update(value(said));
    return own;
  };
  json["scale_remarks"] = list_of(person.scale_remarks, [](const auto& remark) {
    Json of_scale{{"condition", remark.first}};
    of_scale.update(value(remark.second));
    return of_scale;
  });
  json["estimates"] = list_of(person.estimates, of_session);
  json["early_ends"] = list_of(person.early_ends, of_session);
  json["measures"] = list_of(person.measures, [](const auto& measure) -> Json {
    return {{"condition", measure.condition},
            {"measure", measure.measure},
            {"unit", measure.unit},
            {"value", value(measure.value)}};
  });
  return json;
}

Json group_json(const GroupFit& group) {
  Json json{{"condition", group.condition}, {"positive", group.positive}, {"fit", nullptr}};
  auto statements = group.result.statements;
  if (const auto& fit = group.result.fit) {
    statements.insert(statements.end(), fit->statements.begin(), fit->statements.end());
    const auto persons = list_of(fit->persons, [](const auto& person) -> Json {
      return {{"participant", person.person},
              {"trials", person.trials},
              {"threshold", value(person.threshold)},
              {"slope", person.threshold ? value(person.parameters.slope) : Json(nullptr)},
              {"shrinkage", value(person.shrinkage)}};
    });
    double guess = 0;
    for (const auto& person : fit->persons)
      guess += person.parameters.guess / static_cast<double>(fit->persons.size());
    json["fit"] = {{"function", core::name(fit->options.function)},
                   {"guess", value(guess)},
                   {"threshold", value(fit->threshold)},
                   {"slope", value(fit->slope)},
                   {"threshold_sd", value(fit->threshold_sd)},
                   {"lapse", value(fit->lapse)},
                   {"intercept", value(fit->intercept)},
                   {"intercept_se", value(fit->intercept_se)},
                   {"intercept_sd", value(fit->intercept_sd)},
                   {"rate", value(fit->rate)},
                   {"rate_se", value(fit->rate_se)},
                   {"rate_sd", value(fit->rate_sd)},
                   {"correlation", value(fit->correlation)},
                   {"log_likelihood", value(fit->log_likelihood)},
                   {"participants", persons}};
  }
  json["statements"] = value(statements);
  return json;
}

}  // namespace

Json json_of(const Study& study) {
  Json json{{"title", study.settings.title}, {"run_mode", study.settings.run_mode}};
  for (const auto& [name, text] : study.facts) json["facts"][name] = text;
  json["measures"] = meanings_json(study.settings);
  const auto& sessions = study.sessions;
  json["sessions"] = {{"found", sessions.found},
                      {"counted", sessions.counted()},
                      {"superseded", sessions.superseded},
                      {"incomplete", sessions.incomplete},
                      {"incomplete_count", sessions.incomplete_count}};
  json["rules"] = study.rules;
  json["participants"] = list_of(study.persons, person_json);
  json["places"] = list_of(row_counts(study), [](const auto& row) -> Json {
    return {{"place", row.row}, {"started", row.started}, {"completed", row.completed}, {"used", row.used}};
  });
  json["groups"] = list_of(study.groups, group_json);
  json["means"] = list_of(study.means, [](const auto& mean) -> Json {
    return {{"measure", mean.measure},      {"unit", mean.unit},        {"condition", mean.condition},
            {"participants", mean.persons}, {"mean", value(mean.mean)}, {"sd", value(mean.sd)}};
  });
  json["effects"] = list_of(study.effects, [](const auto& effect) -> Json {
    return {{"measure", effect.measure},
            {"unit", effect.unit},
            {"first", effect.first},
            {"second", effect.second},
            {"participants", effect.persons},
            {"difference", value(effect.difference)},
            {"standardised", value(effect.standardised)},
            {"p", effect.difference ? value(effect.difference->p) : Json(nullptr)},
            {"corrected_p", value(effect.corrected_p)},
            {"between_groups", effect.between_groups}};
  });
  json["statements"] = value(study.statements);
  return json;
}

std::string to_json(const Study& study) {
  return json_of(study).dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace turnpoint::report
