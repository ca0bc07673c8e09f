#include "station/session/rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <tuple>

#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/sensing/felt_step.hpp"
#include "station/store/signal_code.hpp"

namespace turnpoint::session {

namespace {

/// What is known of the silence before an interval.
std::string silence_before(const sensing::IntervalResult& measured) {
  if (!measured.silence || measured.silence->verdict == core::Proof::unproven) return "";
  if (measured.silence->verdict == core::Proof::lost) return "; silence before it not measured";
  return fmt::format("; silence before it: tone {:.0f} dB, all {:.0f} dB", measured.silence->level_dB,
                     measured.silence->rms_dB);
}

/// Writes into the row what the log says of an input: its kind and its value.
struct Log {
  core::EventRow& row;

  void say(const char* kind, std::string value) const {
    row.kind = kind;
    row.value = value.empty() ? "0" : std::move(value);
  }

  void operator()(const input::Answer& answer) const { say("answer", std::to_string(answer.index)); }
  void operator()(const input::Value& value) const { say("value", core::exact(value.number)); }
  void operator()(const input::Next&) const { say("next", ""); }
  void operator()(const input::Back&) const { say("back", ""); }
  void operator()(const input::Again&) const { say("again", ""); }
  void operator()(const input::Slider& slider) const { say("slider", core::exact(slider.value)); }
  void operator()(const input::Touch&) const { say("touch", ""); }
  void operator()(const input::Button& button) const { say("button", std::to_string(button.index)); }
  void operator()(const input::Contact& contact) const {
    const std::string on = contact.on ? "1" : "0";
    say("contact", contact.position ? on + " " + core::number(*contact.position, 4) : on);
  }
  void operator()(const input::Stop& stop) const { say("stop", stop.by); }
  void operator()(const input::Pause&) const { say("pause", ""); }
  void operator()(const input::Xrun& xrun) const { say("xrun", xrun.what); }
  void operator()(const input::Heard& heard) const { say("heard", std::to_string(heard.interval)); }
  void operator()(const input::Measured& measured) const {
    const auto& result = *measured.result;
    say("measured", fmt::format("{} {} {}{}", measured.interval, name(result.verdict), name(result.cause),
                                silence_before(result)));
  }
  void operator()(const input::Fault& fault) const {
    say("fault",
        fault.detail.empty() ? name(fault.kind) : fmt::format("{}: {}", name(fault.kind), fault.detail));
  }
  void operator()(const input::Failure& failure) const { say("failure", failure.what); }
  void operator()(const input::Glitch& glitch) const { say("glitch", glitch.what); }
  void operator()(const input::Sync& sync) const {
    say("sync", sync.frame ? fmt::format("frame {}", *sync.frame) : "");
  }
  void operator()(const input::Notice& notice) const { say("notice", notice.what); }
  void operator()(const input::Arm& arm) const { say("arm", arm.result); }
  void operator()(const input::Disarm& disarm) const { say("disarm", disarm.result); }
  void operator()(const input::Repeat&) const { say("repeat", ""); }
  void operator()(const input::Note& note) const { say("note", note.text); }
  void operator()(const input::FramesLost& lost) const { say("frames_lost", std::to_string(lost.frames)); }
  void operator()(const input::SignalShown& shown) const {
    say(shown.late_s > core::kSignalLate_s ? core::kSignalLateEvent : core::kSignalShownEvent,
        core::number(shown.late_s, 4));
  }
};

/// The part and the scene to which a group of tones belongs, the start and length of that scene, and the
/// interval of the part.
struct Placed {
  int part = 0, scene = 0;
  std::int64_t onset_frame = 0, length_frames = 0;
  int interval = 0;
};

void add_scene(core::TrialRow& row, const scene::DrivePlan& plan, const Placed& placed) {
  for (std::size_t t = 0; t < plan.tones.size(); ++t) {
    core::ToneRow tone;
    tone.interval_index = placed.part;
    tone.of_interval = placed.interval;
    tone.scene_index = placed.scene;
    tone.tone_index = static_cast<int>(t);
    tone.scene = plan.scene.name;
    if (plan.boundary_m) tone.boundary_mm = 1e3 * *plan.boundary_m;
    tone.frequency_Hz = plan.tones[t].frequency_Hz;
    tone.amplitude_um = 1e6 * plan.tones[t].amplitude_m;
    tone.displacement_um = 1e6 * plan.tones[t].displacement_m;
    tone.friction = plan.zone_friction ? plan.zone_friction : std::optional(plan.lowest_friction);
    tone.rove_dB = plan.scene.rove_dB;
    tone.model = physics::name(plan.model);
    tone.error_bound_mm = 1e3 * plan.error_bound_m;
    tone.uncertainty_mm = 1e3 * plan.uncertainty_m;
    tone.level_uncertainty_dB = plan.tones[t].level_sd_dB;
    tone.reason = plan.reason;
    tone.onset_frame = placed.onset_frame;
    tone.length_frames = placed.length_frames;
    row.tones.push_back(std::move(tone));
  }
}

void take_last(core::TrialRow& row, const scene::DrivePlan& last) {
  row.presented.boundary_mm = last.boundary_m ? std::optional(1e3 * *last.boundary_m) : std::nullopt;
  if (last.tones.empty()) return;
  row.presented.frequency_Hz = last.tones.front().frequency_Hz;
  row.presented.amplitude = 1e6 * last.tones.front().displacement_m;
}

}  // namespace

void add_tones(core::TrialRow& row, const std::vector<scene::DrivePlan>& scenes, int part, int interval,
               std::int64_t onset_frame, const audio::PreparedBurst& burst) {
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const auto start = s == 0 ? 0 : burst.changes[s - 1].at_frame;
    const auto end = s + 1 < scenes.size() ? burst.changes[s].at_frame : burst.length_frames;
    add_scene(row, scenes[s], {part, static_cast<int>(s), onset_frame + start, end - start, interval});
  }
  take_last(row, scenes.back());
}

