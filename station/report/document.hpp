#pragma once
#include <concepts>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "station/report/figure_files.hpp"
#include "station/report/study.hpp"
#include "station/report/summary.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

// A report as one document: headings, texts, tables, remarks and figures, of a session or of a study. The
// page in HTML and the report on the screen are written from it.

/// A number with what is known of it.
struct Number {
  double value = 0;
  /// Shown behind the value. Both are rounded to the digits that its width justifies.
  std::optional<analysis::Interval> interval = {};
  int digits = 3;  ///< significant digits, if there is no interval
  /// Whether the low or the high end of the interval is itself only a limit.
  bool at_most = false, at_least = false;
  bool unbounded = false;  ///< an infinite end is a result, not an end that could not be determined
};
/// The number and its interval (empty if it has none) in the digits that are known.
std::pair<core::Phrase, core::Phrase> in_known_digits(const Number& number);

/// A text whose language is chosen later, with numbers and marked words.
struct Text {
  enum class Look { plain, label, strong, soft, code, below };
  struct Run {
    std::variant<core::Phrase, Number> what;
    Look look = Look::plain;  ///< a label begins with a capital; `below` is a subscript
  };
  std::vector<Run> runs;

  Text() = default;
  Text(core::Phrase phrase, Look look = Look::plain) {
    if (!phrase.empty()) runs.push_back({std::move(phrase), look});
  }
  Text(std::string words, Look look = Look::plain) : Text(core::plain(std::move(words)), look) {}
  Text(const char* words, Look look = Look::plain) : Text(std::string(words), look) {}
  Text(std::integral auto count) : Text(std::to_string(count)) {}
  Text(Number number) { runs.push_back({std::move(number), Look::plain}); }
  Text& operator+=(const Text& more) {
    runs.insert(runs.end(), more.runs.begin(), more.runs.end());
    return *this;
  }
};
inline Text operator+(Text text, const Text& more) { return text += more; }

struct Cell {
  Text text;
  enum class Kind { text, head, number, missing } kind = Kind::text;
  bool brief = false;  ///< whether a short report shows it as well: that on the station's screen
  double shade = 0;    ///< of the background, from 0 to 1
  int columns = 1;     ///< how many columns the cell covers

  template <class T>
  requires std::convertible_to<T, Text> Cell(T&& content, Kind of_kind = Kind::text)
      : text(std::forward<T>(content)), kind(of_kind) {}
};
inline Cell head(Text text) { return {std::move(text), Cell::Kind::head}; }
inline Cell count(Text text) { return {std::move(text), Cell::Kind::number}; }
/// A number, or `missing` if there is none.
Cell amount(const std::optional<double>& value, int digits = 3, const char* missing = "\u2013");
Cell share(const std::optional<double>& value, int digits = 3);
Cell estimated(double value, const analysis::Interval& interval);
Cell estimated(const std::optional<analysis::Estimate>& estimate);
inline Cell brief(Cell cell) { return cell.brief = true, cell; }

struct Column {
  Text title;
  bool named = false;  ///< a short report names the column with each of its cells

  template <class T>
  requires std::convertible_to<T, Text> Column(T&& text, bool is_named = false)
      : title(std::forward<T>(text)), named(is_named) {}
};

struct Table {
  std::vector<Column> columns;  ///< may be empty if rows begin with what they mean
  std::vector<std::vector<Cell>> rows;
};

struct Heading {
  Text text;
  int level = 2;
};
struct Paragraph {
  Text text;
  bool explains = false;  ///< how numbers were computed, in smaller letters
  bool brief = false;     ///< as in Cell
};
struct List {
  std::vector<Text> items;
};

struct Document {
  std::string title;  ///< of the protocol
  std::string name;   ///< of the whole document: the title, and whose data it shows
  Text about;         ///< the line below the title
  std::string run_mode;
  std::string language = "en";  ///< of the figures
  using Part = std::variant<Heading, Paragraph, analysis::Statement, List, Table, NamedFigure>;
  std::vector<Part> parts;

  void heading(Text text, int level = 2) { parts.push_back(Heading{std::move(text), level}); }
  void say(Text text) { parts.push_back(Paragraph{std::move(text)}); }
  void explain(Text text) { parts.push_back(Paragraph{std::move(text), true}); }
  /// Remarks that must be shown with the numbers. `condition` is the one that they are about, if no heading
  /// says so.
  void remark(const std::vector<analysis::Statement>& statements, const std::string& condition = "");
  void remark(core::Phrase said) { parts.push_back(analysis::Statement{"", std::move(said)}); }
  /// Adds a table, unless it has no rows.
  void table(Table added);
  /// Adds a table of names and texts.
  template <class Fact>
  void facts(const std::vector<Fact>& facts) {
    Table list;
    for (const auto& [what, value] : facts) list.rows.push_back({head(what), brief(Cell(value))});
    table(std::move(list));
  }
  /// Adds a figure. Its caption says if intervals are drawn beside each other.
  void figure(const std::string& file, std::optional<Figure> drawn);
};

Document document(const Summary& summary);
/// The report of a session with a part for each of its tasks; what is about the whole session comes once.
Document document(const std::vector<Summary>& of_tasks);
Document document(const Study& study);
/// The figures of a document, in its order.
std::vector<NamedFigure> figures_of(const Document& document);

// What documents of a session and of a study have in common.

/// The name of the threshold, and of the slope, of a psychometric function, with its unit.
Text threshold_label(const LevelAnalysis& data);
Text slope_label(core::Function function, const LevelAnalysis& data);
/// What each analysis measures, as the protocol decides it.
void add_meanings(const SessionData& data, Document& document);
/// The procedures' own estimates. Each row begins with the cells of `of`.
struct OwnEstimate {
  std::vector<Cell> of;
  ProcedureEstimate estimate;
  bool brief = false;
};
void add_own_estimates(std::vector<Column> of, const std::vector<OwnEstimate>& estimates,
                       bool thresholds_differ, Document& document);
Text early_end(const EarlyEnd& end);

/// Writes a document as one self-contained page, laid out for the screen and for A4 paper: inline SVG, no
/// script, no external files.
std::string to_html(const Document& document);
inline std::string to_html(const Summary& summary) { return to_html(document(summary)); }

}  // namespace turnpoint::report
