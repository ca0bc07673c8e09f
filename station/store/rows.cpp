#include "station/store/rows.hpp"

#include "station/store/fields.hpp"

namespace turnpoint::store {

RowWriter::RowWriter(Database& database)
    : trial_(database, insert_sql(trial_table())),
      tone_(database, insert_sql(tone_table())),
      signal_(database, insert_sql(signal_table())),
      event_(database, insert_sql(event_table())),
      check_(database, insert_sql(check_table())),
      answer_(database, insert_sql(answer_table())),
      friction_(database, insert_sql(friction_level_table())),
      program_(database, insert_sql(program_table())),
      estimate_(database, insert_sql(estimate_table())) {}

void RowWriter::trial(const TrialPlace& at, TrialRow row, std::int64_t recorded_realtime_ns) {
  row.segment_index = at.segment_index;
  bind_row(trial_, trial_table(), row, at.session_id, at.block_index, at.attempt, recorded_realtime_ns).run();
  for (const auto& tone : row.tones)
    bind_row(tone_, tone_table(), tone, at.session_id, row.trial_index).run();
  for (const auto& signal : row.signal_rows)
    bind_row(signal_, signal_table(), signal, at.session_id, row.trial_index).run();
}

void RowWriter::event(const TrialPlace& at, std::int64_t event_index, EventRow row) {
  row.segment_index = at.segment_index;
  bind_row(event_, event_table(), row, at.session_id, event_index).run();
  std::int64_t check_index = 0;
  for (const auto& check : row.checks)
    bind_row(check_, check_table(), check, at.session_id, event_index, check_index++).run();
  std::int64_t answer_index = 0;
  for (const auto& answer : row.answers)
    bind_row(answer_, answer_table(), answer, at.session_id, event_index, answer_index++).run();
  std::int64_t level_index = 0;
  for (const auto& level : row.friction_levels)
    bind_row(friction_, friction_level_table(), level, at.session_id, event_index, level_index++).run();
  std::int64_t program_index = 0;
  for (const auto& program : row.programs)
    bind_row(program_, program_table(), program, at.session_id, event_index, program_index++).run();
  std::int64_t estimate_index = 0;
  for (const auto& estimate : row.estimates)
    bind_row(estimate_, estimate_table(), estimate, at.session_id, event_index, estimate_index++).run();
}

std::map<std::pair<int, int>, std::vector<TrialRow>> read_trials(Database& database,
                                                                 const std::string& session_id) {
  std::map<std::pair<int, int>, std::vector<TrialRow>> blocks;
  Statement tones(database, "SELECT " + column_list(tone_table()) +
                                " FROM tone WHERE session_id = ?"
                                " ORDER BY trial_index, interval_index, scene_index, tone_index");
  Statement trials(database, "SELECT " + column_list(trial_table()) +
                                 " FROM trial WHERE session_id = ? ORDER BY trial_index");
  tones.bind(session_id);
  trials.bind(session_id);
  bool tone_waits = tones.step();
  while (trials.step()) {
    auto row = record_of(trials, trial_table());
    for (; tone_waits && tones.integer(1) == row.trial_index; tone_waits = tones.step())
      row.tones.push_back(record_of(tones, tone_table()));
    const std::pair key{static_cast<int>(trials.integer(1)), static_cast<int>(trials.integer(2))};
    blocks[key].push_back(std::move(row));
  }
  return blocks;
}

}  // namespace turnpoint::store