void set_scene(core::TrialRow& row, const scene::DrivePlan& scene, int interval, std::int64_t frame) {
  std::int64_t end = 0;
  for (const auto& tone : row.tones) end = std::max(end, tone.onset_frame + tone.length_frames);
  const int of_interval = row.tones.empty() ? 0 : row.tones.back().of_interval;
  const auto here = [interval](const auto& tone) { return tone.interval_index == interval; };
  std::erase_if(row.tones, [&](const auto& tone) { return here(tone) && tone.scene_index == 1; });
  for (auto& tone : row.tones)
    if (here(tone)) tone.length_frames = std::min(tone.length_frames, frame - tone.onset_frame);
  add_scene(row, scene, {interval, 1, frame, end - frame, of_interval});
  take_last(row, scene);
}

namespace {

/// The scene of an interval to which a stretch belongs. An adjustment goes through many settings, of which
/// the row has only the first and the last: scenes 0 and 1. Returns -1 for the others.
int scene_of(const sensing::IntervalResult& measured, int stretch) {
  if (measured.live_changes == 0 || stretch == 0) return stretch;
  return stretch == measured.live_changes ? 1 : -1;
}

}  // namespace

void add_measured(core::TrialRow& row, const sensing::IntervalResult& measured, int interval, bool first) {
  auto& surface = row.surface;
  for (const auto& tone : measured.tones)
    for (auto& planned : row.tones) {
      if (!tone.seen || planned.interval_index != interval ||
          planned.scene_index != scene_of(measured, tone.stretch) || planned.tone_index != tone.tone)
        continue;
      planned.measured_dB = tone.ratio_dB;
      planned.measured_phase_deg = tone.phase_error_deg;
    }
  const auto further = [](std::optional<double>& worst, double value) {
    if (!worst || std::abs(value) > std::abs(*worst)) worst = value;
  };
  for (const auto& tone : measured.tones)
    if (tone.seen) further(surface.drive_ratio_dB, tone.ratio_dB);
  for (const auto& tone : measured.glides)
    if (tone.seen) further(surface.drive_ratio_dB, tone.worst_ratio_dB);
  if (measured.onset_error_us) further(surface.onset_error_us, *measured.onset_error_us);
  if (!measured.tones.empty() && !measured.envelope_error_dB)
    surface.drive_residual_dB = std::max(surface.drive_residual_dB.value_or(-1e9), measured.residual_dB);
  if (const auto& silence = measured.silence; silence && silence->rms_dB > sensing::kNothing_dB) {
    surface.silence_dB = silence->rms_dB;
    if (silence->level_dB > sensing::kNothing_dB) surface.silence_tone_dB = silence->level_dB;
  }
  if (measured.envelope_error_dB)
    row.follow.envelope_error_dB =
        std::max(row.follow.envelope_error_dB.value_or(-1e9), *measured.envelope_error_dB);
  if (measured.envelope_lag_us) further(row.follow.envelope_lag_us, *measured.envelope_lag_us);
  const sensing::Finding now{measured.cause, measured.verdict};
  const auto all = first ? now : sensing::concluded({{surface.proof_cause, surface.proof}, now});
  surface.proof = all.verdict;
  surface.proof_cause = all.cause;
}

sensing::MovementWindow window_of(const protocol::Sensing& sensing) {
  sensing::MovementWindow window;
  if (sensing.normal_N) std::tie(window.least_normal_N, window.most_normal_N) = *sensing.normal_N;
  if (sensing.speed_mm_s) std::tie(window.least_speed_mm_s, window.most_speed_mm_s) = *sensing.speed_mm_s;
  window.fraction = sensing.fraction;
  window.strokes = sensing.strokes;
  return window;
}

