#pragma once
#include <string>
#include <utility>
#include <vector>

#include "station/report/document.hpp"

namespace turnpoint::view {

/// A session's report for the screen: of each part of the document, what it says in brief, and all figures.
struct ReportPages {
  /// What stands under one heading of the document. The name of a condition stands before what is said about
  /// it.
  struct Section {
    core::Phrase heading;
    std::vector<std::pair<core::Phrase, core::Phrase>> facts;  ///< a label and its value
    std::vector<core::Phrase> statements;  ///< remarks that must be shown with the numbers
  };
  std::string title;              ///< title of the protocol, and participant
  std::string run_mode, status;   ///< "live", "completed", ...
  std::vector<Section> sections;  ///< those on the course of the session and on speed and accuracy first
  std::vector<report::NamedFigure> figures;  ///< those of the report
};

/// Makes the report of a stored session with report_data() and report::summarise(), with figures in a
/// language such as "de". Takes about 0.3 s.
ReportPages report_pages(const std::string& database, const std::string& session_id,
                         const std::string& language = "en");
/// The same with figures in the language of the summary's SessionData.
ReportPages report_pages(const report::Summary& summary);

}  // namespace turnpoint::view
