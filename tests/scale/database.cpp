#include "tests/scale/database.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "station/core/number.hpp"
#include "station/store/checksum.hpp"
#include "station/store/open.hpp"
#include "station/store/rows.hpp"
#include "station/store/seal.hpp"
#include "station/store/session_log.hpp"

using namespace turnpoint;
using namespace turnpoint::store;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kMidday_ns = 1'709'204'400 * kSecond_ns;  // 11:00 UTC on 29 February 2024

std::string content(const std::string& path) {
  std::ifstream file(std::string(TURNPOINT_SOURCE_DIR) + "/" + path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

SessionStart start_of(int session, const std::string& station) {
  static const auto protocol = content("protocols/demo.toml"), rig = content("deploy/rigs/simulated.toml");
  SessionStart start;
  start.participant = fmt::format("P{:05}", session / 4);
  start.run_mode = RunMode::simulated;
  start.observer = "sim";
  start.protocol_id = "demo";
  start.protocol_version = "1.0.0";
  start.protocol_path = "protocols/demo.toml";
  start.protocol_text = start.protocol_canonical = protocol;
  start.protocol_sha256 = core::sha256(protocol);
  start.factor_columns = {"offset_mm", "mark_mm"};
  start.level_unit = "mm";
  start.rig_name = "simulated";
  start.rig_path = "deploy/rigs/simulated.toml";
  start.rig_text = rig;
  start.rig_sha256 = core::sha256(rig);
  start.seed = static_cast<std::uint64_t>(session);
  start.language = "en";
  start.software_version = "scale";
  start.columns_version = "2";
  start.kernel = "Linux 6.1.0-18-amd64 #1 SMP PREEMPT_DYNAMIC Debian 6.1.76-1 (2024-02-01)";
  start.station_id = station;
  start.realtime_rights = "none";
  start.started_local = "2024-02-29T12:00:00+01:00";
  return start;
}

ToneRow tone_of(int trial, int index) {
  ToneRow tone;
  tone.tone_index = index;
  tone.scene = "edge";
  tone.boundary_mm = 150.25 + index;
  tone.frequency_Hz = 30123.4567890123 + trial;
  tone.amplitude_um = 0.75;
  tone.displacement_um = 1.0;
  tone.friction = 0.62;
  tone.rove_dB = 0.1 * (trial % 20);
  tone.model = "mode";
  tone.error_bound_mm = 0.1;
  tone.uncertainty_mm = 0.4;
  tone.reason = "cheapest inside the tolerance";
  tone.onset_frame = 192000LL * trial;
  tone.length_frames = 768000;
  return tone;
}

/// Makes a trial. Answers are more often right at higher levels, but some are wrong at every level.
TrialRow trial_of(int session, int trial) {
  TrialRow row;
  row.trial_index = row.trial_in_block = trial;
  row.procedure = "levels";
  const double level = 12.0 * (trial % 5 - 2);
  const bool right_side = (trial * 7 + session * 3) % 20 < (level > 0 ? 18 : level < 0 ? 2 : 10);
  row.level = level;
  row.factors = {{"offset_mm", level}, {"mark_mm", trial % 2 == 0 ? 150.0 : 160.0}};
  row.presented.boundary_mm = 150 + level;
  row.presented.frequency_Hz = 30123.4567890123 + trial;
  row.presented.amplitude = 2.5;
  row.given.response = right_side ? "right" : "left";
  if (level != 0) {
    row.correct_response = level > 0 ? "right" : "left";
    row.given.correct = row.given.response == row.correct_response;
  }
  row.timing.onset_ns = kSecond_ns * (5LL * trial + 3);
  row.timing.onset_s = 5.0 * trial + 2;
  row.timing.duration_s = 4;
  row.timing.response_time_s = 0.3 + 0.01 * ((trial * 13 + session) % 97);
  row.timing.response_zero = "go_cue";
  row.timing.response_time_quality = "simulated";
  row.timing.deadline_s = 6.0;
  row.timing.clock_slope_ns_per_frame = 5208.333;
  row.timing.clock_residual_ns = 42;
  row.learned.state_hash = 0xfedcba9876543210ULL + static_cast<unsigned>(trial);
  row.tones = {tone_of(trial, 0), tone_of(trial, 1)};
  return row;
}

/// Writes the rows of a session that begin() has created, in one transaction.
void fill(Database& database, const std::string& id, int session, int trials) {
  SealedTransaction transaction(database);
  RowWriter rows(database);
  Chain chain(database, id);
  const TrialPlace place{id, 1, 0, 0};
  std::int64_t event = 0;
  for (int i = 0; i < trials; ++i) {
    const std::int64_t at_ns = kSecond_ns * (5LL * i + 2);
    rows.event(place, event++, {at_ns, "presented", "", i, 1});
    chain.accept(chain.add());
    rows.trial(place, trial_of(session, i), kMidday_ns + at_ns);
    for (const auto* kind : {"stimulus", "go", "touch", "answer"}) {
      rows.event(place, event, {at_ns + event * 1'000'000, kind, "4", i, 1});
      ++event;
    }
    chain.accept(chain.add());
  }
  Statement(database, "UPDATE session SET status = 'completed' WHERE session_id = ?").bind(id).run();
  chain.accept(chain.add());
  transaction.commit();
}

}  // namespace

void make_database(const std::string& path, int sessions, int trials, const std::string& station) {
  for (int session = 0; session < sessions; ++session) {
    std::string id;
    {
      auto log = SessionLog::begin(path, start_of(session, station),
                                   {"boot", "start", kSecond_ns, kSecond_ns, kMidday_ns});
      log.begin_block({0, 0, "main", "", false});
      id = log.session().session_id;
    }
    Database database(path, Database::Access::read_write);
    database.execute("PRAGMA synchronous = OFF");
    fill(database, id, session, trials);
  }
}
