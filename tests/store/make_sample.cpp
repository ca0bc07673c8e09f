// make_sample FOLDER: writes a database of several sessions to FOLDER/lab.sqlite and exports it to
// FOLDER/csv, FOLDER/bids and FOLDER/signals.
// make_sample FOLDER every: writes a database that has rows in every table to FOLDER/lab.sqlite.
#include <cstdio>

#include "station/store/export.hpp"
#include "station/store/merge.hpp"
#include "station/store/people.hpp"
#include "station/store/places.hpp"
#include "station/store/session_log.hpp"
#include "station/store/station.hpp"
#include "station/store/withdraw.hpp"
#include "tests/store/sample.hpp"

using namespace turnpoint::store;

namespace {

void fill_every_table(const std::string& folder) {
  const auto db = folder + "/lab.sqlite", other = folder + "/other.sqlite";
  auto start = sample::start();
  start.calibration_id = std::string(64, 'c');
  start.calibration_text = "measured\n";
  {
    auto log = SessionLog::begin(db, start, sample::segment());
    EventRow tested{1'500'000'000, "self_test", "passed", std::nullopt};
    tested.checks = {{"gate", Verdict::passed, 110.5, 250, "ms", "it shut"}};
    log.event(tested);
    EventRow measured{1'600'000'000, "friction_table", "used", std::nullopt};
    measured.friction_levels = {{0.5, 6, 0.71, 0.7, 0.03, 0.63, 0.78}, {1.5, 5, 0.2, 0.21, 0.01, 0.18, 0.24}};
    log.event(measured);
    EventRow started{1'700'000'000, kProgramEvent, "stairs", std::nullopt};
    started.programs = {{"procedure", "stairs", "up-down", "1.2", "/p/stairs.py", std::string(64, 'c')}};
    log.event(started);
    EventRow asked{1'750'000'000, kAnswerEvent, "", std::nullopt};
    asked.answers = {{"about-you", "hand", 0, "left", 2.5}};
    log.event(asked);
    log.begin_block(sample::block());
    for (int i = 0; i < 4; ++i) log.append(i == 2 ? sample::failed(i) : sample::answered(i));
    EventRow estimated{1'800'000'000, kEstimatesEvent, "stairs", std::nullopt};
    estimated.estimates = {{0, 1, "stairs", "threshold", -7.25, 1.5, "8 reversals"}};
    log.event(estimated);
    log.finish(SessionStatus::completed, "");
    log.annotate("a note");
  }
  sample::session(db, 3, sample::start("P02"), SessionStatus::interrupted);
  sample::session(db, 2, sample::start("P03"));
  auto there = sample::start("P07");
  there.station_id = "bench-b";
  sample::session(other, 2, there);
  name_station(other, {"bench-b", Whose::found, false});
  name_station(other, {"bench-c", Whose::found, true});
  merge(db, other);
  join(db, "P01", "P07");
  withdraw(db, {"P03", "", "", ""});
  set_leased_places(db, "two-boundaries", {0, 4});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3) fill_every_table(argv[1]);
  if (argc == 3) return 0;
  if (argc != 2) return 2;
  const std::string folder = argv[1], db = folder + "/lab.sqlite";
  const auto first = sample::session(db, 30);
  annotate(db, first, "=a note, with a comma and \"quotes\"");
  const auto id = sample::session(db, 12, sample::start("P-02"), SessionStatus::interrupted);
  {
    auto log = SessionLog::resume(db, id, sample::segment("resume"));
    log.begin_block(sample::block());
    log.append(sample::answered(12));
    log.finish(SessionStatus::completed, "");
  }
  sample::session(db, 10);
  export_data(db, folder + "/csv", {});
  ExportOptions bids;
  bids.format = ExportFormat::bids;
  export_data(db, folder + "/bids", bids);
  ExportOptions signals;
  signals.format = ExportFormat::signals;
  export_data(db, folder + "/signals", signals);
  std::puts("made");
}