std::optional<double> friction_level(const scene::Scene& scene) {
  const bool at_level = scene.boundary_m && scene.edge.kind == physics::Edge::Kind::friction;
  return at_level ? std::optional(scene.edge.level) : std::nullopt;
}

sensing::StripPart part_of(const trial::TrialSpec& spec) {
  if (!spec.strokes || spec.strokes->levels_um.empty()) return {};
  return {spec.strokes->from_mm, spec.strokes->to_mm};
}

void add_forces(core::TrialRow& row, const sensing::TrialForces& forces, const Asked& asked, int rate_Hz,
                const FrameTime& at) {
  const auto known = [](double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; };
  auto& finger = row.finger;
  const bool known_forces = forces.state == sensing::ForcesState::ok;
  finger.sensing = known_forces ? sensing::name(forces.movement) : sensing::name(forces.state);
  if (known_forces) {
    const auto& summary = forces.summary;
    finger.contact_s = summary.contact_s;
    finger.strokes = summary.strokes;
    finger.normal_N = known(summary.normal_N);
    finger.normal_sd_N = known(summary.normal_sd_N);
    finger.normal_in_window = known(summary.normal_in_window);
    finger.speed_mm_s = known(summary.speed_mm_s);
    finger.speed_in_window = known(summary.speed_in_window);
    finger.mu = known(sensing::mean_friction(forces.track, forces.strokes, asked.part));
    if (const auto step = sensing::felt_step(forces.profile, asked.friction_level)) {
      finger.mu_low = std::min(step->friction_below, step->friction_above);
      finger.mu_high = std::max(step->friction_below, step->friction_above);
      finger.boundary_felt_mm = step->boundary_mm;
      finger.boundary_se_mm = step->se_mm;
      finger.lag_mm = step->lag_mm;
    }
  }
  finger.tare_mN = 1e3 * forces.tare_moved_N;
  if (forces.track.empty()) return;
  core::SignalRow signal;
  signal.stream = kFingerStream;
  signal.start_frame = forces.track.front().index * forces.frames_per_point;
  signal.start_s = at.time_s + static_cast<double>(signal.start_frame - at.frame) / rate_Hz;
  signal.rate_Hz = static_cast<double>(rate_Hz) / static_cast<double>(forces.frames_per_point);
  signal.channels = {
      {"normal", "N", 1e-4}, {"lateral", "N", 1e-4}, {"position", "mm", 0.01}, {"speed", "mm/s", 0.1}};
  std::vector<std::vector<double>> values(signal.channels.size());
  for (const auto& point : forces.track) {
    values[0].push_back(point.normal_N);
    values[1].push_back(point.lateral_N);
    values[2].push_back(point.position_mm);
    values[3].push_back(point.speed_mm_s);
  }
  store::encode(signal, values);
  row.signal_rows.push_back(std::move(signal));
}

namespace {

/// Makes a signal whose points are `step` frames apart, with missing values where nothing was recorded.
class FollowSignal {
 public:
  FollowSignal(const char* stream, std::vector<core::SignalChannel> channels, std::int64_t start_frame,
               std::int64_t step, std::size_t points)
      : step_(step), values_(channels.size(), std::vector<double>(points, std::nan(""))) {
    signal_.stream = stream;
    signal_.start_frame = start_frame;
    signal_.channels = std::move(channels);
  }

  void set(std::size_t channel, std::int64_t frame, double value) {
    values_[channel][static_cast<std::size_t>((frame - signal_.start_frame) / step_)] = value;
  }
  core::SignalRow made(int rate_Hz, const FrameTime& at) {
    signal_.rate_Hz = static_cast<double>(rate_Hz) / static_cast<double>(step_);
    signal_.start_s = at.time_s + static_cast<double>(signal_.start_frame - at.frame) / rate_Hz;
    store::encode(signal_, values_);
    return std::move(signal_);
  }

