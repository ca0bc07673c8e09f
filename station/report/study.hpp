#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/analysis/group.hpp"
#include "station/analysis/mixed_fit.hpp"
#include "station/protocol/protocol.hpp"
#include "station/report/chart.hpp"
#include "station/report/summary.hpp"

namespace turnpoint::report {

/// What a procedure estimated itself in one session.
struct SessionEstimate {
  std::string session_id;
  ProcedureEstimate estimate;
};

/// A procedure that ended early in one session.
struct SessionEarlyEnd {
  std::string session_id;
  EarlyEnd end;
};

/// What a study needs to know about one participant. It contains no trials, so that memory does not grow with
/// their number.
struct StudyPerson {
  std::string person;
  std::vector<std::string> sessions;  ///< ids of the participant's sessions
  std::string group;                  ///< the participant's group; "" if the protocol has no groups
  int row = 0;              ///< of the design: the place in the counterbalancing modulo Study::design_rows
  bool completed = false;   ///< true if all planned sessions count
  bool incomplete = false;  ///< true if a session was not completed
  int presented = 0, answered = 0;         ///< numbers of presented and of answered experimental trials
  double timeouts = 0, anticipations = 0;  ///< proportions of the presented trials
  std::optional<double> accuracy, catch_accuracy, median_time_s;
  /// rules that exclude the participant; empty if the participant is included
  std::vector<std::string> excluded;
  std::vector<NamedFit> fits;  ///< one fit for each condition, without confidence bands
  std::vector<analysis::PersonMeasure> measures;
  /// for comparisons: the condition of a scale, and a remark about it, such as why there is none
  std::vector<std::pair<std::string, analysis::Statement>> scale_remarks;
  std::vector<SessionEstimate> estimates;  ///< the procedures' own estimates, in the order of the sessions
  std::vector<SessionEarlyEnd> early_ends;
};

/// The hierarchical fit of one condition.
struct GroupFit {
  std::string condition;  ///< name of the condition; "" if there is only one
  std::string positive;   ///< the answer whose probability the curve shows
  std::size_t part = 0;   ///< number of its analysis in SessionData::parts
  analysis::MixedResult result;
};

/// Which sessions of a study count. The protocol decides it ([analysis] incomplete_sessions).
struct SessionCounts {
  int found = 0;                  ///< all sessions with trials
  int superseded = 0;             ///< not completed, and begun again later by the same participant: left out
  int incomplete = 0;             ///< not completed and not begun again
  bool incomplete_count = false;  ///< whether the latter count
  int counted() const { return found - superseded - (incomplete_count ? 0 : incomplete); }
};

struct Study {
  SessionData settings;     ///< how the trials are analysed; its list of trials is empty
  std::vector<Fact> facts;  ///< rows for the head of the report
  SessionCounts sessions;
  std::map<std::string, std::string> groups_of_conditions;  ///< as of protocol::groups_of_conditions()
  std::vector<std::string> rules;  ///< the rules of exclusion, as the protocol states them
  std::vector<StudyPerson> persons;
  int design_rows = 1;  ///< number of different places in the counterbalancing
  std::vector<GroupFit> groups;
  std::vector<analysis::GroupMean> means;
  std::vector<analysis::Effect> effects;
  std::vector<analysis::Statement> statements;
};

/// Names of measures that figures of a study look for beside those of analysis/trade.hpp. They are followed
/// by the bin ("1 of 5") or the lag ("0.35 s").
inline constexpr const char *kBinTime = "mean time in time bin ",
                            *kLagSensitivity = "d' at the signal after ",
                            *kLagTime = "response time at the signal after ";

/// Number of bootstrap replicates for the intervals of single participants.
constexpr int kStudyReplicates = 400;

/// The analysis to which a group's fit belongs.
inline const LevelAnalysis& analysis_of(const GroupFit& group, const SessionData& data) {
  return data.parts.empty() ? data : data.parts.at(group.part);
}

/// Returns the protocol, changed so that each group of participants is analysed separately.
protocol::Protocol by_group(protocol::Protocol protocol);

/// Analyses the trials of one participant, from all sessions together, with data.replicates bootstrap
/// replicates (kStudyReplicates in the report of a study), and applies the rules, to all tasks together.
StudyPerson study_person(const SessionData& data, const protocol::Exclusion& rules, bool incomplete);

/// Returns the rules as sentences, in the order in which the manual lists them.
std::vector<std::string> rules_in_words(const protocol::Exclusion& rules);

/// How many participants have a row of the design.
struct RowCount {
  int row = 0, started = 0, completed = 0;
  int used = 0;  ///< completed, and not excluded
};
/// Returns the rows of the design, or those with a participant if there are more than 100; empty if all
/// participants have the same.
std::vector<RowCount> row_counts(const Study& study);

/// Computes balanced integration scores, group fits, means and effects from the participants who are not
/// excluded.
void finish_study(Study& study);

/// Returns the report as one JSON document without NaN.
std::string to_json(const Study& study);

std::optional<Figure> group_curve_figure(const Study& study);
std::optional<Figure> shrinkage_figure(const Study& study);
std::optional<Figure> group_trade_figure(const Study& study);
/// Means of the participants with their 95 % intervals in both directions, joined within a condition: the
/// conditional accuracy functions, d' over the lags of a response signal, and the macro trade (d' against the
/// median response time, one point for each condition).
std::optional<Figure> group_course_figure(const Study& study);

/// A table that becomes a CSV file with one header row.
struct CsvTable {
  std::string name;  ///< name of the CSV file
  std::string csv;
};
/// A text, and a number, as a field of a CSV file. A number that is not finite, or does not exist, is an
/// empty field.
std::string csv_field(const std::string& text);
std::string csv_number(double value);
std::string csv_number(const std::optional<double>& value);
/// Tidy tables for other programs: answers.csv (one row for each participant, condition and level),
/// measures.csv, effects.csv, estimates.csv (the procedures' own estimates), participants.csv and groups.csv.
std::vector<CsvTable> study_tables(const Study& study);
/// The header and the rows of trials.csv: one row for each experimental trial of a participant.
std::string trial_table_header();
std::string trial_table_rows(const StudyPerson& person, const SessionData& data);

}  // namespace turnpoint::report
