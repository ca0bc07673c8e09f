#pragma once
#include <string>
#include <utility>
#include <vector>

#include "station/report/figure_files.hpp"
#include "station/report/summary.hpp"

namespace turnpoint::view {

/// A session's report as pages of the screen: texts and figures.
struct ReportPages {
  std::string title;             ///< title of the protocol, and participant
  std::string run_mode, status;  ///< "live", "completed", ...
  /// the tables of the report, as pairs of a label and a value
  std::vector<std::pair<std::string, std::string>> outcomes, fit, speed_accuracy, forces;
  std::vector<std::pair<core::Phrase, core::Phrase>> health;  ///< facts about the station
  std::vector<core::Phrase> statements;                       ///< remarks that must be shown with the numbers
  std::vector<report::NamedFigure> figures;  ///< those of the report, the speed-accuracy trade-off first
};

/// Makes the report of a stored session with report_data() and report::summarise(), in a language such as
/// "de". Takes about 0.3 s.
ReportPages report_pages(const std::string& database, const std::string& session_id,
                         const std::string& language = "en");
/// The same in the language of the summary's SessionData.
ReportPages report_pages(const report::Summary& summary);

}  // namespace turnpoint::view
