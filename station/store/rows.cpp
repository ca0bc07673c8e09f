#include "station/store/rows.hpp"

#include <bit>
#include <nlohmann/json.hpp>

#include "station/store/names.hpp"

namespace turnpoint::store {

namespace {

using nlohmann::json;

std::string placeholders(int count) {
  std::string list = "(?";
  for (int i = 1; i < count; ++i) list += ",?";
  return list + ")";
}

const char* const kTrialColumns =
    "session_id, segment_index, block_index, attempt, trial_index, trial_in_block, trial_type, procedure, "
    "level,"
    " factors, boundary_mm, frequency_Hz, amplitude, correct_response, response, correct, outcome, onset_ns, "
    "onset_s,"
    " duration_s, response_time_s, decision_time_s, movement_time_s, response_zero, response_time_quality,"
    " response_offset_s, deadline_s, xruns, extra_touches, threshold_est, threshold_sd, "
    "clock_slope_ns_per_frame,"
    " clock_residual_ns, state_hash, recorded_realtime_ns";

const char* const kToneColumns =
    "session_id, trial_index, interval_index, scene_index, tone_index, scene, boundary_mm, frequency_Hz,"
    " amplitude_um, displacement_um, friction, rove_dB, model, error_bound_mm, uncertainty_mm, reason, "
    "onset_frame,"
    " length_frames";

/// The quality of a time that is not there is not there either.
std::optional<std::string> quality(const TrialRow& row) {
  const auto& word = row.response_time_quality;
  return !row.response_time_s || word.empty() || word == "n/a" ? std::nullopt : std::optional(word);
}

TrialRow trial_from(const Statement& s) {
  TrialRow row;
  row.segment_index = static_cast<int>(s.integer(1));
  row.trial_index = static_cast<int>(s.integer(4));
  row.trial_in_block = static_cast<int>(s.integer(5));
  row.type = trial_type_named(s.text(6));
  row.procedure = s.text(7);
  row.level = s.maybe_real(8);
  row.factors = factors_from_json(s.text(9));
  row.boundary_mm = s.maybe_real(10);
  row.frequency_Hz = s.maybe_real(11);
  row.amplitude = s.maybe_real(12);
  row.correct_response = s.maybe_text(13);
  row.response = s.maybe_text(14);
  if (const auto correct = s.maybe_integer(15)) row.correct = *correct != 0;
  row.outcome = trial_outcome_named(s.text(16));
  row.onset_ns = s.integer(17);
  row.onset_s = s.real(18);
  row.duration_s = s.real(19);
  row.response_time_s = s.maybe_real(20);
  row.decision_time_s = s.maybe_real(21);
  row.movement_time_s = s.maybe_real(22);
  row.response_zero = s.text(23);
  row.response_time_quality = s.text(24);
  row.response_offset_s = s.real(25);
  row.deadline_s = s.maybe_real(26);
  row.xruns = static_cast<int>(s.integer(27));
  row.extra_touches = static_cast<int>(s.integer(28));
  row.threshold_est = s.maybe_real(29);
  row.threshold_sd = s.maybe_real(30);
  row.clock_slope_ns_per_frame = s.maybe_real(31);
  row.clock_residual_ns = s.maybe_real(32);
  row.state_hash = std::bit_cast<std::uint64_t>(s.integer(33));
  return row;
}

ToneRow tone_from(const Statement& s) {
  ToneRow tone;
  tone.interval_index = static_cast<int>(s.integer(2));
  tone.scene_index = static_cast<int>(s.integer(3));
  tone.tone_index = static_cast<int>(s.integer(4));
  tone.scene = s.text(5);
  tone.boundary_mm = s.maybe_real(6);
  tone.frequency_Hz = s.real(7);
  tone.amplitude_um = s.real(8);
  tone.displacement_um = s.maybe_real(9);
  tone.friction = s.maybe_real(10);
  tone.rove_dB = s.real(11);
  tone.model = s.text(12);
  tone.error_bound_mm = s.real(13);
  tone.uncertainty_mm = s.real(14);
  tone.reason = s.text(15);
  tone.onset_frame = s.integer(16);
  tone.length_frames = s.integer(17);
  return tone;
}

}  // namespace

RowWriter::RowWriter(Database& database)
    : trial_(database, std::string("INSERT INTO trial (") + kTrialColumns + ") VALUES " + placeholders(35)),
      tone_(database, std::string("INSERT INTO tone (") + kToneColumns + ") VALUES " + placeholders(18)),
      event_(database,
             "INSERT INTO event (session_id, event_index, segment_index, time_ns, kind, value, trial_index)"
             " VALUES (?,?,?,?,?,?,?)") {}

void RowWriter::trial(const TrialPlace& at, const TrialRow& row, std::int64_t recorded_realtime_ns) {
  trial_
      .bind(at.session_id, at.segment_index, at.block_index, at.attempt, row.trial_index, row.trial_in_block,
            name(row.type), row.procedure, row.level, factors_json(row.factors), row.boundary_mm,
            row.frequency_Hz, row.amplitude, row.correct_response, row.response, row.correct,
            name(row.outcome), row.onset_ns, row.onset_s, row.duration_s, row.response_time_s,
            row.decision_time_s, row.movement_time_s, row.response_zero, quality(row), row.response_offset_s,
            row.deadline_s, row.xruns, row.extra_touches, row.threshold_est, row.threshold_sd,
            row.clock_slope_ns_per_frame, row.clock_residual_ns, std::bit_cast<std::int64_t>(row.state_hash),
            recorded_realtime_ns)
      .run();
  for (const auto& one : row.tones) tone(at.session_id, row.trial_index, one);
}

void RowWriter::tone(const std::string& session_id, int trial_index, const ToneRow& row) {
  tone_
      .bind(session_id, trial_index, row.interval_index, row.scene_index, row.tone_index, row.scene,
            row.boundary_mm, row.frequency_Hz, row.amplitude_um, row.displacement_um, row.friction,
            row.rove_dB, row.model, row.error_bound_mm, row.uncertainty_mm, row.reason, row.onset_frame,
            row.length_frames)
      .run();
}

void RowWriter::event(const TrialPlace& at, std::int64_t event_index, const EventRow& row) {
  event_.bind(at.session_id, event_index, at.segment_index, row.time_ns, row.kind, row.value, row.trial_index)
      .run();
}

std::map<std::pair<int, int>, std::vector<TrialRow>> read_trials(Database& database,
                                                                 const std::string& session_id) {
  std::map<std::pair<int, int>, std::vector<TrialRow>> blocks;
  Statement tones(database,
                  std::string("SELECT ") + kToneColumns +
                      " FROM tone WHERE session_id = ? ORDER BY trial_index, interval_index, scene_index,"
                      " tone_index");
  Statement trials(database, std::string("SELECT ") + kTrialColumns +
                                 " FROM trial WHERE session_id = ? ORDER BY trial_index");
  tones.bind(session_id);
  trials.bind(session_id);
  bool tone_waits = tones.step();
  while (trials.step()) {
    auto row = trial_from(trials);
    for (; tone_waits && tones.integer(1) == row.trial_index; tone_waits = tones.step())
      row.tones.push_back(tone_from(tones));
    const std::pair key{static_cast<int>(trials.integer(2)), static_cast<int>(trials.integer(3))};
    blocks[key].push_back(std::move(row));
  }
  return blocks;
}

std::string factors_json(const std::map<std::string, FactorValue>& factors) {
  json object = json::object();
  for (const auto& [key, value] : factors) std::visit([&, &k = key](const auto& v) { object[k] = v; }, value);
  return object.dump();
}

std::map<std::string, FactorValue> factors_from_json(const std::string& text) {
  std::map<std::string, FactorValue> factors;
  const auto object = json::parse(text);
  for (const auto& [key, value] : object.items())
    factors[key] =
        value.is_string() ? FactorValue(value.get<std::string>()) : FactorValue(value.get<double>());
  return factors;
}

std::string list_json(const std::vector<std::string>& list) { return json(list).dump(); }

std::vector<std::string> list_from_json(const std::string& text) {
  return json::parse(text).get<std::vector<std::string>>();
}

}  // namespace turnpoint::store
