#include "station/view/report_data.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <deque>
#include <memory>
#include <optional>
#include <system_error>

#include "station/cli/command.hpp"
#include "station/cli/long_work.hpp"
#include "station/cli/shared_options.hpp"
#include "station/collector/fetch.hpp"
#include "station/core/number.hpp"
#include "station/core/usage_error.hpp"
#include "station/protocol/protocol.hpp"
#include "station/report/document.hpp"
#include "station/report/figure_files.hpp"
#include "station/report/pdf.hpp"
#include "station/report/stored_estimates.hpp"
#include "station/session/program_estimator.hpp"
#include "station/store/read.hpp"
#include "station/system/fonts.hpp"
#include "station/system/write_file.hpp"
#include "station/view/study_data.hpp"

namespace turnpoint::cli {

namespace report_command {

struct Options {
  std::vector<std::string> databases, names;
  std::string out, tables, figures, estimator;
  store::SessionFilter filter;
  bool study = false, progress = false;
  std::string task;
  std::string protocol_version, mode;
};

/// Adds the estimates of a separate program, and which program it was.
void add_estimates(const std::string& estimator, const std::string& database, const std::string& session,
                   report::SessionData& data) {
  const auto stored = store::read_session(database, session);
  const auto& start = stored.session.start;
  const auto protocol = protocol::parse(start.protocol_text, start.protocol_path);
  const auto found = session::estimated_by(estimator, protocol, stored.blocks);
  report::add_estimator(found.program.name, found.estimates, protocol, data);
  data.facts.emplace_back("Estimator", fmt::format("{} {}, SHA-256 {}", found.program.name,
                                                   found.program.version, found.program.sha256));
}

/// Writes the files of the figures that --figures asks for.
void write_figures(const std::string& folder, const std::vector<report::NamedFigure>& figures) {
  if (folder.empty()) return;
  system::make_folder(folder);
  std::string without_pdf;
  for (const auto& figure : figures) {
    const auto pdf_of = [&](const report::Figure& drawn) -> std::string {
      report::Pdf pdf(system::outline);
      try {
        draw(pdf, drawn);
        return pdf.finish();
      } catch (const report::JoinedLetters& letters) {
        without_pdf = figure.name + ".pdf: not written, because " + letters.what() +
                      "; the SVG has them, and the page of the report on the screen saves a PDF";
        return "";
      }
    };
    for (const auto& file : report::figure_files(figure, pdf_of))
      system::write_file(folder + "/" + file.name, file.bytes);
  }
  if (!without_pdf.empty()) throw std::runtime_error(without_pdf);
}

/// Prints what the procedures estimated themselves.
void print_estimates(std::ostream& out, const report::SessionData& data) {
  for (const auto& estimate : data.estimates)
    fmt::print(out, "  {}: {} {}{}{}\n", estimate.procedure, estimate.parameter,
               core::number(estimate.mean, 4),
               estimate.sd ? fmt::format(" (SD {})", core::number(*estimate.sd, 3)) : "",
               estimate.interval ? fmt::format(", 95 % {} to {}", core::number(estimate.interval->low, 3),
                                               core::number(estimate.interval->high, 3))
                                 : "");
  for (const auto& end : data.early_ends)
    fmt::print(out, "  ended early in {}: {}\n", end.block, core::say(end.why, "en"));
}

void report_session(Options options, Context& context) {
  if (options.databases.size() > 1)
    throw core::UsageError("--db names " + std::to_string(options.databases.size()) +
                           " files; the report of one session reads one, that of a study (--study) several");
  if (!options.tables.empty() || !options.protocol_version.empty() || !options.mode.empty() ||
      !options.task.empty())
    throw core::UsageError(
        "--tables, --protocol-version, --mode and --task belong to the report of a study: add --study");
  const auto& database = options.databases.front();
  const auto id = view::session_to_report(database, options.filter);
  auto collected = view::report_data(database, id);
  if (!options.estimator.empty()) {
    if (collected.size() > 1)
      throw core::UsageError(
          "--estimator: the session has several tasks, and a separate program is not told which");
    add_estimates(options.estimator, database, id, collected.front());
  }
  std::vector<report::Summary> summaries;
  for (const auto& data : collected) summaries.push_back(report::summarise(data));
  if (context.json) context.out << report::to_json(summaries) << "\n";
  const auto document = report::document(summaries);
  write_figures(options.figures, figures_of(document));
  if (options.out.empty() && !context.json) options.out = "report-" + id + ".html";
  if (options.out.empty()) return;
  system::write_file(options.out, to_html(document));
  if (context.json) return;
  int presented = 0;
  for (const auto& summary : summaries) presented += summary.outcomes.presented;
  const auto& first = summaries.front().data;
  fmt::print(context.out, "{}: session {} of {}, {}, {} trials\n", options.out, first.session_id,
             first.participant, first.title, presented);
  for (const auto& summary : summaries) print_estimates(context.out, summary.data);
}

/// The file trials.csv, which --tables asks for. It is written participant by participant.
class TrialFile {
 public:
  explicit TrialFile(const std::string& folder) {
    if (folder.empty()) return;
    system::make_folder(folder);
    file_.emplace(folder + "/trials.csv");
    file_->write(report::trial_table_header());
  }
  void add(const report::StudyPerson& person, const report::SessionData& data) {
    if (file_) file_->write(report::trial_table_rows(person, data));
  }
  void commit() {
    if (file_) file_->commit();
  }

