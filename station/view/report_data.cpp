#include "station/view/report_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/protocol/protocol.hpp"
#include "station/protocol/tasks.hpp"
#include "station/report/stored_estimates.hpp"
#include "station/report/stored_trials.hpp"
#include "station/session/planned_session.hpp"
#include "station/store/open.hpp"
#include "station/store/signal_code.hpp"
#include "station/store/stored_signals.hpp"

namespace turnpoint::view {

namespace {

using core::Phrase, core::phrase, core::plain;

Phrase whole(std::integral auto number) { return plain(number); }

/// Adds a part to a list, after a separator if there are others already.
void append(Phrase& list, Phrase part, const char* separator = ", ") {
  if (!list.values.empty()) list.values.push_back(plain(separator));
  list.values.push_back(std::move(part));
}
Phrase or_none(Phrase list) { return list.values.empty() ? phrase("station.none") : list; }
Phrase or_none(const std::string& text) { return text.empty() ? phrase("station.none") : plain(text); }

/// Says by how many frames in total the participant's screen was late, according to the events in the log.
Phrase late_frames(const std::vector<core::EventRow>& events) {
  int frames = 0, trials = 0;
  for (const auto& event : events)
    if (event.kind == "frames_lost") frames += std::stoi(event.value), ++trials;
  return frames == 0 ? phrase("station.none") : phrase("station.in_trials", {whole(frames), whole(trials)});
}

/// Says how many flashes were shown, and how long after their time; empty if there were none.
std::optional<Phrase> flashes(const std::vector<core::EventRow>& events) {
  std::vector<double> delays_s;
  std::optional<double> light_s;
  int late = 0;
  for (const auto& event : events) {
    const auto seconds = core::read_number(event.value);
    if (event.kind == core::kDisplayLatencyEvent) light_s = seconds;
    if (event.kind != core::kSignalShownEvent && event.kind != core::kSignalLateEvent) continue;
    late += event.kind == core::kSignalLateEvent ? 1 : 0;
    delays_s.push_back(seconds.value_or(0));
  }
  if (delays_s.empty()) return std::nullopt;
  std::sort(delays_s.begin(), delays_s.end());
  const auto ms = [](double s) { return plain(core::number(1e3 * s, 3)); };
  Phrase list;
  append(list, phrase("station.flashes_shown", {whole(delays_s.size()), ms(delays_s[delays_s.size() / 2]),
                                                ms(delays_s.back()), whole(late), ms(core::kSignalLate_s)}));
  append(list,
         light_s ? phrase("station.flash_light", {ms(*light_s)}) : phrase("station.flash_light_unknown"),
         "; ");
  return list;
}

/// Describes the largest model error and the largest uncertainty of the boundaries of the tones that were
/// presented.
std::string boundary_errors(const std::vector<store::BlockRecord>& blocks) {
  double bound_mm = 0, uncertainty_mm = 0, level_dB = 0;
  for (const auto& block : blocks)
    for (const auto& row : block.trials)
      for (const auto& tone : row.tones) {
        bound_mm = std::max(bound_mm, tone.error_bound_mm);
        uncertainty_mm = std::max(uncertainty_mm, tone.uncertainty_mm);
        level_dB = std::max(level_dB, tone.level_uncertainty_dB.value_or(0));
      }
  return "model at most " + core::number(bound_mm, 2) + " mm; uncertain parameters of the rig " +
         (uncertainty_mm > 0 ? core::number(uncertainty_mm, 3) + " mm (SD)" : std::string("not known")) +
         (level_dB > 0 ? ", of the level at the last maximum " + core::number(level_dB, 2) + " dB (SD)" : "");
}

/// The numbers of trials by the words that the database has for them, such as "57 ok, 2 wire".
Phrase counted(const std::map<std::string, int>& counts) {
  Phrase list;
  for (const auto& [word, count] : counts) append(list, plain(std::to_string(count) + " " + word));
  return or_none(std::move(list));
}

/// Says how many trials the pick-ups have proven, and why others are flagged: "57 ok, 2 flagged (level)".
Phrase proofs(const std::vector<store::BlockRecord>& blocks) {
  std::map<core::Proof, int> counts;
  std::map<core::Proof, std::map<std::string, int>> causes;
  for (const auto& block : blocks)
    for (const auto& row : block.trials) {
      ++counts[row.surface.proof];
      if (row.surface.proof_cause != core::ProofCause::none)
        ++causes[row.surface.proof][name(row.surface.proof_cause)];
    }
  std::string text;
  for (const auto& [proof, count] : counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + name(proof);
    std::string why;
    for (const auto& [cause, times] : causes[proof])
      why += (why.empty() ? "" : ", ") + cause + (times > 1 ? " " + std::to_string(times) : "");
    if (!why.empty()) text += " (" + why + ")";
  }
  return or_none(text);
}

/// Says in how many trials the forces are known, and why they are not known in others, such as "57 ok, 2
/// wire" for a broken wire.
Phrase forces(const std::vector<store::BlockRecord>& blocks) {
  std::map<std::string, int> counts;
  for (const auto& block : blocks)
    for (const auto& row : block.trials)
      if (!row.finger.sensing.empty()) ++counts[row.finger.sensing];
  return counted(counts);
}

/// Says how many trigger codes were sent, how many of them were read back or missed, and how many were
/// captured without having been sent.
Phrase triggers(const std::vector<core::EventRow>& events) {
  int sent = 0, heard = 0, missed = 0, extra = 0;
  for (const auto& event : events) {
    if (event.kind == "trigger_missed") ++missed;
    if (event.kind == "trigger_extra") ++extra;
    if (event.kind != "trigger") continue;
    ++sent;
    if (event.value.find("read back") != std::string::npos) ++heard;
  }
  if (sent + missed + extra == 0) return phrase("station.none");
  if (heard + missed + extra == 0) return phrase("station.sent", {whole(sent)});
  return phrase("station.sent_and_read", {whole(sent), whole(heard), whole(missed), whole(extra)});
}

/// Describes the result of the newest self-test: which checks failed, and how many were not possible.
Phrase self_test(const std::vector<core::EventRow>& events) {
  const core::EventRow* newest = nullptr;
  for (const auto& event : events)
    if (event.kind == "self_test") newest = &event;
  if (newest == nullptr) return phrase("station.none");
  auto text = newest->value;
  int absent = 0;
  for (const auto& check : newest->checks) {
    if (check.verdict == core::Verdict::failed) text += "; " + check.name + ": " + check.what;
    if (check.verdict == core::Verdict::not_possible) ++absent;
  }
  // What a failed check has found is stored in English.
  const auto result = text == "passed" ? phrase("station.passed") : plain(text);
  return phrase("station.checks", {result, whole(newest->checks.size()), whole(absent)});
}

/// Lists what was stated before the session about room, surface and finger.
Phrase conditions(const core::Conditions& stated) {
  Phrase list;
  if (stated.humidity_percent)
    append(list, phrase("station.humidity", {plain(core::number(*stated.humidity_percent, 3))}));
  if (stated.room_temperature_C) append(list, plain(core::number(*stated.room_temperature_C, 3) + " °C"));
  if (stated.surface_cleaned)
    append(list, phrase(*stated.surface_cleaned ? "station.cleaned" : "station.not_cleaned"));
  if (!stated.finger.empty()) append(list, phrase("station.finger", {plain(stated.finger)}));
  if (stated.skin_moisture)
    append(list, phrase("station.moisture", {plain(core::number(*stated.skin_moisture, 4))}));
  return list.values.empty() ? phrase("station.not_stated") : list;
}

std::vector<report::MeasuredTrial> measured_trials(const std::vector<store::BlockRecord>& blocks) {
  std::vector<report::MeasuredTrial> trials;
  for (const auto& block : blocks)
    for (const auto& row : block.trials)
      if (row.surface.drive_ratio_dB)
        trials.push_back({row.trial_index, *row.surface.drive_ratio_dB,
                          row.surface.proof != core::Proof::refused &&
                              row.surface.proof != core::Proof::stopped &&
                              row.surface.proof != core::Proof::lost});
  return trials;
}

void add_health(const store::StoredSession& stored, report::SessionData& data) {
  int xruns = 0, extra = 0, trials = 0;
  std::map<std::string, int> quality;
  double offset_s = 0;
  for (const auto& block : stored.blocks)
    for (const auto& row : block.trials) {
      ++trials;
      xruns += row.presented.xruns;
      extra += row.given.extra_touches;
      if (row.timing.response_time_s) ++quality[row.timing.response_time_quality];
      // answers by button have an offset of 0, so the largest offset is that of touch answers, if there are
      // any
      offset_s = std::max(offset_s, row.timing.response_offset_s);
    }
  Phrase qualities;
  for (const auto& [name, count] : quality)
    append(qualities, plain(name + " (" + std::to_string(count) + ")"));
  int attempts = 0;
  for (const auto& block : stored.blocks) attempts += block.start.attempt > 0;
  const auto& start = stored.session.start;
  const auto add = [&data](const char* name, Phrase text) {
    data.health.emplace_back(phrase(name), std::move(text));
  };
  add("station.trials", whole(trials));
  add("station.vibration", proofs(stored.blocks));
  add("station.forces", forces(stored.blocks));
  add("operator.self_test", self_test(stored.events));
  add("station.conditions", conditions(start.conditions));
  add("station.triggers", triggers(stored.events));
  add("station.xruns", whole(xruns));
  add("live.other_touches", whole(extra));
  add("station.late_frames", late_frames(stored.events));
  if (auto shown = flashes(stored.events)) add("station.flashes", std::move(*shown));
  add("station.resumed", whole(stored.session.segments - 1));
  add("station.restarted", whole(attempts));
  add("station.stamped", or_none(std::move(qualities)));
  add("station.offset", plain(core::number(offset_s, 4) + " s"));
  add("operator.calibration", or_none(start.calibration_id.value_or("")));
  add("station.rights", plain(start.realtime_rights));
  add("station.kernel", plain(start.kernel));
  add("station.place", phrase(stored.session.leased_place ? "station.leased" : "station.given",
                              {plain(core::number(stored.session.sequence_index, 6))}));
  add("station.planned", start.planned_session ? whole(*start.planned_session) : phrase("station.none"));
  add("station.group", or_none(start.group));
  add("station.checksum", or_none(stored.session.checksum));
  add("station.software", plain(start.software_version));
}

/// Adds friction along the strip, from the stored signals of those trials that the report's section on the
/// finger uses.
void add_strip(const std::string& path, const store::StoredSession& stored, report::SessionData& data) {
  if (data.finger.empty()) return;
  std::map<int, const core::TrialRow*> rows;
  for (const auto& block : stored.blocks)
    for (const auto& row : block.trials) rows[row.trial_index] = &row;
  std::map<int, bool> counts;
  for (const auto& trial : data.finger) counts[trial.trial_index] = true;
  const auto rate_Hz = store::playback_rate_Hz(stored.session.start);
  if (!rate_Hz) return;
  session::AlongStrip along;
  auto database = store::open_reader(path);
  store::SignalReader signals(database, stored.session.session_id, "finger");
  while (const auto signal = signals.next())
    if (counts.contains(signal->trial_index)) along.add(*rows.at(signal->trial_index), signal->row, *rate_Hz);
  data.strip = curves_of(along);
}

/// The updates of a scene that follows the finger, as the signal kFollowStream has them.
class Updates {
 public:
  explicit Updates(const core::SignalRow& signal, double frames_per_s)
      : values_(store::decode(signal)),
        first_frame_(static_cast<double>(signal.start_frame)),
        frames_per_point_(frames_per_s / signal.rate_Hz),
        points_per_ms_(1e-3 * signal.rate_Hz) {
    for (std::size_t c = 0; c < signal.channels.size(); ++c) channels_[signal.channels[c].name] = c;
    has_friction_ = std::ranges::any_of(
        signal.channels, [](const auto& channel) { return channel.name == "asked" && channel.unit.empty(); });
  }

