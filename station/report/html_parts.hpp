#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"
#include "station/report/chart.hpp"
#include "station/report/summary.hpp"

namespace turnpoint::report {

// Pieces of HTML that several sections of the report's page use.

/// The page up to the first heading: title and style.
std::string html_head(const std::string& title);
/// A table of names and texts.
std::string facts_table(const std::vector<Fact>& list);
/// Escapes a text, and writes its leading hyphen as a minus sign.
std::string minus(std::string text);
std::string number(double value, int digits = 3);
/// Formats a value and its interval. Both are rounded to the digits that the width of the interval justifies.
std::string estimated(double value, const analysis::Interval& interval);
/// A table cell with an estimate and its interval.
std::string cell(const std::optional<analysis::Estimate>& estimate);
std::string notes(const std::vector<analysis::Statement>& statements);
std::string picture(const std::optional<Figure>& figure);
/// The name of a condition, or "all trials" if there is only one condition.
std::string name_of(const std::string& condition);

/// The titles and the cells of a table row with a procedure's own estimate.
extern const char* const kEstimateTitles;
std::string estimate_cells(const ProcedureEstimate& estimate);
/// Says why procedures' own estimates differ from the fit. `thresholds_differ`: see SessionData.
std::string why_estimates_differ(const std::vector<ProcedureEstimate>& estimates, bool thresholds_differ);
/// A sentence on a procedure that ended early.
std::string early_end(const EarlyEnd& end);
/// The section on the procedures' own estimates and early ends; "" if there are none.
std::string estimate_section(const SessionData& data);
/// The section on the threshold along the second dimension of the stimuli; "" if there is none.
std::string threshold_curve_section(const Summary& summary);

/// The section on the ROC of answers with confidence; "" if there is none.
std::string roc_section(const Summary& summary);

/// The section on accuracy at the response signal; "" if there was none.
std::string signal_section(const Summary& summary);

/// The section on the finger's force, speed and friction; "" if no force cells recorded data.
std::string finger_section(const Summary& summary);

/// What each analysis measures, as the protocol decides it.
std::string meanings_list(const SessionData& data);

}  // namespace turnpoint::report