 private:
  std::optional<system::FileWriter> file_;
};

template <class Estimate>
std::string interval_in_words(const Estimate& estimate) {
  return fmt::format("{} [{}, {}]", core::number(estimate.value, 3), core::number(estimate.interval.low, 3),
                     core::number(estimate.interval.high, 3));
}

void print_study(std::ostream& out, const std::string& file, const report::Study& study) {
  std::size_t excluded = 0;
  for (const auto& person : study.persons) excluded += !person.excluded.empty();
  fmt::print(out, "{}: {} participants, {} excluded\n", file, study.persons.size(), excluded);
  for (const auto& group : study.groups) {
    const auto name = core::say(report::name_of(group.condition), "en");
    if (group.result.fit && group.result.fit->threshold) {
      fmt::print(out, "  {}: threshold of the group {} {}\n", name,
                 interval_in_words(*group.result.fit->threshold), study.settings.level_unit);
    }
    for (const auto& statement : group.result.statements)
      fmt::print(out, "  {}: {}\n", name, core::say(statement.text, "en"));
  }
  for (const auto& effect : study.effects) {
    if (!effect.difference) continue;
    fmt::print(out, "  {}, {} - {}: {}{}\n", effect.measure, effect.second, effect.first,
               interval_in_words(*effect.difference),
               effect.corrected_p ? ", corrected p " + core::number(*effect.corrected_p, 2) : "");
  }
}

void report_study(Options options, Context& context) {
  if (!options.filter.session_id.empty() || !options.filter.participant.empty())
    throw core::UsageError("--study covers all participants: leave out --session and --participant");
  if (!options.estimator.empty())
    throw core::UsageError("--estimator belongs to the report of one session: leave out --study");
  LongWork work(options.progress);
  TrialFile trials(options.tables);
  const auto study = view::study_data(
      {options.databases, options.names, options.filter.protocol_id, options.protocol_version, options.mode,
       options.task},
      [&](const auto& person, const auto& data) { trials.add(person, data); },
      [&](int done, int of) {
        work.show("participants", done, of);
        return !work.stop().stop_requested();
      });
  const auto told = work.end(context);
  if (!options.tables.empty()) {
    trials.commit();
    for (const auto& table : report::study_tables(study))
      system::write_file(options.tables + "/" + table.name, table.csv);
  }
  if (context.json) context.out << report::to_json(study) << "\n";
  const auto document = report::document(study);
  write_figures(options.figures, figures_of(document));
  if (options.out.empty() && !context.json) options.out = "study.html";
  if (options.out.empty()) return;
  system::write_file(options.out, to_html(document));
  if (!context.json) print_study(context.out, options.out, study);
}

void report_databases(Options options, Context& context) {
  std::deque<collector::ReadableDatabase> readable;
  for (auto& database : options.databases) {
    // Do not show the address of a collector: it may contain a password.
    options.names.push_back(collector::is_server(database) ? "collector" : database);
    database = readable.emplace_back(database, options.filter).path();
  }
  if (options.study)
    report_study(options, context);
  else
    report_session(options, context);
}

}  // namespace report_command

void add_report(CommandLine& app, Context& context) {
  using namespace report_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "report", "Write a report of a session, or of a study: fits, speed-accuracy trade-off, effects");
  add_databases(*command, options->databases,
                "Database, or a collector: postgresql://...; with --study, one or more");
  command->add_option("--session", options->filter.session_id,
                      "Session to report; by default the newest one");
  command->add_option("--participant", options->filter.participant,
                      "Report the newest session of this participant: CODE or CODE@STATION");
  command->add_option("--protocol", options->filter.protocol_id,
                      "Report the newest session of this protocol, or the study with this protocol");
  command->add_flag("--study", options->study,
                    "Report all participants of a protocol together, except those whom its [exclusion] "
                    "excludes");
  command->add_option("--protocol-version", options->protocol_version,
                      "With --study: only sessions with this version of the protocol, or with a protocol "
                      "text whose SHA-256 begins with this");
  command->add_option("--mode", options->mode, "With --study: only sessions of this mode")
      ->check(one_of({"live", "pilot", "simulated"}));
  command->add_option("--task", options->task,
                      "With --study of a protocol with several tasks: the one to report");
  command
      ->add_option("--tables", options->tables,
                   "With --study: write tidy CSV tables for R and Python to this folder")
      ->value("FOLDER");
  command
      ->add_option("--figures", options->figures,
                   "Also write each figure to this folder, for a paper: SVG and PDF, 85 and 180 mm wide, its data "
                   "as CSV and its caption")
      ->value("FOLDER");
  command
      ->add_option("--estimator", options->estimator,
                   "program:FILE[,limit_s=S][,KEY=VALUE]...: also show what this separate program estimates "
                   "from the trials; protocols/programs.md")
      ->value("PROGRAM");
  command
      ->add_option("--out", options->out,
                   "HTML file to write; by default report-SESSION.html or study.html, or no file with --json")
      ->value("FILE");
  add_progress(*command, options->progress);
  add_json(*command, context);
  command->footer("Example: turnpoint report --db lab.sqlite --participant P01 --out P01.html");
  command->callback([options, &context] { report_databases(*options, context); });
}

}  // namespace turnpoint::cli