  /// False if the scenes ask for a displacement.
  bool has_friction() const { return has_friction_; }

  /// The points between two frames at which the finger slid and the surface followed it. What was asked is
  /// that of the time at which the friction was measured.
  std::vector<analysis::FollowedPoint> between(std::int64_t first_frame, std::int64_t end_frame) const {
    std::vector<analysis::FollowedPoint> points;
    const auto count = at("felt").size();
    double last_measured = -1;
    for (std::size_t k = 0; k < count; ++k) {
      const double felt = at("felt")[k];
      const double measured = static_cast<double>(k) - points_per_ms_ * at("age")[k];
      const double frame = first_frame_ + frames_per_point_ * measured;
      if (!std::isfinite(felt) || !(measured > last_measured + 0.5) ||
          frame < static_cast<double>(first_frame) || frame >= static_cast<double>(end_frame))
        continue;
      const auto before = static_cast<std::size_t>(measured);
      if (!followed(before) || !followed(before + 1)) continue;
      last_measured = measured;
      const double along = measured - static_cast<double>(before);
      const auto value = [&](const char* channel) {
        return (1 - along) * at(channel)[before] + along * at(channel)[before + 1];
      };
      analysis::FollowedPoint point{value("place"), value("speed") > 0, value("asked"), value("commanded"),
                                    felt};
      if (std::isfinite(point.place_mm) && point.asked > 0 && std::isfinite(point.commanded))
        points.push_back(point);
    }
    return points;
  }

