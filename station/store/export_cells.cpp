#include "station/store/export_tables.hpp"

namespace turnpoint::store {

namespace {

Cell truth(const std::optional<bool>& value) { return value ? cell(*value ? 1 : 0) : Cell{}; }

/// Seeds use all 64 bits: written as digits, whatever their sign in the database.
Cell seed_cell(std::uint64_t seed) { return cell(std::to_string(seed)); }

Cell factor_cell(const TrialRow& trial, const std::string& factor) {
  const auto found = trial.factors.find(factor);
  if (found == trial.factors.end()) return {};
  return std::visit([](const auto& value) { return cell(value); }, found->second);
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const auto& text : texts) all += (all.empty() ? "" : "; ") + text;
  return all;
}

}  // namespace

std::vector<Cell> trial_cells(const SessionRecord& session, const BlockStart& block, const TrialRow& trial,
                              const std::vector<std::string>& factors) {
  const auto& start = session.start;
  std::vector<Cell> cells = {
      cell(start.participant),     cell(session.session_id), cell(session.session_index),
      cell(name(start.run_mode)),  cell(start.protocol_id),  cell(start.protocol_version),
      cell(start.protocol_sha256), cell(block.block_index),  cell(block.name),
      cell(block.instruction),     truth(block.practice),    cell(block.attempt),
      cell(trial.segment_index),   cell(trial.trial_index),  cell(name(trial.type)),
      cell(trial.procedure),       cell(trial.onset_s),      cell(trial.duration_s),
      cell(trial.level),           cell(start.level_unit)};
  for (const auto& factor : factors) cells.push_back(factor_cell(trial, factor));
  const std::vector<Cell> rest = {cell(trial.boundary_mm),
                                  cell(trial.frequency_Hz),
                                  cell(trial.amplitude),
                                  trial.tones.empty() ? Cell{} : cell(trial.tones.back().model),
                                  cell(trial.correct_response),
                                  cell(trial.response),
                                  truth(trial.correct),
                                  cell(name(trial.outcome)),
                                  cell(trial.response_time_s),
                                  cell(trial.decision_time_s),
                                  cell(trial.movement_time_s),
                                  cell(trial.response_zero),
                                  cell(trial.response_time_quality),
                                  cell(trial.response_offset_s),
                                  cell(trial.deadline_s),
                                  cell(trial.xruns),
                                  cell(trial.extra_touches),
                                  cell(trial.threshold_est),
                                  cell(trial.threshold_sd),
                                  seed_cell(start.seed),
                                  cell(start.station_id),
                                  cell(start.calibration_id),
                                  cell(start.software_version),
                                  cell(start.columns_version)};
  cells.insert(cells.end(), rest.begin(), rest.end());
  return cells;
}

std::vector<Cell> interval_cells(const SessionRecord& session, const BlockStart& block, const TrialRow& trial,
                                 const ToneRow& tone) {
  return {cell(session.start.participant),
          cell(session.session_id),
          cell(name(session.start.run_mode)),
          cell(block.block_index),
          cell(block.attempt),
          cell(trial.trial_index),
          cell(tone.interval_index),
          cell(tone.scene_index),
          cell(tone.tone_index),
          cell(tone.scene),
          cell(tone.boundary_mm),
          cell(tone.frequency_Hz),
          cell(tone.amplitude_um),
          cell(tone.displacement_um),
          cell(tone.friction),
          cell(tone.rove_dB),
          cell(tone.model),
          cell(tone.error_bound_mm),
          cell(tone.uncertainty_mm),
          cell(tone.reason),
          cell(tone.onset_frame),
          cell(tone.length_frames),
          cell(session.start.columns_version)};
}

std::vector<Cell> event_cells(const SessionRecord& session, const EventRow& event, std::int64_t origin_ns) {
  return {cell(session.start.participant),
          cell(session.session_id),
          cell(name(session.start.run_mode)),
          cell(event.segment_index),
          cell(static_cast<double>(event.time_ns - origin_ns) * 1e-9),
          cell(event.time_ns),
          cell(event.kind),
          cell(event.value),
          cell(event.trial_index),
          cell(session.start.columns_version)};
}

std::vector<Cell> session_cells(const SessionRecord& session) {
  const auto& start = session.start;
  return {cell(start.participant),      cell(session.session_id),    cell(session.session_index),
          cell(session.sequence_index), cell(name(start.run_mode)),  cell(name(session.status)),
          cell(session.status_reason),  cell(start.started_local),   cell(session.segments),
          cell(session.trials),         cell(start.protocol_id),     cell(start.protocol_version),
          cell(start.protocol_sha256),  cell(start.protocol_path),   cell(start.rig_name),
          cell(start.rig_sha256),       cell(start.rig_path),        cell(start.calibration_id),
          seed_cell(start.seed),        cell(start.language),        cell(start.observer),
          cell(start.software_version), cell(start.kernel),          cell(start.station_id),
          cell(start.realtime_rights),  cell(start.consent_version), cell(joined(session.annotations)),
          cell(start.columns_version)};
}

}  // namespace turnpoint::store
