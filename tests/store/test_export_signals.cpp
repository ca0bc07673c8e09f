#include <zlib.h>

#include <nlohmann/json.hpp>

#include "station/store/backup.hpp"
#include "station/store/export.hpp"
#include "station/store/merge.hpp"
#include "station/store/read.hpp"
#include "station/store/text_table.hpp"
#include "station/store/verify.hpp"
#include "station/store/withdraw.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;
namespace fs = std::filesystem;

namespace {

/// Returns the content of a gzip file.
std::string unpacked(const std::string& path) {
  std::string text, piece(1 << 16, '\0');
  const auto file = gzopen(path.c_str(), "rb");
  REQUIRE(file != nullptr);
  for (int size = 0; (size = gzread(file, piece.data(), static_cast<unsigned>(piece.size()))) > 0;)
    text.append(piece, 0, static_cast<std::size_t>(size));
  CHECK(gzclose(file) == Z_OK);
  return text;
}

ExportOptions signals_only() {
  ExportOptions options;
  options.format = ExportFormat::signals;
  return options;
}

std::string table_of(const std::string& session_id) {
  return "/two-boundaries/signals/" + session_id + "_finger.csv.gz";
}

/// Makes a session without signals, as on a rig without force cells.
std::string session_without_signals(const std::string& db, const std::string& participant) {
  auto log = SessionLog::begin(db, sample::start(participant), sample::segment());
  log.begin_block(sample::block());
  auto trial = sample::answered(0);
  trial.signal_rows.clear();
  log.append(trial);
  log.finish(SessionStatus::completed, "");
  return log.session().session_id;
}

}  // namespace

TEST_CASE("signals are exported point by point, with trial, time and playback frame", "[store][signals]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = sample::session(db, 3);
  const auto files = export_data(db, folder / "out", signals_only());
  REQUIRE(files.size() == 3);
  CHECK(files[0].path == folder / "out" + table_of(id));
  CHECK(files[0].rows == 1500);
  const auto rows = read_table(unpacked(files[0].path));
  REQUIRE(rows.size() == 1501);
  CHECK(rows[0] == std::vector<std::string>{"trial_index", "segment_id", "time_s", "frame", "normal_n",
                                            "lateral_n", "position_mm", "speed_mm_s"});
  CHECK(rows[1] == std::vector<std::string>{"0", "1", "1.5", "192000", "0.5", "0.3", "n/a", "n/a"});
  CHECK(rows[1001] == std::vector<std::string>{"2", "1", "3.5", "576000", "0.5909", "0.3", "n/a", "n/a"});
  CHECK(rows[1026] ==
        std::vector<std::string>{"2", "1", "3.525", "580800", "0.5598", "0.2907", "102", "72.5"});
  const auto values = decode(sample::finger_signal(1));
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t k = 0; k < 500; ++k) {
      const auto& text = rows[501 + k][4 + c];
      INFO(c << " " << k);
      if (std::isnan(values[c][k]))
        REQUIRE(text == "n/a");
      else
        REQUIRE(std::stod(text) == values[c][k]);
    }
}

TEST_CASE("a list says which signals there are and where, and a codebook explains every column",
          "[store][signals]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = sample::session(db, 2);
  session_without_signals(db, "P02");
  const auto files = export_data(db, folder / "out", signals_only());
  REQUIRE(files.size() == 3);
  CHECK(fs::path(files[1].path).filename() == "signals.csv");
  CHECK(files[1].rows == 2);
  const auto list = read_table(sample::bytes_of(files[1].path));
  CHECK(list[2] == std::vector<std::string>{"P01", id, "simulated", "1", "1", "finger", "2.5", "384000",
                                            "1000", "500", "signals/" + id + "_finger.csv.gz", "1"});
  CHECK(fs::exists(folder / "out/two-boundaries/" + list[2][10]));
  const auto codebook = nlohmann::json::parse(sample::bytes_of(files[2].path));
  for (const auto& column : list[0])
    CHECK(codebook.at("signals.csv").at(column).at("Description").get<std::string>().size() > 3);
  const auto& points = codebook.at("signals/*_finger.csv.gz");
  const auto rows = read_table(unpacked(files[0].path));
  for (const auto& column : rows[0]) CHECK(points.at(column).at("Description").get<std::string>().size() > 3);
  CHECK(points.at("speed_mm_s").at("Units") == "mm/s");
  CHECK_FALSE(fs::exists(folder / "out/two-boundaries/EXPORT-INCOMPLETE.txt"));
}

TEST_CASE("a session whose channels changed has a column for each of them", "[store][signals]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto log = SessionLog::begin(db, sample::start(), sample::segment());
  log.begin_block(sample::block());
  log.append(sample::answered(0));
  auto later = sample::answered(1);
  auto& signal = later.signal_rows[0];
  signal.channels = {{"heat", "mW/cm^2", 0.5}, {"normal", "N", 1e-3}};
  signal.rate_Hz = 4000;
  encode(signal, std::vector<std::vector<double>>{{1.5, 2}, {0.25, 0.125}});
  log.append(later);
  log.finish(SessionStatus::completed, "");
  const auto rows = read_table(unpacked(export_data(db, folder / "out", signals_only())[0].path));
  REQUIRE(rows.size() == 503);
  CHECK(rows[0].back() == "heat_mw_cm_2");
  CHECK(rows[500].back() == "n/a");
  CHECK(rows[501] == std::vector<std::string>{"1", "1", "2.5", "384000", "0.25", "n/a", "n/a", "n/a", "1.5"});
  CHECK(rows[502][2] == "2.50025");
  CHECK(rows[502][3] == "384048");
  CHECK(rows[502][4] == "0.125");
}

