#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "station/store/export_bids_texts.hpp"
#include "station/store/export_files.hpp"
#include "station/store/signal_code.hpp"
#include "station/store/stored_signals.hpp"

namespace turnpoint::store {

namespace {

using Json = nlohmann::ordered_json;

/// Returns the label of a recording. The stream "finger" of the force cells is labelled "force", after what
/// it measures.
std::string recording_of(const std::string& stream) {
  return stream == "finger" ? "force" : bids_label(stream);
}

/// Writes the signals of one run as one table. BIDS gives a recording one start and one rate, so the table
/// has no gaps: each trial is placed by its time, to within half a point, and the rows between trials are
/// filled.
class Recording {
 public:
  Recording(const std::string& base, const SignalRow& first, std::vector<SignalChannel> channels)
      : base_(base),
        start_s_(first.start_s),
        rate_Hz_(first.rate_Hz),
        channels_(std::move(channels)),
        table_(base + ".tsv.gz", {TableStyle::Kind::bids, '\t', '.'}, names_of(signal_columns(channels_)),
               TableFile::Header::left_out) {}

  void add(const SignalRow& signal) {
    if (signal.rate_Hz != rate_Hz_)
      throw StoreError(ErrorKind::corrupt,
                       fmt::format("export bids: the signals \"{}\" of one run have {} and {} points per "
                                   "second",
                                   signal.stream, rate_Hz_, signal.rate_Hz));
    const auto first = std::llround((signal.start_s - start_s_) * rate_Hz_);
    for (const std::vector<Cell> missing(channels_.size()); next_ < first; ++next_) table_.row(missing);
    const auto values = decode(signal);
    const auto places = places_of(signal, channels_);
    std::vector<Cell> cells(channels_.size());
    for (auto point = next_ - first; point < signal.points; ++point, ++next_) {
      for (std::size_t c = 0; c < values.size(); ++c) {
        const double value = values[c][static_cast<std::size_t>(point)];
        cells[places[c]] = std::isnan(value) ? Cell{} : cell(value);
      }
      table_.row(cells);
    }
  }

  /// `start` is the session whose protocol describes the task in the sidecar file.
  void finish(const SessionStart& start, std::vector<ExportedFile>& files) {
    table_.finish(files);
    const auto columns = signal_columns(channels_);
    Json json{{"SamplingFrequency", rate_Hz_},
              {"StartTime", start_s_},
              {"Columns", names_of(columns)},
              {"PhysioType", "generic"}};
    const auto described = Json::parse(bids_sidecar(start, columns));
    for (const auto& [name, value] : described.items()) json[name] = value;
    write_file(base_ + ".json", json.dump(2) + "\n");
    files.push_back({base_ + ".json", 0});
  }

 private:
  std::string base_;
  double start_s_, rate_Hz_;
  std::vector<SignalChannel> channels_;
  TableFile table_;
  std::int64_t next_ = 0;  ///< number of rows that have been written
};

}  // namespace

void export_bids_signals(Database& database, const BidsRun& run, const std::string& base,
                         std::vector<ExportedFile>& files) {
  const auto& session_id = run.session_id;
  for (const auto& stream : signal_streams(database, session_id)) {
    // A recording of BIDS has no gaps. Between two void trials, hours of samples would be missing.
    if (stream == records::kRawStream) continue;
    SignalReader reader(database, session_id, stream, run.segment);
    std::optional<Recording> recording;
    while (const auto stored = reader.next()) {
      if (!recording)
        recording.emplace(fmt::format("{}_recording-{}_physio", base, recording_of(stream)), stored->row,
                          signal_channels(database, session_id, stream));
      recording->add(stored->row);
    }
    if (recording) recording->finish(run.task, files);
  }
}

}  // namespace turnpoint::store
