#include "station/store/checksum.hpp"

#include <bit>
#include <cstdint>

#include "station/text/number.hpp"

namespace turnpoint::store {

namespace {

/// Each value with its kind and length, so that no two different rows look the same.
void add_row(std::string& bytes, const Statement& row) {
  for (int i = 0; i < row.columns(); ++i) {
    const auto text = row.is_null(i)   ? std::string()
                      : row.is_real(i) ? std::to_string(std::bit_cast<std::int64_t>(row.real(i)))
                      : row.is_text(i) ? row.text(i)
                                       : std::to_string(row.integer(i));
    const char kind = row.is_null(i) ? 'n' : row.is_real(i) ? 'r' : row.is_text(i) ? 't' : 'i';
    bytes += kind;
    bytes += std::to_string(text.size());
    bytes += ':';
    bytes += text;
  }
  bytes += '\n';
}

}  // namespace

std::string session_checksum(Database& database, const std::string& schema, const std::string& session_id) {
  const struct {
    const char *table, *columns, *order;
  } parts[] = {
      {"session",
       "session_id, participant, protocol_key, rig_key, calibration_id, run_mode, session_index, "
       "sequence_index, seed,"
       " language, observer, factor_columns, level_unit, software_version, columns_version, kernel, "
       "station_id,"
       " realtime_rights, started_local, consent_version",
       "session_id"},
      {"segment", "*", "segment_index"},
      {"block", "*", "run_order"},
      {"trial",
       "segment_index, block_index, attempt, trial_index, trial_in_block, trial_type, procedure, level, "
       "factors,"
       " boundary_mm, frequency_Hz, amplitude, correct_response, response, correct, outcome, onset_ns, "
       "onset_s,"
       " duration_s, response_time_s, decision_time_s, movement_time_s, response_zero, response_time_quality,"
       " response_offset_s, deadline_s, xruns, extra_touches, threshold_est, threshold_sd, "
       "clock_slope_ns_per_frame,"
       " clock_residual_ns, state_hash, recorded_realtime_ns",
       "trial_index"},
      {"tone", "*", "trial_index, interval_index, scene_index, tone_index"},
      {"event", "*", "event_index"},
      {"annotation", "*", "annotation_id"},
  };
  std::string bytes;
  for (const auto& part : parts) {
    bytes += part.table;
    bytes += '\n';
    Statement rows(database, std::string("SELECT ") + part.columns + " FROM " + schema + "." + part.table +
                                 " WHERE session_id = ? ORDER BY " + part.order);
    rows.bind(session_id);
    while (rows.step()) add_row(bytes, rows);
  }
  return text::sha256(bytes);
}

}  // namespace turnpoint::store