TEST_CASE("exported signals are the same after a merge, and gone after a withdrawal", "[store][signals]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", other = folder / "b.sqlite";
  sample::session(db, 2);
  auto start = sample::start("P07");
  start.station_id = "bench-b";
  const auto id = sample::session(other, 4, start);
  export_data(other, folder / "there", signals_only());
  merge(db, other);
  CHECK(export_data(db, folder / "here", signals_only()).size() == 4);
  CHECK(sample::bytes_of(folder / "here" + table_of(id)) ==
        sample::bytes_of(folder / "there" + table_of(id)));
  withdraw(db, {"P07", "", "", ""});
  // The folder contains signals of an earlier export, of a session that is not part of this export. The
  // export must refuse to mix them.
  const auto [kind, message] = sample::failure([&] { export_data(db, folder / "here", signals_only()); });
  CHECK(kind == ErrorKind::conflict);
  CHECK(sample::contains(message, id + "_finger.csv.gz"));
  CHECK(export_data(db, folder / "new", signals_only()).size() == 3);
  CHECK_FALSE(fs::exists(folder / "new" + table_of(id)));
}

TEST_CASE("what was captured in a void trial is exported sample by sample, merged, backed up and withdrawn",
          "[store][signals][raw]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", other = folder / "b.sqlite";
  sample::session(other, 1);
  auto start = sample::start("P07");
  start.station_id = "bench-b";
  auto log = SessionLog::begin(db, start, sample::segment());
  log.begin_block(sample::block());
  log.append(sample::answered(0));
  log.append(sample::failed(1));
  log.finish(SessionStatus::completed, "");
  const auto id = log.session().session_id;
  const auto raw_table = [&](const std::string& out) {
    return folder / out + "/two-boundaries/signals/" + id + "_raw.csv.gz";
  };
  CHECK(export_data(db, folder / "out", signals_only()).size() == 4);
  const auto rows = read_table(unpacked(raw_table("out")));
  REQUIRE(rows.size() == 4);
  CHECK(rows[0] ==
        std::vector<std::string>{"trial_index", "segment_id", "time_s", "frame", "channel_0", "channel_1"});
  CHECK(rows[1] == std::vector<std::string>{"1", "1", "2.5", "384000", "0", "2147483647"});
  CHECK(rows[2] == std::vector<std::string>{"1", "1", "2.500005", "384001", "-256", "-2147483647"});
  CHECK(rows[3] == std::vector<std::string>{"1", "1", "2.50001", "384002", "n/a", "77"});

  const auto copy = backup(db, {folder / "backups", 9}).path;
  merge(other, copy);
  export_data(other, folder / "merged", signals_only());
  CHECK(unpacked(raw_table("merged")) == unpacked(raw_table("out")));
  CHECK(verify(other).good());

  // BIDS has no place for signals with gaps.
  ExportOptions bids;
  bids.format = ExportFormat::bids;
  for (const auto& file : export_data(db, folder / "bids", bids))
    CHECK_FALSE(sample::contains(file.path, "raw"));

  withdraw(other, {"P07", "", "", ""});
  export_data(other, folder / "without", signals_only());
  CHECK_FALSE(fs::exists(raw_table("without")));
  CHECK(sample::raw(other).integer("SELECT count(*) FROM signal WHERE stream = 'raw'") == 0);
}

TEST_CASE("without signals there is nothing to export, and no folder is made", "[store][signals]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  session_without_signals(db, "P01");
  const auto [kind, message] = sample::failure([&] { export_data(db, folder / "out", signals_only()); });
  CHECK(kind == ErrorKind::missing);
  CHECK(sample::contains(message, "have no signals"));
  CHECK_FALSE(fs::exists(folder / "out"));
}

TEST_CASE("a damaged signal stops the export and leaves its mark", "[store][signals]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 2);
  sample::raw(db).execute(
      "DROP TRIGGER signal_is_never_changed; UPDATE signal SET data = zeroblob(9) WHERE trial_index = 1");
  const auto [kind, message] = sample::failure([&] { export_data(db, folder / "out", signals_only()); });
  CHECK(kind == ErrorKind::corrupt);
  CHECK(fs::exists(folder / "out/two-boundaries/EXPORT-INCOMPLETE.txt"));
}

TEST_CASE("signals can have another separator and a decimal comma; the frame needs the rig's rate",
          "[store][signals]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto start = sample::start();
  start.rig_text = "not [ a rig";
  sample::session(db, 1, start);
  auto options = signals_only();
  options.separator = ';';
  options.decimal = ',';
  const auto files = export_data(db, folder / "out", options);
  CHECK(sample::contains(unpacked(files[0].path), "\r\n0;1;1,5;n/a;0,5;0,3;n/a;n/a\r\n"));
  CHECK(sample::bytes_of(files[0].path) ==
        sample::bytes_of(export_data(db, folder / "again", options)[0].path));
}
