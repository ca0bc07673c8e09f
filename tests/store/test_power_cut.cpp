#include <random>

#include "station/store/read.hpp"
#include "tests/store/kept_signals.hpp"
#include "tests/store/lossy_disk.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

namespace {

struct Cut {
  std::string folder;
  int acknowledged = 0;
};

struct Toll {
  int cuts = 0, lost = 0, damaged = 0, wrong_signals = 0;
};

/// Writes one session of many trials and makes power cuts at random operations, in every phase of commits and
/// checkpoints.
std::vector<Cut> cut_at_random(const TemporaryFolder& folder, LossyDisk& disk, int trials) {
  const auto db = folder / "a.sqlite";
  std::vector<Cut> cuts;
  int acknowledged = 0;
  std::mt19937 random(11);
  auto log = SessionLog::begin(db, sample::start(), sample::segment());
  log.begin_block(sample::block());
  disk.at_each_operation([&] {
    if (std::uniform_int_distribution<>(0, 15)(random) != 0) return;
    cuts.push_back({folder / ("cut" + std::to_string(cuts.size())), acknowledged});
    std::filesystem::create_directory(cuts.back().folder);
    disk.cut(db, cuts.back().folder, cuts.size());
  });
  for (; acknowledged < trials; ++acknowledged) {
    log.presented(acknowledged, 1);
    log.append(sample::answered(acknowledged));
  }
  disk.at_each_operation(nullptr);
  return cuts;
}

Toll count(const std::vector<Cut>& cuts) {
  Toll toll;
  for (const auto& cut : cuts) {
    ++toll.cuts;
    try {
      auto raw = sample::raw(cut.folder + "/a.sqlite");
      const auto trials = raw.integer("SELECT count(*) FROM trial");
      if (raw.text("PRAGMA integrity_check") != "ok") ++toll.damaged;
      toll.wrong_signals += sample::wrong_signals(raw, cut.acknowledged);
      if (trials < cut.acknowledged) toll.lost += cut.acknowledged - static_cast<int>(trials);
    } catch (const std::exception&) {  // also what a reader says of signals that are no JSON any more
      ++toll.damaged;
    }
  }
  return toll;
}

}  // namespace

TEST_CASE(
    "a power cut at any operation of a commit or checkpoint loses no acknowledged trial and no sample of one",
    "[store]") {
  TemporaryFolder folder;
  LossyDisk disk(LossyDisk::Syncs::kept);
  const auto toll = count(cut_at_random(folder, disk, 250));
  CHECK(toll.cuts > 100);
  CHECK(toll.lost == 0);
  CHECK(toll.damaged == 0);
  CHECK(toll.wrong_signals == 0);
}

TEST_CASE("negative control: a trial without its signal, or with that of another trial, is noticed",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto log = SessionLog::begin(db, sample::start(), sample::segment());
  log.begin_block(sample::block());
  for (int i = 0; i < 4; ++i) {
    auto trial = sample::answered(i);
    if (i == 1) trial.signal_rows.clear();
    if (i == 2) trial.signal_rows = {sample::finger_signal(3)};
    if (i == 3) trial.signal_rows[0].start_frame += 1;
    log.append(trial);
  }
  auto raw = sample::raw(db);
  CHECK(sample::wrong_signals(raw, 1) == 0);
  CHECK(sample::wrong_signals(raw, 5) == 4);
}

TEST_CASE("negative control: on a disk that ignores syncs, trials are lost or the file is damaged",
          "[store]") {
  TemporaryFolder folder;
  LossyDisk disk(LossyDisk::Syncs::ignored);
  const auto toll = count(cut_at_random(folder, disk, 100));
  CHECK(toll.lost + toll.damaged > 0);
}

TEST_CASE("a session can be continued after a power cut", "[store]") {
  TemporaryFolder folder;
  std::vector<Cut> cuts;
  {
    LossyDisk disk(LossyDisk::Syncs::kept);
    cuts = cut_at_random(folder, disk, 60);
  }
  int resumed = 0;
  for (const auto& cut : cuts) {
    const auto db = cut.folder + "/a.sqlite";
    const auto interrupted = interrupted_session(db);
    if (!interrupted) continue;
    auto log = SessionLog::resume(db, interrupted->session.session_id, sample::segment("resume"));
    const int trials = log.session().trials;
    REQUIRE(trials >= cut.acknowledged);
    const auto blocks = read_session(db, interrupted->session.session_id).blocks;
    REQUIRE(blocks[0].trials.size() == static_cast<std::size_t>(trials));
    log.begin_block(sample::block());
    log.append(sample::answered(trials));
    log.finish(SessionStatus::completed, "");
    ++resumed;
  }
  CHECK(resumed > 10);
}
