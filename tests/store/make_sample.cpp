// make_sample FOLDER: writes a database of several sessions to FOLDER/lab.sqlite and exports it to
// FOLDER/csv, FOLDER/bids and FOLDER/signals.
#include <cstdio>

#include "station/store/annotate.hpp"
#include "station/store/export.hpp"
#include "tests/store/sample.hpp"

using namespace turnpoint::store;

int main(int argc, char** argv) {
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
