#include "station/core/number.hpp"
#include "station/report/document.hpp"

namespace turnpoint::report {

namespace {

using Look = Text::Look;

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " (" + unit + ")";
}

/// Which participants and sessions count, and by which rules.
void add_people(const Study& study, Document& document) {
  const auto& n = study.sessions;
  document.heading("Participants");
  document.say(std::string("Completed sessions count. A session that was not completed and was begun again "
                           "later does not count. A session that was not completed and not begun again ") +
               (n.incomplete_count ? "counts" : "does not count") +
               ", as the protocol decides (incomplete_sessions). Counted: " + std::to_string(n.counted()) +
               " of " + std::to_string(n.found) + " sessions; begun again later: " +
               std::to_string(n.superseded) + "; not completed: " + std::to_string(n.incomplete) + ".");
  if (study.rules.empty()) {
    document.remark(core::phrase("statement.no_rules"));
  } else {
    document.say("The protocol excludes participants with:");
    document.parts.push_back(List{{study.rules.begin(), study.rules.end()}});
  }
  Table table{
      {"Participant", "Group", "Sessions", "Trials answered", "Correct",
       Text(core::phrase("report.catch_right"), Look::label), "Timeouts", "Median time (s)", "Excluded"},
      {}};
  for (const auto& person : study.persons) {
    std::string why;
    for (const auto& reason : person.excluded) why += (why.empty() ? "" : "; ") + reason;
    table.rows.push_back({person.person, person.group.empty() ? "\u2013" : person.group,
                          count(static_cast<int>(person.sessions.size())),
                          count(std::to_string(person.answered) + " of " + std::to_string(person.presented)),
                          share(person.accuracy), share(person.catch_accuracy), share(person.timeouts),
                          amount(person.median_time_s), why});
  }
  document.table(std::move(table));
}

/// How many participants have each group and order.
void add_rows(const Study& study, Document& document) {
  const auto rows = row_counts(study);
  if (rows.empty()) return;
  document.heading("Places in the counterbalancing");
  Table table{{"Place", "Participants with trials", "Completed", "Completed and not excluded"}, {}};
  for (const auto& row : rows)
    table.rows.push_back({count(row.row), count(row.started), count(row.completed), count(row.used)});
  document.table(std::move(table));
  document.explain("Participants whose places differ by a multiple of " + std::to_string(study.design_rows) +
                   " have the same group and the same orders; they are counted together.");
}

void add_group(const GroupFit& group, const Study& study, Document& document) {
  document.heading(name_of(group.condition), 3);
  if (group.result.fit) {
    const auto& fit = *group.result.fit;
    const auto& part = analysis_of(group, study.settings);
    Table table{{},
                {{threshold_label(part), estimated(fit.threshold)},
                 {slope_label(fit.options.function, part), estimated(fit.slope)}}};
    if (fit.threshold_sd)
      table.rows.push_back(
          {with_unit("Standard deviation between participants", part.level_unit), amount(fit.threshold_sd)});
    table.rows.push_back(
        {Text(in_unit(core::phrase("report.lapse"), core::phrase("report.share")), Look::label) +
             ", the same for all",
         amount(fit.lapse, 2)});
    document.table(std::move(table));
    document.remark(fit.statements);
    Table pooled{{"Number", "Participant", "Trials", threshold_label(part), "Drawn to the group"}, {}};
    for (const auto& person : fit.persons)
      pooled.rows.push_back({count(pooled.rows.size() + 1), person.person, count(person.trials),
                             estimated(person.threshold), share(person.shrinkage, 2)});
    document.table(std::move(pooled));
  }
  document.remark(group.result.statements);
}

void add_groups(const Study& study, Document& document) {
  if (study.groups.empty()) return;
  document.heading("Psychometric function of the group");
  document.figure("group", group_curve_figure(study));
  document.figure("participants", shrinkage_figure(study));
  for (const auto& group : study.groups) add_group(group, study, document);
  document.explain(
      "Partial pooling: across participants, intercept and slope on the function\u2019s axis follow a "
      "bivariate normal distribution. The fit is maximum likelihood with Laplace\u2019s approximation. 95 % "
      "intervals of the group: delta method and Student\u2019s t. The intervals of participants include the "
      "uncertainty of the distribution.");
}

void add_effects(const Study& study, Document& document) {
  if (study.effects.empty()) return;
  const auto holm = study.settings.holm;
  const bool p_values = holm != protocol::Holm::none;
  document.heading("Effects");
  Table table{{"Measure", "Difference", "Participants", "Mean difference", "In standard deviations"}, {}};
  if (p_values) table.columns.insert(table.columns.end(), {"p", "p, corrected"});
  for (const auto& effect : study.effects) {
    auto& cells = table.rows.emplace_back();
    cells = {
        with_unit(effect.measure, effect.unit),
        Text(second_minus_first(effect.first, effect.second)) + (effect.between_groups ? ", groups" : ""),
        count(effect.persons), estimated(effect.difference), amount(effect.standardised, 2)};
    if (!p_values) continue;
    cells.push_back(amount(effect.difference ? effect.difference->p : std::nullopt, 2));
    cells.push_back(amount(effect.corrected_p, 2));
  }
  document.table(std::move(table));
  document.explain(
      "Each participant counts once, with estimates from the participant\u2019s own trials. 95 % intervals "
      "of means: Student\u2019s t, of proportions on the logit scale. Effects within participants: "
      "Student\u2019s t of the participants\u2019 "
      "differences, in standard deviations of these differences (d" +
      Text("z", Look::below) +
      "). Effects between groups: Welch\u2019s t of the difference of the means, in pooled standard "
      "deviations (d" +
      Text("s", Look::below) +
      "). The balanced integration score (BIS) is the z score of accuracy minus that of the mean time of "
      "right answers; both standardise over all participants who count and all their conditions. " +
      (!p_values ? "The intervals are not corrected for the number of comparisons."
                 : std::string("p values are two-sided, of Student\u2019s or Welch\u2019s t; the last column "
                               "corrects them by Holm\u2019s method for the number of ") +
                       (holm == protocol::Holm::all ? "all effects in this table"
                                                    : "pairs of conditions that a measure compares") +
                       ". The intervals are not corrected."));
}

void add_means(const Study& study, Document& document) {
  if (study.means.empty()) return;
  document.heading("Speed, accuracy and other measures by condition");
  document.figure("speed-accuracy", group_trade_figure(study));
  document.figure("accuracy-over-time", group_course_figure(study));
  Table table{{"Measure", "Condition", "Participants", "Mean", "Standard deviation"}, {}};
  for (const auto& mean : study.means)
    table.rows.push_back({with_unit(mean.measure, mean.unit), name_of(mean.condition), count(mean.persons),
                          estimated(mean.mean), amount(mean.sd, 2)});
  document.table(std::move(table));
  add_effects(study, document);
}

/// The procedures' own estimates, session by session.
void add_own(const Study& study, Document& document) {
  std::vector<OwnEstimate> estimates;
  std::vector<Text> ends;
  for (const auto& person : study.persons) {
    for (const auto& [session, estimate] : person.estimates)
      estimates.push_back({{person.person, session}, estimate});
    for (const auto& [session, end] : person.early_ends)
      ends.push_back(person.person + ", " + session + ": " + early_end(end));
  }
  if (estimates.empty() && ends.empty()) return;
  document.heading("The procedures\u2019 own estimates");
  for (auto& end : ends) document.say(std::move(end));
  add_own_estimates({"Participant", "Session"}, estimates, study.settings.thresholds_differ, document);
}

}  // namespace

Document document(const Study& study) {
  Document document;
  document.title = study.settings.title;
  document.name = document.title + ", study";
  document.run_mode = study.settings.run_mode;
  document.about = "Study of " + Text(study.persons.size()) + " participants";
  document.facts(study.facts);
  add_meanings(study.settings, document);
  document.remark(study.statements);
  add_people(study, document);
  add_rows(study, document);
  add_groups(study, document);
  add_means(study, document);
  add_own(study, document);
  return document;
}

}  // namespace turnpoint::report
