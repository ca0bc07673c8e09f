#include "station/store/export.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/cli/sign.hpp"
#include "station/collector/fetch.hpp"

namespace turnpoint::cli {

namespace export_command {

struct Options {
  std::string database, out, format = "csv", separator = ",", decimal = ".";
  store::ExportOptions selection;
  std::string sign;  ///< SSH key file; "" for no signature
};

char single(const std::string& option, const std::string& text) {
  if (text == "tab" || text == "\\t") return '\t';
  if (text.size() != 1)
    throw UsageError(fmt::format("{} \"{}\": write a single character, or \"tab\"", option, text));
  return text.front();
}

/// Returns the number of exported trials, that is, of rows in the trial tables; for an export of signals, the
/// number of signals.
std::size_t trial_rows(const std::vector<store::ExportedFile>& files) {
  std::size_t rows = 0;
  for (const auto& file : files)
    for (const auto* table : {"/trials.csv", "_beh.tsv", "/signals.csv"})
      if (file.path.ends_with(table)) rows += file.rows;
  return rows;
}

store::ExportFormat format_named(const std::string& word) {
  if (word == "bids") return store::ExportFormat::bids;
  return word == "signals" ? store::ExportFormat::signals : store::ExportFormat::csv;
}

void export_data(Options options, Context& context) {
  auto& selection = options.selection;
  selection.format = format_named(options.format);
  selection.separator = single("--separator", options.separator);
  selection.decimal = single("--decimal", options.decimal);
  const collector::ReadableDatabase database(
      options.database, {selection.session_id, selection.participant, selection.protocol_id});
  auto files = store::export_data(database.path(), options.out, selection);
  if (!options.sign.empty()) {
    std::vector<std::string> paths;
    for (const auto& file : files) paths.push_back(file.path);
    for (const auto& path : sign_files(options.out, paths, options.sign)) files.push_back({path, 0});
  }
  if (context.json) {
    Json list = Json::array();
    for (const auto& file : files) list.push_back({{"path", file.path}, {"rows", file.rows}});
    print_json(context.out, Json{{"files", list}, {"rows", trial_rows(files)}});
    return;
  }
  for (const auto& file : files)
    fmt::print(context.out, "{}{}\n", file.path, file.rows > 0 ? fmt::format(" ({} rows)", file.rows) : "");
  fmt::print(context.out, "{} {} in {} files\n", trial_rows(files),
             selection.format == store::ExportFormat::signals ? "signals" : "trials", files.size());
}

}  // namespace export_command

void add_export(CommandLine& app, Context& context) {
  using namespace export_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "export", "Write sessions as CSV or BIDS, or their signals, with one folder for each protocol");
  add_readable_database(*command, options->database);
  command->add_option("--out", options->out, "Folder to write to")->value("FOLDER")->required();
  command->add_option("--session", options->selection.session_id, "Export only this session");
  command->add_option("--participant", options->selection.participant,
                      "Export only this participant: CODE or CODE@STATION");
  command->add_option("--protocol", options->selection.protocol_id, "Export only this protocol");
  command
      ->add_option("--format", options->format,
                   "csv | bids | signals (every point that force cells recorded)")
      ->check(one_of({"csv", "bids", "signals"}))
      ->capture_default_str();
  command->add_option("--separator", options->separator, "Column separator: , ; | or tab")
      ->capture_default_str();
  command->add_option("--decimal", options->decimal, "Decimal mark: . or ,")->capture_default_str();
  command->add_flag(
      "--byte-order-mark", options->selection.byte_order_mark,
      "Begin each CSV table with the UTF-8 byte order mark; without it, Excel shows umlauts wrongly");
  command
      ->add_option("--sign", options->sign,
                   "SSH key file with which to sign the checksums of all exported files (writes "
                   "SHA256SUMS and SHA256SUMS.sig)")
      ->value("FILE");
  add_json(*command, context);
  command->footer("Example: turnpoint export --db lab.sqlite --out export --separator ';' --decimal ,");
  command->callback([options, &context] { export_data(*options, context); });
}

}  // namespace turnpoint::cli