 private:
  const std::vector<double>& at(const char* channel) const { return values_.at(channels_.at(channel)); }
  bool followed(std::size_t k) const {
    return k < at("fault").size() && at("fault")[k] == 0 && at("following")[k] >= 1;
  }

  std::vector<std::vector<double>> values_;
  std::map<std::string, std::size_t> channels_;
  double first_frame_, frames_per_point_, points_per_ms_;
  bool has_friction_ = false;
};

/// Makes the mean of what was commanded that of what was felt.
void scale_commanded(std::vector<analysis::FollowedPoint>& points) {
  double commanded = 0, felt = 0;
  for (const auto& point : points) commanded += point.commanded, felt += point.felt;
  if (!(commanded > 0)) return;
  for (auto& point : points) point.asked *= felt / commanded, point.commanded *= felt / commanded;
}

/// Adds friction over place, from the stored updates of the trials whose scenes follow the finger.
void add_followed_places(const std::string& path, const store::StoredSession& stored,
                         const protocol::Protocol& protocol, report::SessionData& data) {
  const auto rate_Hz = store::playback_rate_Hz(stored.session.start);
  if (data.followed.empty() || !rate_Hz) return;
  std::map<int, const core::TrialRow*> rows;
  for (const auto& block : stored.blocks)
    for (const auto& row : block.trials) rows[row.trial_index] = &row;
  std::map<int, std::string> conditions;
  for (const auto& trial : data.followed) conditions[trial.trial_index] = trial.condition;
  std::vector<analysis::FollowedPath> paths;
  auto database = store::open_reader(path);
  store::SignalReader signals(database, stored.session.session_id, core::kFollowStream);
  while (const auto signal = signals.next()) {
    const auto found = conditions.find(signal->trial_index);
    if (found == conditions.end()) continue;
    const Updates updates(signal->row, *rate_Hz);
    if (!updates.has_friction()) continue;
    int interval = -1;
    for (const auto& tone : rows.at(signal->trial_index)->tones) {
      const auto scene = protocol.scenes.find(tone.scene);
      if (tone.interval_index == interval || scene == protocol.scenes.end() || !scene->second.follow)
        continue;
      interval = tone.interval_index;
      auto points = updates.between(tone.onset_frame, tone.onset_frame + tone.length_frames);
      const auto& follow = *scene->second.follow;
      if (!follow.resting_friction && follow.unit != scene::FollowUnit::coefficient) scale_commanded(points);
      paths.push_back({found->second, tone.scene, std::move(points)});
    }
  }
  data.followed_places = analysis::friction_over_place(paths);
}

}  // namespace

std::vector<analysis::FrictionCurve> curves_of(const session::AlongStrip& along) {
  std::vector<analysis::FrictionCurve> curves;
  for (const int direction : {1, -1}) {
    auto curve = along.curve(direction);
    if (curve.friction.empty()) continue;
    curves.push_back({direction > 0 ? "towards the narrow end" : "towards the wide end",
                      std::move(curve.from_boundary_mm), std::move(curve.friction), std::move(curve.se),
                      direction > 0});
  }
  return curves;
}

/// Adds the separate programs that took part, each version once.
void add_programs(const std::vector<core::EventRow>& events, report::SessionData& data) {
  std::set<std::string> told;
  for (const auto& event : events)
    for (const auto& program : event.programs) {
      auto fact = fmt::format("{} {}, SHA-256 {}", program.program, program.version, program.sha256);
      const auto name =
          program.procedure.empty() ? "Program of the observer" : "Program of " + program.procedure;
      if (told.insert(name + fact).second) data.facts.emplace_back(name, std::move(fact));
    }
}

void add_own_estimates(const std::string& database, const store::StoredSession& stored,
                       const protocol::Protocol& protocol, report::SessionData& data) {
  procedure::EarlierTrials earlier;
  try {
    earlier = session::earlier_trials(database, protocol, stored.session);
  } catch (const std::runtime_error&) {
    // The earlier sessions cannot be repeated by this program. The report then has no estimates of procedures
    // that continue.
  }
  report::add_estimates(stored.blocks, protocol, stored.session.start.seed, earlier, data);
  report::add_program_estimates(stored.blocks, stored.events, protocol, data);
}

namespace {

/// The data of one of the session's tasks. `stored` has all trials, `own` those of the task.
report::SessionData data_of_task(const std::string& database, const store::StoredSession& stored,
                                 const store::StoredSession& own, const protocol::Protocol& protocol,
                                 std::size_t task) {
  const auto& start = stored.session.start;
  report::SessionData data;
  data.title = protocol.title;
  data.participant = stored.session.person;
  data.session_id = stored.session.session_id;
  data.run_mode = store::name(start.run_mode);
  data.status = store::name(stored.session.status);
  data.facts = {{"Protocol", start.protocol_id + " " + start.protocol_version},
                {"Protocol SHA-256", start.protocol_sha256},
                {"Started", start.started_local},
                {"Rig", start.rig_name},
                {"Station", start.station_id},
                {"Seed", std::to_string(start.seed)},
                {"Error of the boundaries", boundary_errors(stored.blocks)}};
  for (const auto& note : stored.session.annotations) data.facts.emplace_back("Note", note);
  for (const auto* event : core::standing_answers(stored.events))
    for (const auto& answer : event->answers)
      data.facts.emplace_back(
          answer.questionnaire + ": " + answer.item +
              (answer.occasion > 0 ? " (after block " + std::to_string(answer.occasion) + ")" : ""),
          answer.answer);
  data.seed = start.seed;
  report::add_trials(own.blocks, protocol::of_task(protocol, task), data);
  add_own_estimates(database, stored, protocol, data);
  report::keep_estimates_of(protocol::of_task(protocol, task), data);
  add_programs(stored.events, data);
  add_health(stored, data);
  data.measured = measured_trials(own.blocks);
  add_strip(database, own, data);
  add_followed_places(database, own, protocol::of_task(protocol, task), data);
  return data;
}

}  // namespace

std::vector<report::SessionData> report_data(const std::string& database, const std::string& session_id) {
  const auto stored = store::read_session(database, session_id);
  const auto& start = stored.session.start;
  const auto protocol = protocol::parse(start.protocol_text, start.protocol_path);
  std::vector<report::SessionData> all;
  for (std::size_t task = 0; task < protocol::tasks_of(protocol).size(); ++task) {
    auto own = stored;
    own.blocks = report::of_task(std::move(own.blocks), protocol, task);
    all.push_back(data_of_task(database, stored, own, protocol, task));
  }
  return all;
}

std::optional<protocol::Protocol> newest_protocol(const std::string& path, const std::string& protocol_id,
                                                  core::RunMode mode, const std::set<std::string>& stations) {
  auto database = store::open_reader(path);
  auto sessions = store::list_sessions(database, {"", "", protocol_id});
  std::erase_if(sessions, [&](const auto& session) {
    return session.start.run_mode != mode ||
           (!stations.empty() && stations.count(session.start.station_id) == 0);
  });
  const auto newest = std::ranges::max_element(sessions, {}, [](const auto& session) {
    return std::pair(session.last_activity_realtime_ns, session.session_id);
  });
  if (newest == sessions.end()) return std::nullopt;
  const auto start = store::session_record(database, newest->session_id).start;
  return protocol::parse(start.protocol_text, start.protocol_path);
}

std::string session_to_report(const std::string& database, const store::SessionFilter& filter) {
  const store::SessionRecord* newest = nullptr;
  const auto sessions = store::list_sessions(database, filter);
  for (const auto& session : sessions)
    if (session.trials > 0 && (!newest || session.last_trial_id > newest->last_trial_id)) newest = &session;
  if (!newest)
    throw store::StoreError(store::ErrorKind::missing,
                            database + ": there is no session with trials to report");
  return newest->session_id;
}

}  // namespace turnpoint::view
