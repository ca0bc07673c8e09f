#include "station/store/field.hpp"

namespace turnpoint::store {

namespace {

/// This column is NULL if there is no response time, because no clock was read then.
Field<TrialRow> response_time_quality() {
  auto quality = field<&TrialRow::response_time_quality>({"response_time_quality", "response_time_quality",
                                                          "Clock that gave the time stamp of the answer", "",
                                                          "kernel | toolkit | simulated | n/a"});
  quality.nullable = true;
  quality.bind = [](Statement& s, int i, const TrialRow& row) {
    const auto& word = row.response_time_quality;
    if (!row.response_time_s || word.empty() || word == "n/a")
      s.bind_value(i, std::nullopt);
    else
      s.bind_value(i, word);
  };
  return quality;
}

/// Describes a column with a value that force sensors measured in a trial.
template <auto Member>
Field<TrialRow> finger(const About& about) {
  return field<&TrialRow::finger, Member>(about);
}

}  // namespace

const Table<TrialRow>& trial_table() {
  using T = TrialRow;
  using F = FingerRow;
  static const Table<T> table{
      "trial",
      {"session_id", "block_index", "attempt", "recorded_realtime_ns"},
      {field<&T::segment_index>({"segment_index", "segment_id",
                                 "Run of the program within the session, from 1; each time the session is "
                                 "resumed, another run begins"}),
       field<&T::trial_index>({"trial_index", "trial_index",
                               "Index of the trial among all trials presented in the session, from 0"}),
       field<&T::trial_in_block>({"trial_in_block"}),
       field<&T::type>({"trial_type", "trial_type",
                        "Type of the trial; only experimental trials are used by procedures and fits", "",
                        "experimental | catch | practice | warmup"}),
       field<&T::procedure>(
           {"procedure", "procedure", "Procedure that chose the level; n/a if no procedure did"}),
       field<&T::level>({"level", "level", "Stimulus level that was presented", "see level_unit"}),
       field<&T::factors>({"factors"}),
       field<&T::boundary_mm>(
           {"boundary_mm", "boundary_mm",
            "Position of the boundary presented last in the trial, measured from the wide end of the surface",
            "mm"}),
       field<&T::frequency_Hz>({"frequency_Hz", "frequency_hz",
                                "Frequency of the first tone of the scene presented last in the trial",
                                "Hz"}),
       field<&T::amplitude>({"amplitude", "amplitude",
                             "Predicted displacement of the surface at its last maximum, for the scene "
                             "presented last in the trial",
                             "um"}),
       field<&T::correct_response>(
           {"correct_response", "correct_response", "Correct choice; n/a if no choice is correct"}),
       field<&T::response>(
           {"response", "response",
            "Choice of the participant; in an adjustment task the setting, in the unit of the level; on a "
            "scale or with a number pad the number that was given"}),
       field<&T::correct>({"correct", "correct",
                           "1 if the choice was correct, 0 if not; n/a if the answer is not scored", "",
                           "0 | 1 | n/a"}),
       field<&T::outcome>(
           {"outcome", "outcome",
            "How the trial ended; only answered trials have a response, a score and a response time", "",
            "answered | timeout | anticipation | aborted | fault"}),
       field<&T::onset_ns>({"onset_ns"}),
       field<&T::onset_s>({"onset_s", "response_zero_onset",
                           "Time from which the response time counts, measured from the start of the segment",
                           "s"}),
       field<&T::duration_s>({"duration_s", "trial_duration", "Duration of the whole trial", "s"}),
       field<&T::response_time_s>({"response_time_s", "response_time",
                                   "Time from response_zero to the answer, without corrections", "s"}),
       field<&T::decision_time_s>({"decision_time_s", "decision_time",
                                   "Time from response_zero to the moment when the finger leaves the surface",
                                   "s"}),
       field<&T::movement_time_s>({"movement_time_s", "movement_time",
                                   "Time from when the finger leaves the surface to the answer", "s"}),
       field<&T::response_zero>({"response_zero", "response_zero",
                                 "Event from which response times are measured", "",
                                 "go_cue | change | interval_off | first_contact | lift_off"}),
       response_time_quality(),
       field<&T::response_offset_s>(
           {"response_offset_s", "response_offset_s",
            "Latency measured by the calibration; it is not subtracted from response_time", "s"}),
       field<&T::deadline_s>({"deadline_s", "deadline",
                              "Longest time allowed for the answer, measured from response_zero", "s"}),
       field<&T::xruns>({"xruns", "xruns", "Number of interruptions of the drive signal during the trial"}),
       field<&T::extra_touches>(
           {"extra_touches", "extra_touches", "Number of touches and button presses that were not answers"}),
       field<&T::threshold_est>({"threshold_est", "threshold_est",
                                 "Threshold estimated by the trial's procedure after this trial",
                                 "see level_unit"}),
       field<&T::threshold_sd>(
           {"threshold_sd", "threshold_sd", "Standard deviation of threshold_est", "see level_unit"}),
       field<&T::clock_slope_ns_per_frame>({"clock_slope_ns_per_frame"}),
       field<&T::clock_residual_ns>({"clock_residual_ns"}),
       field<&T::state_hash>({"state_hash"}),
       field<&T::proof>({"proof", "proof", "What the pick-up on the surface says about the trial's stimuli",
                         "", "unproven | ok | flagged | refused | stopped | lost"}),
       field<&T::proof_cause>({"proof_cause", "proof_cause",
                               "Why the stimuli are not proven to be as planned", "",
                               "gap | clipped | dead | frequency | half | late | phase | level | "
                               "residual | noisy | n/a"}),
       field<&T::drive_ratio_dB>(
           {"drive_ratio_dB", "drive_ratio_db",
            "Measured over planned amplitude of the vibration, of the tone that differs most", "dB"}),
       field<&T::drive_residual_dB>({"drive_residual_dB", "drive_residual_db",
                                     "Vibration that was not planned, relative to the plan", "dB"}),
       field<&T::onset_error_us>({"onset_error_us", "onset_error_us",
                                  "Measured minus planned onset of the stimulus; of several, the largest",
                                  "us"}),
       field<&T::confidence>({"confidence", "confidence",
                              "How sure the participant was of the answer, from 1 (least) up; n/a "
                              "if the task does not ask"}),
       field<&T::confidence_time_s>({"confidence_time_s", "confidence_time",
                                     "Time from the answer to the participant's statement of confidence",
                                     "s"}),
       finger<&F::sensing>(
           {"sensing", "sensing",
            "Whether the touch met the requirements of the protocol's [sensing]: ok, or too few "
            "strokes, too light, too hard, too slow, too fast. If that is not known: lost (samples "
            "were lost), wire (fault of a cell's wire), tare (no valid tare); n/a without force sensors",
            "", "ok | strokes | light | hard | slow | fast | lost | wire | tare | n/a"}),
       finger<&F::contact_s>(
           {"contact_s", "contact_s", "Time during which a finger touched the surface", "s"}),
       finger<&F::strokes>({"strokes", "strokes", "Number of strokes along the surface"}),
       finger<&F::normal_N>({"normal_N", "normal_n", "Mean normal force during the strokes", "N"}),
       finger<&F::normal_sd_N>(
           {"normal_sd_N", "normal_sd_n", "Standard deviation of the normal force during the strokes", "N"}),
       finger<&F::normal_in_window>(
           {"normal_in_window", "normal_in_window",
            "Fraction of the strokes' time with a normal force that the protocol asks for"}),
       finger<&F::speed_mm_s>(
           {"speed_mm_s", "speed_mm_s", "Mean speed of the finger during the strokes", "mm/s"}),
       finger<&F::speed_in_window>({"speed_in_window", "speed_in_window",
                                    "Fraction of the strokes' time with a speed that the protocol asks for"}),
       finger<&F::mu_low>({"mu_low", "mu_low",
                           "Measured coefficient of friction on the smooth side of the felt boundary, in the "
                           "scene presented last"}),
       finger<&F::mu_high>({"mu_high", "mu_high",
                            "Measured coefficient of friction on the rough side of the felt boundary, in the "
                            "scene presented last"}),
       finger<&F::boundary_felt_mm>({"boundary_felt_mm", "boundary_felt_mm",
                                     "Measured position at which friction crosses the planned edge's level "
                                     "(for other edges: half-way up the step), in the scene presented "
                                     "last, from the wide end of the surface",
                                     "mm"}),
       finger<&F::boundary_se_mm>(
           {"boundary_se_mm", "boundary_se_mm", "Standard error of boundary_felt_mm", "mm"}),
       finger<&F::lag_mm>(
           {"lag_mm", "lag_mm",
            "Distance by which the skin lags behind the finger: half the difference between the "
            "positions of the felt step in the two directions of stroking",
            "mm"}),
       finger<&F::tare_mN>(
           {"tare_mN", "tare_mn", "Change of the force sensors' zero since the previous trial", "mN"}),
       field<&T::finger, &F::mu>(
           {"mu", "mu",
            "Measured coefficient of friction over all strokes during the interval presented last; "
            "in a block that measures a friction table, over its part of the surface"}),
       field<&T::silence_dB>({"silence_dB", "silence_db",
                              "Level of the pick-up in the silence before the first stimulus (rms of "
                              "the loudest 50 ms), relative to the planned vibration",
                              "dB"}),
       field<&T::silence_tone_dB>(
           {"silence_tone_dB", "silence_tone_db",
            "Level of the strongest tone in this silence, relative to the planned vibration; n/a if "
            "no tone stands out of the noise",
            "dB"})}};
  return table;
}

const Table<ToneRow>& tone_table() {
  using T = ToneRow;
  static const Table<T> table{
      "tone",
      {"session_id", "trial_index"},
      {field<&T::interval_index>(
           {"interval_index", "interval_index", "Number of the interval in the order presented, from 0"}),
       field<&T::scene_index>(
           {"scene_index", "scene_index", "Number of the scene within the interval, from 0"}),
       field<&T::tone_index>({"tone_index", "tone_index", "Number of the tone within the scene, from 0"}),
       field<&T::scene>({"scene", "scene", "Name of the scene in the protocol"}),
       field<&T::boundary_mm>({"boundary_mm", "boundary_mm",
                               "Position of the scene's boundary, measured from the wide end of the surface",
                               "mm"}),
       field<&T::frequency_Hz>({"frequency_Hz", "frequency_hz", "Frequency of the tone", "Hz"}),
       field<&T::amplitude_um>({"amplitude_um", "amplitude_um",
                                "Peak displacement of the tone at the driven edge of the surface", "um"}),
       field<&T::displacement_um>(
           {"displacement_um", "displacement_um", "Predicted displacement at the tone's last maximum", "um"}),
       field<&T::friction>(
           {"friction", "friction", "Predicted friction of the scene, relative to the still surface"}),
       field<&T::rove_dB>(
           {"rove_dB", "rove_db", "Random change of level (roving) added to this interval", "dB"}),
       field<&T::model>({"model", "model", "Physical model with which the tone was planned"}),
       field<&T::error_bound_mm>({"error_bound_mm", "error_bound_mm",
                                  "Bound of the model's error in the position of the boundary", "mm"}),
       field<&T::uncertainty_mm>({"uncertainty_mm", "uncertainty_mm",
                                  "Uncertainty of the boundary's position that the rig's parameters cause",
                                  "mm"}),
       field<&T::reason>({"reason", "reason", "Why this model was chosen"}),
       field<&T::onset_frame>({"onset_frame", "onset_frame",
                               "Output frame at which the tone starts, counted from the start of the segment",
                               "frames"}),
       field<&T::length_frames>(
           {"length_frames", "length_frames", "Length of the tone, including both ramps", "frames"}),
       field<&T::measured_dB>(
           {"measured_dB", "measured_db",
            "Amplitude of the tone at the pick-up, relative to the plan; n/a if not measured", "dB"}),
       field<&T::measured_phase_deg>({"measured_phase_deg", "measured_phase_deg",
                                      "Phase of the tone at the pick-up, relative to the calibration",
                                      "deg"})}};
  return table;
}

const Table<SignalRow>& signal_table() {
  using S = SignalRow;
  static const Table<S> table{
      "signal",
      {"session_id", "trial_index"},
      {field<&S::stream>({"stream"}), field<&S::start_frame>({"start_frame"}),
       field<&S::start_s>({"start_s"}), field<&S::rate_Hz>({"rate_Hz"}), field<&S::points>({"points"}),
       field<&S::channels>({"channels"}), field<&S::encoding>({"encoding"}), field<&S::data>({"data"})}};
  return table;
}

}  // namespace turnpoint::store
