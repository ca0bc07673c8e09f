#include "station/core/number.hpp"
#include "station/report/html_parts.hpp"
#include "station/report/study.hpp"
#include "station/report/svg.hpp"

namespace turnpoint::report {

namespace {


std::string with_unit(const std::string& name, const std::string& unit) {
  return escaped(unit.empty() ? name : name + " (" + unit + ")");
}

std::string count_cell(int count) { return "<td class=\"n\">" + std::to_string(count) + "</td>"; }

std::string share_cell(const std::optional<double>& share) {
  return "<td class=\"n\">" + (share ? number(100 * *share, 3) + " %" : std::string("\u2013")) + "</td>";
}

std::string rules_section(const Study& study) {
  if (study.rules.empty())
    return "<p class=\"note\">The protocol states no rules of exclusion, so every participant counts.</p>\n";
  std::string html = "<p>The protocol excludes participants with:</p>\n<ul>";
  for (const auto& rule : study.rules) html += "<li>" + escaped(rule) + "</li>";
  return html + "</ul>\n";
}

/// Says which sessions count, by which rule, and how many there are of each.
std::string sessions_note(const Study& study) {
  const auto& n = study.sessions;
  std::string html =
      "<p>Completed sessions count. A session that was not completed and was begun again later "
      "does not count. A session that was not completed and not begun again ";
  html += n.incomplete_count ? "counts" : "does not count";
  html += ", as the protocol decides (incomplete_sessions). Counted: " + std::to_string(n.counted()) +
          " of " + std::to_string(n.found) + " sessions; begun again later: " + std::to_string(n.superseded) +
          "; not completed: " + std::to_string(n.incomplete) + ".</p>\n";
  return html;
}

std::string people_section(const Study& study) {
  std::string html = "<h2>Participants</h2>\n" + sessions_note(study) + rules_section(study) +
                     "<table><tr><th>Participant</th><th>Group</th><th>Sessions</th><th>Trials answered</th>"
                     "<th>Correct</th><th>Catch trials right</th><th>Timeouts</th><th>Median time (s)</th>"
                     "<th>Excluded</th></tr>";
  for (const auto& person : study.persons) {
    std::string why;
    for (const auto& reason : person.excluded) why += (why.empty() ? "" : "; ") + reason;
    html += "<tr><td>" + escaped(person.person) + "</td><td>" +
            (person.group.empty() ? "\u2013" : escaped(person.group)) + "</td>" +
            count_cell(static_cast<int>(person.sessions.size())) + "<td class=\"n\">" +
            std::to_string(person.answered) + " of " + std::to_string(person.presented) + "</td>" +
            share_cell(person.accuracy) + share_cell(person.catch_accuracy) + share_cell(person.timeouts) +
            "<td class=\"n\">" + (person.median_time_s ? number(*person.median_time_s) : "\u2013") +
            "</td><td>" + escaped(why) + "</td></tr>";
  }
  return html + "</table>\n";
}

std::string group_row(const std::string& name, const std::optional<analysis::Estimate>& estimate) {
  return "<tr><td>" + name + "</td>" + cell(estimate) + "</tr>";
}

std::string pooled_table(const analysis::MixedFit& fit, const LevelAnalysis& part) {
  std::string html = "<table><tr><th>Number</th><th>Participant</th><th>Trials</th><th>" +
                     with_unit(part.design == Design::two_sided ? "PSE" : "Threshold", part.level_unit) +
                     "</th><th>Drawn to the group</th></tr>";
  int place = 0;
  for (const auto& person : fit.persons)
    html += "<tr>" + count_cell(++place) + "<td>" + escaped(person.person) + "</td>" +
            count_cell(person.trials) + cell(person.threshold) + "<td class=\"n\">" +
            number(100 * person.shrinkage, 2) + " %</td></tr>";
  return html + "</table>\n";
}

std::string group_section(const Study& study) {
  if (study.groups.empty()) return "";
  std::string html = "<h2>Psychometric function of the group</h2>\n" + picture(group_curve_figure(study)) +
                     picture(shrinkage_figure(study));
  for (const auto& group : study.groups) {
    html += "<h3>" + escaped(name_of(group.condition)) + "</h3>\n";
    if (group.result.fit) {
      const auto& fit = *group.result.fit;
      const auto& part = analysis_of(group, study.settings);
      const auto& unit = part.level_unit;
      const bool two_sided = part.design == Design::two_sided;
      html += "<table>" + group_row(with_unit(two_sided ? "PSE" : "Threshold", unit), fit.threshold);
      html += group_row(fit.options.function == core::Function::normal
                            ? with_unit("Spread, standard deviation", unit)
                            : "Slope",
                        fit.slope);
      if (fit.threshold_sd)
        html += "<tr><td>" + with_unit("Standard deviation between participants", unit) +
                "</td><td class=\"n\">" + number(*fit.threshold_sd) + "</td></tr>";
      html += "<tr><td>Lapse rate (proportion), the same for all</td><td class=\"n\">" +
              number(fit.lapse, 2) + "</td></tr></table>\n" + notes(fit.statements) + pooled_table(fit, part);
    }
    html += notes(group.result.statements);
  }
  return html +
         "<p class=\"soft\">Partial pooling: across participants, intercept and slope on the function\u2019s "
         "axis follow a bivariate normal distribution. The fit is maximum likelihood with Laplace\u2019s "
         "approximation. 95 % intervals of the group: delta method and Student\u2019s t. The intervals of "
         "participants include the uncertainty of the distribution.</p>\n";
}

std::string means_section(const Study& study) {
  if (study.means.empty()) return "";
  std::string html = "<h2>Speed, accuracy and other measures by condition</h2>\n" +
                     picture(group_trade_figure(study)) + picture(group_course_figure(study)) +
                     "<table><tr><th>Measure</th><th>Condition</th><th>Participants</th><th>Mean</th>"
                     "<th>Standard deviation</th></tr>";
  for (const auto& mean : study.means)
    html += "<tr><td>" + with_unit(mean.measure, mean.unit) + "</td><td>" + escaped(name_of(mean.condition)) +
            "</td>" + count_cell(mean.persons) + cell(mean.mean) + "<td class=\"n\">" +
            (mean.sd ? number(*mean.sd, 2) : "\u2013") + "</td></tr>";
  html += "</table>\n";
  if (study.effects.empty()) return html;
  const auto holm = study.settings.holm;
  const bool p_values = holm != protocol::Holm::none;
  const auto p_cell = [](const std::optional<double>& p) {
    return "<td class=\"n\">" + (p ? number(*p, 2) : "\u2013") + "</td>";
  };
  html += std::string("<h2>Effects</h2>\n<table><tr><th>Measure</th><th>Difference</th><th>Participants</th>"
                      "<th>Mean difference</th><th>In standard deviations</th>") +
          (p_values ? "<th>p</th><th>p, corrected</th>" : "") + "</tr>";
  for (const auto& effect : study.effects)
    html += "<tr><td>" + with_unit(effect.measure, effect.unit) + "</td><td>" +
            escaped(name_of(effect.second)) + " \u2212 " + escaped(name_of(effect.first)) +
            (effect.between_groups ? ", groups" : "") + "</td>" + count_cell(effect.persons) +
            cell(effect.difference) + "<td class=\"n\">" +
            (effect.standardised ? number(*effect.standardised, 2) : "\u2013") + "</td>" +
            (p_values ? p_cell(effect.difference ? effect.difference->p : std::nullopt) +
                            p_cell(effect.corrected_p)
                      : "") +
            "</tr>";
  const std::string correction =
      holm == protocol::Holm::none
          ? "The intervals are not corrected for the number of comparisons."
          : std::string("p values are two-sided, of Student\u2019s or Welch\u2019s t; the last column corrects "
                        "them by Holm\u2019s method for the number of ") +
                (holm == protocol::Holm::all ? "all effects in this table"
                                             : "pairs of conditions that a measure compares") +
                ". The intervals are not corrected.";
  return html +
         "</table>\n<p class=\"soft\">Each participant counts once, with estimates from the "
         "participant\u2019s own trials. 95 % intervals of means: Student\u2019s t. Effects within "
         "participants: Student\u2019s t of the participants\u2019 differences, in standard deviations of "
         "these differences (d<sub>z</sub>). Effects between groups: Welch\u2019s t of the difference of "
         "the means, in pooled standard deviations (d<sub>s</sub>). The balanced integration score (BIS) is "
         "the z "
         "score of accuracy minus that of the mean time of right answers; both standardise over all "
         "participants who count and all their conditions. " +
         correction + "</p>\n";
}

/// The procedures' own estimates, session by session.
std::string own_section(const Study& study) {
  std::vector<ProcedureEstimate> all;
  std::string rows;
  for (const auto& person : study.persons)
    for (const auto& [session, estimate] : person.estimates) {
      rows += "<tr><td>" + escaped(person.person) + "</td><td>" + escaped(session) + "</td>" +
              estimate_cells(estimate) + "</tr>";
      all.push_back(estimate);
    }
  std::string ends;
  for (const auto& person : study.persons)
    for (const auto& [session, end] : person.early_ends)
      ends += "<p>" + escaped(person.person) + ", " + escaped(session) + ": " + early_end(end).substr(3);
  if (all.empty() && ends.empty()) return "";
  const std::string title = "<h2>The procedures\u2019 own estimates</h2>\n" + ends;
  if (all.empty()) return title;
  return title + "<table><tr><th>Participant</th><th>Session</th>" +
         kEstimateTitles + "</tr>" + rows + "</table>\n<p class=\"soft\">" +
         why_estimates_differ(all, study.settings.thresholds_differ) + "</p>\n";
}

}  // namespace

std::string to_html(const Study& study) {
  std::string html = html_head(study.settings.title + ", study") + "<h1>" + escaped(study.settings.title) +
                     "</h1>\n<p>Study of " + std::to_string(study.persons.size()) + " participants";
  if (study.settings.run_mode != "live")
    html += " <span class=\"mode\">" + escaped(study.settings.run_mode) + "</span>";
  html += "</p>\n" + facts_table(study.facts) + meanings_list(study.settings) + notes(study.statements) +
          people_section(study) + group_section(study) + means_section(study) + own_section(study);
  return html + "</body></html>\n";
}

}  // namespace turnpoint::report
