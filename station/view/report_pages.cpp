#include "station/view/report_pages.hpp"

#include <algorithm>

#include "station/view/report_data.hpp"

namespace turnpoint::view {

namespace {

using core::Phrase;
using report::Cell;

Phrase said(const report::Text& text) {
  Phrase all;
  for (const auto& run : text.runs) {
    if (const auto* phrase = std::get_if<Phrase>(&run.what)) {
      all.values.push_back(*phrase);
      continue;
    }
    auto [value, interval] = in_known_digits(std::get<report::Number>(run.what));
    all.values.push_back(std::move(value));
    if (!interval.empty()) all.values.insert(all.values.end(), {core::plain(" "), std::move(interval)});
  }
  return all.values.size() == 1 ? all.values.front() : all;
}

/// Writes what a document says in brief. What stands before the first heading is left out.
struct Brief {
  std::vector<ReportPages::Section> sections;
  Phrase prefix;  ///< the condition that a heading names, and a colon

  Phrase about(Phrase what) const {
    return prefix.empty() ? std::move(what) : Phrase{"", "", {prefix, std::move(what)}};
  }
  void state(Phrase what) { sections.back().statements.push_back(about(std::move(what))); }

  void operator()(const report::Heading& heading) {
    prefix = {};
    if (heading.level > 2)
      prefix = {"", "", {said(heading.text), core::plain(": ")}};
    else
      sections.push_back({said(heading.text), {}, {}});
  }
  void operator()(const report::Paragraph& paragraph) {
    if (paragraph.brief && !sections.empty()) state(said(paragraph.text));
  }
  void operator()(const analysis::Statement& statement) {
    if (!sections.empty()) state(statement.text);
  }
  void operator()(const report::List&) {}
  void operator()(const report::NamedFigure&) {}
  void operator()(const report::Table& table) {
    if (sections.empty()) return;
    for (const auto& row : table.rows) {
      Phrase name;  // the cells that the row begins with: a place in a list of levels, or texts
      std::size_t begin = 1;
      if (row.front().kind == Cell::Kind::number)
        name.values = {said(table.columns.front().title), core::plain(" "), said(row.front().text)};
      else
        name.values = {said(row.front().text)};
      for (; begin < row.size() && row[begin].kind == Cell::Kind::text && !row[begin].brief; ++begin)
        if (!row[begin].text.runs.empty())
          name.values.insert(name.values.end(), {core::plain(", "), said(row[begin].text)});
      for (std::size_t i = begin; i < row.size(); ++i) {
        if (!row[i].brief) continue;
        auto label = name;
        if (i < table.columns.size() && table.columns[i].named)
          label = {"", "", {said(table.columns[i].title), core::plain(": "), label}};
        sections.back().facts.emplace_back(about(std::move(label)), said(row[i].text));
      }
    }
  }
};

}  // namespace

ReportPages report_pages(const report::Summary& summary) {
  const auto document = report::document(summary);
  Brief brief;
  for (const auto& part : document.parts) std::visit(brief, part);
  std::erase_if(brief.sections, [](const auto& one) { return one.facts.empty() && one.statements.empty(); });
  const auto to_front = [&](const char* key) {
    std::stable_partition(brief.sections.begin(), brief.sections.end(),
                          [key](const auto& one) { return one.heading.key == key; });
  };
  to_front("report.speed_accuracy");
  to_front("report.course");
  ReportPages pages{document.name, summary.data.run_mode, summary.data.status, std::move(brief.sections),
                    figures_of(document)};
  // a session with several instructions is about the trade-off between them
  if (summary.trade.instructions.size() > 1)
    std::stable_partition(pages.figures.begin(), pages.figures.end(),
                          [](const auto& figure) { return figure.name == "speed-accuracy"; });
  return pages;
}

ReportPages report_pages(const std::string& database, const std::string& session_id,
                         const std::string& language) {
  std::vector<report::Summary> summaries;
  for (auto& data : report_data(database, session_id)) {
    data.language = language;
    summaries.push_back(report::summarise(std::move(data)));
  }
  auto all = report_pages(summaries.front());
  if (summaries.size() == 1) return all;
  all.sections.clear(), all.figures.clear();
  for (const auto& summary : summaries) {
    auto pages = report_pages(summary);
    for (auto& section : pages.sections) {
      section.heading = {"", summary.data.task + ": ", {section.heading}};
      all.sections.push_back(std::move(section));
    }
    std::move(pages.figures.begin(), pages.figures.end(), std::back_inserter(all.figures));
  }
  // what is about the whole session
  Brief whole;
  for (const auto& part : report::document(summaries).parts) std::visit(whole, part);
  for (auto& section : whole.sections)
    if (section.heading.key == "report.station") all.sections.push_back(std::move(section));
  return all;
}

}  // namespace turnpoint::view
