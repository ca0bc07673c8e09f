#include "tests/benchmark/durable_trial.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>

#include "station/store/fields.hpp"
#include "station/store/rows.hpp"
#include "station/store/session_log.hpp"
#include "station/store/sqlite.hpp"
#include "station/system/uuid.hpp"

namespace turnpoint::benchmark {

using namespace store;

namespace {

constexpr int kEvents = 4;  // number of touches and answers in a usual trial

SessionStart bench_session() {
  SessionStart start;
  start.participant = "bench";
  start.station_id = "bench";
  start.run_mode = RunMode::simulated;
  start.observer = "bench";
  start.protocol_id = "bench";
  start.factor_columns = {"contrast"};
  return start;
}

/// A two-interval trial with three tones in each interval.
TrialRow bench_trial(int index) {
  TrialRow row;
  row.trial_index = row.trial_in_block = index;
  row.procedure = "staircase";
  row.level = -12.5;
  row.factors = {{"contrast", 0.125}};
  row.presented.boundary_mm = 150.0;
  row.presented.frequency_Hz = 30123.4;
  row.presented.amplitude = 2.5;
  row.correct_response = row.given.response = "first";
  row.given.correct = true;
  row.timing.onset_ns = 1'000'000'000LL * index;
  row.timing.duration_s = 3.5;
  row.timing.response_time_s = 0.4375;
  row.timing.response_zero = "interval_off";
  row.timing.response_time_quality = "simulated";
  row.learned.state_hash = 0x0123456789abcdefULL;
  for (int i = 0; i < 6; ++i) {
    ToneRow tone;
    tone.interval_index = i / 3;
    tone.tone_index = i % 3;
    tone.scene = "reference";
    tone.frequency_Hz = 30000.0 + i;
    tone.amplitude_um = 0.75;
    tone.model = "mode";
    tone.reason = "cheapest inside the tolerance";
    row.tones.push_back(tone);
  }
  return row;
}

EventRow bench_event(int trial) { return {1, "touch", "0", trial, 1}; }

std::function<void(int)> through_the_log(const std::string& path) {
  auto log =
      std::make_shared<SessionLog>(SessionLog::begin(path, bench_session(), {"boot", "start", 0, 0, 0}));
  log->begin_block({0, 0, "main", "", false});
  return [log](int trial) {
    log->presented(trial, 1);
    for (int i = 0; i < kEvents; ++i) log->event(bench_event(trial));
    log->append(bench_trial(trial));
  };
}

/// Tables with the columns of the schema, but without triggers, checks and keys.
struct Bare {
  Bare(const std::string& path, const char* synchronous) : database(path, Database::Access::create) {
    database.execute(std::string("PRAGMA journal_mode = WAL; PRAGMA synchronous = ") + synchronous);
    create_bare(trial_table());
    create_bare(tone_table());
    create_bare(signal_table());
    create_bare(event_table());
    create_bare(check_table());
    create_bare(answer_table());
    create_bare(friction_level_table());
    create_bare(program_table());
    create_bare(estimate_table());
    rows = std::make_unique<RowWriter>(database);
    begin = std::make_unique<Statement>(database, "BEGIN IMMEDIATE");
    commit = std::make_unique<Statement>(database, "COMMIT");
  }

  template <class Record>
  void create_bare(const Table<Record>& table) {
    database.execute(std::string("CREATE TABLE ") + table.name + " (" + column_list(table) + ")");
  }

  void write(int trial) {
    begin->run();
    rows->event(place, next_event++, {1, "presented", "", trial, 1});
    commit->run();
    begin->run();
    rows->trial(place, bench_trial(trial), 1);
    for (int i = 0; i < kEvents; ++i) rows->event(place, next_event++, bench_event(trial));
    commit->run();
  }

  Database database;
  std::unique_ptr<RowWriter> rows;
  std::unique_ptr<Statement> begin, commit;
  TrialPlace place{system::new_uuid(), 1, 0, 0};
  std::int64_t next_event = 0;
};

std::function<void(int)> bare(const std::string& path, const char* synchronous) {
  return [writer = std::make_shared<Bare>(path, synchronous)](int trial) { writer->write(trial); };
}

double at_quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

/// A folder that is removed when this object is destroyed.
struct Folder {
  std::string path;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace

std::vector<DurableTrial> time_durable_trials(const std::string& directory, int trials) {
  if (trials < 1) throw std::invalid_argument("bench store: at least one trial");
  const Folder folder{directory + "/turnpoint-bench-" + system::new_uuid()};
  std::filesystem::create_directories(folder.path);
  std::vector<std::pair<std::string, std::function<void(int)>>> ways;
  ways.emplace_back("bare SQLite, FULL", bare(folder.path + "/bare.sqlite", "FULL"));
  ways.emplace_back("session log", through_the_log(folder.path + "/log.sqlite"));
  ways.emplace_back("bare SQLite, OFF (not durable)", bare(folder.path + "/off.sqlite", "OFF"));
  std::vector<std::vector<double>> times_ms(ways.size());
  // The methods take turns, so that other activity on the disk affects all of them equally.
  for (int trial = 0; trial < trials; ++trial)
    for (std::size_t way = 0; way < ways.size(); ++way) {
      const auto start = std::chrono::steady_clock::now();
      ways[way].second(trial);
      const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
      times_ms[way].push_back(took.count());
    }
  std::vector<DurableTrial> table;
  for (std::size_t way = 0; way < ways.size(); ++way)
    table.push_back(
        {ways[way].first, trials, at_quantile(times_ms[way], 0.5), at_quantile(times_ms[way], 0.99), 0});
  for (auto& row : table) row.ratio = row.median_ms / table.front().median_ms;
  return table;
}

}  // namespace turnpoint::benchmark