 private:
  core::SignalRow signal_;
  std::int64_t step_;
  std::vector<std::vector<double>> values_;
};

void add_signals(core::TrialRow& row, const std::vector<follow::Recorded>& periods, const follow::Plan& plan,
                 int rate_Hz, const FrameTime& at) {
  const std::int64_t period = plan.timing.period_frames, eighth = period / follow::kGains;
  const auto first = periods.front().frame;
  const auto count = static_cast<std::size_t>((periods.back().frame - first) / period + 1);
  const bool friction = plan.pattern.asked == follow::Asked::friction;
  // The values of an update are those of the middle of its period.
  FollowSignal updates(core::kFollowStream,
                       {{"place", "mm", 0.01},
                        {"speed", "mm/s", 0.1},
                        {"asked", friction ? "" : "um", 1e-4},
                        {"commanded", "", 1e-4},
                        {"felt", "", 1e-4},
                        {"age", "ms", 1e-3},
                        {"at_rest", "", 1e-4},
                        {"following", "", 1e-3},
                        {"fault", "", 1}},
                       first + period / 2, period, count);
  FollowSignal envelope(core::kEnvelopeStream, {{"gain", "", 1e-5}}, first + eighth, eighth,
                        count * follow::kGains);
  for (const auto& one : periods) {
    const auto& u = one.update;
    const auto middle = one.frame + period / 2;
    // Intervals need not be whole periods apart; in the later ones a point is less than a period early.
    const bool placed = u.fault != follow::Fault::lifted && u.fault != follow::Fault::position;
    const double none = std::nan("");
    const double age_ms = 1e3 * static_cast<double>(middle - one.sample_frame) / rate_Hz;
    const std::array values{placed ? 1e3 * u.place_m : none,
                            placed ? 1e3 * u.speed_m_s : none,
                            placed ? (friction ? u.asked : 1e6 * u.asked) : none,
                            placed ? u.modelled : none,
                            u.felt,
                            age_ms,
                            u.resting_friction,
                            static_cast<double>(u.following),
                            static_cast<double>(u.fault)};
    for (std::size_t c = 0; c < values.size(); ++c) updates.set(c, middle, values[c]);
    for (std::size_t k = 0; k < follow::kGains; ++k)
      envelope.set(0, one.frame + static_cast<std::int64_t>(k + 1) * eighth, static_cast<double>(u.gain[k]));
  }
  row.signal_rows.push_back(updates.made(rate_Hz, at));
  row.signal_rows.push_back(envelope.made(rate_Hz, at));
}

/// The names of faults of two presentations, each once; "ok" and "" are none.
std::string both(const std::string& earlier, const std::string& later) {
  std::string names;
  std::istringstream words(earlier + " " + later);
  for (std::string word; words >> word;)
    if (word != "ok" && (" " + names + " ").find(" " + word + " ") == std::string::npos)
      names += (names.empty() ? "" : " ") + word;
  return names.empty() ? "ok" : names;
}

}  // namespace

void add_followed(core::TrialRow& row, const Followed& followed, const FollowPlans& plans,
                  const std::vector<FollowedRange>& ranges, int rate_Hz, const FrameTime& at) {
  const auto last =
      std::find_if(plans.rbegin(), plans.rend(), [](const auto& plan) { return plan != nullptr; });
  if (last == plans.rend()) return;
  auto names = follow::fault_names(followed.periods, !followed.late.empty());
  if (followed.not_recorded > 0) names += " unrecorded";
  core::FollowRow found;
  found.followed = both(row.follow.followed, names);
  found.envelope_error_dB = row.follow.envelope_error_dB;
  found.envelope_lag_us = row.follow.envelope_lag_us;
  row.follow = found;
  std::erase_if(row.signal_rows, [](const auto& signal) {
    return signal.stream == core::kFollowStream || signal.stream == core::kEnvelopeStream;
  });
  if (followed.periods.empty()) return;
  const auto interval = static_cast<std::size_t>(plans.rend() - last - 1);
  std::vector<follow::Recorded> of_last;
  for (const auto& one : followed.periods)
    if (one.interval == static_cast<std::int32_t>(interval)) of_last.push_back(one);
  if (interval < ranges.size()) {
    const auto summary = follow::summarise(of_last, **last, ranges[interval].first_frame,
                                           std::min(ranges[interval].end_frame, followed.cut_frame));
    row.follow.mu_asked = summary.asked;
    row.follow.mu_commanded = summary.commanded;
    row.follow.mu_felt = summary.felt;
    row.follow.inside = summary.inside;
    row.follow.share = summary.share;
    if (summary.lag_s) row.follow.lag_ms = 1e3 * *summary.lag_s;
  }
  add_signals(row, followed.periods, **last, rate_Hz, at);
}

std::string describe_proof(const core::SurfaceRow& surface) {
  std::string text = core::describe(surface.proof_cause);
  if (surface.drive_ratio_dB) text += fmt::format("; level {:+.1f} dB", *surface.drive_ratio_dB);
  if (surface.drive_residual_dB) text += fmt::format("; residual {:.0f} dB", *surface.drive_residual_dB);
  if (surface.onset_error_us) text += fmt::format("; onset {:+.0f} us", *surface.onset_error_us);
  return text;
}

core::EventRow event_row(const Input& input, int trial_index) {
  core::EventRow row;
  row.time_ns = input.time_ns;
  row.trial_index = trial_index;
  std::visit(Log{row}, input.content);
  return row;
}

}  // namespace turnpoint::session
