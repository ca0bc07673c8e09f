#include "station/session/session.hpp"

#include <fmt/format.h>
#include <sys/random.h>
#include <sys/utsname.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "station/core/canonical.hpp"
#include "station/core/limits.hpp"
#include "station/core/texts.hpp"
#include "station/protocol/visits.hpp"
#include "station/session/finger_account.hpp"
#include "station/session/planned_session.hpp"
#include "station/session/programs.hpp"
#include "station/session/replay.hpp"
#include "station/session/rows.hpp"
#include "station/session/session_run.hpp"
#include "station/session/simulated_room.hpp"
#include "station/session/stage.hpp"
#include "station/store/station.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::session {

namespace {

std::string boot_id() {
  std::string id;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> id;
  return id;
}

std::string kernel() {
  utsname names{};
  ::uname(&names);
  return fmt::format("{} {} {}", names.sysname, names.release, names.machine);
}

/// Draws a seed for a session whose protocol has none. It stays in the range that JSON and spreadsheets
/// represent exactly.
std::uint64_t fresh_seed() {
  std::uint64_t bits = 0;
  if (::getrandom(&bits, sizeof bits, 0) != static_cast<ssize_t>(sizeof bits))
    throw std::system_error(errno, std::generic_category(), "cannot get a random seed");
  return bits >> 11;
}

std::string level_unit(const protocol::Protocol& protocol) {
  std::optional<std::string> unit;
  for (const auto& spec : protocol.procedures) {
    const auto underscore = spec.level.rfind('_');
    const auto own = underscore == std::string::npos ? "1" : spec.level.substr(underscore + 1);
    if (unit && *unit != own) return "";  // procedures with levels in different units
    unit = own;
  }
  return unit.value_or("");
}

core::SessionStart start_of(const Setup& setup, std::uint64_t seed, const std::string& rights,
                            const std::optional<int>& planned_session) {
  core::SessionStart start;
  start.participant = setup.participant;
  start.run_mode = setup.run_mode;
  start.protocol_id = setup.protocol.id;
  start.protocol_version = setup.protocol.version;
  start.protocol_path = setup.protocol.path;
  start.protocol_text = setup.protocol.source;
  start.protocol_sha256 = setup.protocol.sha256;
  start.protocol_canonical = core::canonical(core::parse_toml(setup.protocol.source, setup.protocol.path));
  for (const auto& factor : setup.protocol.factors) start.factor_columns.push_back(factor.name);
  start.level_unit = level_unit(setup.protocol);
  start.rig_name = setup.rig.name;
  start.rig_path = setup.rig.path;
  start.rig_text = setup.rig.source;
  start.rig_sha256 = setup.rig.sha256;
  start.seed = seed;
  start.language = setup.language;
  start.observer = setup.observer;
  start.software_version = TURNPOINT_VERSION;
  start.columns_version = "1";
  start.kernel = kernel();
  start.station_id = store::station_name(setup.database);
  start.realtime_rights = rights;
  start.started_local = local_time();
  start.consent_version = setup.consent_version;
  start.conditions = setup.conditions;
  start.planned_session = planned_session;
  start.groups = protocol::group_names(setup.protocol);
  start.assignment = protocol::assignment(setup.protocol);
  if (!setup.calibration_id.empty()) start.calibration_id = setup.calibration_id;
  start.calibration_text = setup.calibration_text;
  return start;
}

/// Describes a new segment of the session. `now_ns` is read from the clock of the stage, which is virtual in
/// a simulated session.
core::SegmentStart segment(const std::string& reason, std::int64_t now_ns) {
  const auto clocks = system::read_clocks();
  return {boot_id(), reason, now_ns, clocks.boottime_ns, clocks.realtime_ns, store::machine_identity()};
}

}  // namespace

audio::StreamConfig stream_of(const rig::Rig& rig) {
  audio::StreamConfig config;
  config.output.uri = rig.output.uri;
  config.output.rate_Hz = rig.output.rate_Hz;
  config.output.channels = rig::channels(rig);
  config.output.device_channels = rig.output.device_channels;
  config.output.bits = rig.output.bits;
  config.output.period_frames = rig.output.period_frames;
  config.output.periods = rig.output.periods;
  config.output.allow_plugin = rig.output.allow_plugin;
  config.converter_delay_s = rig.output.converter_delay_s;
  return config;
}

audio::StreamConfig session_stream(const rig::Rig& rig) {
  auto config = stream_of(rig);
  if (rig.capture && !rig.capture->bridges.empty())
    config.carrier = {core::kForceCarrier_Hz, kCarrier, 0, *rig.capture->excitation_channel};
  return config;
}

bool simulates_capture(const rig::Rig& rig) { return rig.capture && rig.capture->uri == "sim:"; }

audio::StreamConfig simulated_stream(const rig::Rig& rig) {
  auto config = session_stream(rig);
  config.virtual_lead_frames = std::int64_t{config.output.periods} * config.output.period_frames;
  const bool hardware = config.output.uri.starts_with("alsa:") && config.output.allow_plugin.empty();
  if (hardware) config.output.uri = "null:";
  // If nothing reads the samples, do not compute them: half an hour has 300 million frames.
  if (config.output.uri == "null:" && !simulates_capture(rig)) config.samples = audio::Samples::passed;
  return config;
}

namespace {

/// Reads the participant's history of exposure. Call this before the log is opened for writing, because both
/// use the same database.
FingerAccount account_of(const Setup& setup, std::int64_t origin_ns) {
  const auto now = segment("", origin_ns);
  const double now_s = 1e-9 * static_cast<double>(now.realtime_ns);
  const auto limits = session::limits_of(setup.rig, setup.run_mode);
  const auto history = setup.observer.empty()
                           ? session::read_finger_history(setup.database, setup.participant, now,
                                                          session::longest_trial_s(limits))
                           : FingerHistory{{}, now_s};
  return FingerAccount(limits, history, origin_ns, now_s);
}

/// A session's log, and a director that has processed all trials in the log.
struct Begun {
  store::SessionLog log;
  trial::Director director;
  Earlier earlier;
};

Begun begin(const Setup& setup, Stage& stage, Programs& programs) {
  const auto next = next_session(setup);
  if (next.too_early) throw TooEarly({{}, next.problem, next.allowed}, *next.too_early);
  if (!next.problem.empty())
    throw core::Refusal(core::Phrase{"", "", {next.problem, core::plain("; "), next.allowed}});
  auto earlier = earlier_trials(setup, next);
  // With one seed for all participants, the planned sessions still have different orders.
  const auto stated =
      setup.protocol.seed
          ? std::optional(*setup.protocol.seed + static_cast<std::uint64_t>(next.number.value_or(1)) - 1)
          : std::nullopt;
  const auto seed = setup.seed ? *setup.seed : stated ? *stated : fresh_seed();
  auto log =
      store::SessionLog::begin(setup.database, start_of(setup, seed, stage.realtime_rights(), next.number),
                               segment("start", stage.now_ns()));
  if (!next.overruled.empty()) log.annotate("begun early (" + setup.early + "): " + next.overruled);
  trial::Director director(setup.protocol, visit_of(log.session()), seed, &programs, std::move(earlier));
  return {std::move(log), std::move(director), {}};
}

/// Replays the stored trials first and writes afterwards, so that a session that cannot be resumed stays
/// unchanged.
Begun resume(const Setup& setup, Stage& stage, Programs& programs) {
  auto stored = store::read_session(setup.database, setup.resume_session);
  auto director = replayed(setup, stored, programs);
  auto log =
      store::SessionLog::resume(setup.database, setup.resume_session, segment("resume", stage.now_ns()));
  for (const auto& program : programs.started()) {
    const auto* before = as_recorded(program, stored.events);
    if (before != nullptr && before->sha256 != program.sha256)
      log.annotate(
          fmt::format("program {} has changed since the session was interrupted: version {} (SHA-256 {}) "
                      "was replaced by {} ({}); it repeated all stored trials alike",
                      program.path, before->version, before->sha256, program.version, program.sha256));
  }
  if (log.session().trials != stored.session.trials)
    throw core::Failure(core::phrase("resume.grown", {core::plain(setup.resume_session)}));
  return {std::move(log), std::move(director), {std::move(stored.events), std::move(stored.blocks)}};
}

Summary run_on(const Setup& setup, Display* display, std::unique_ptr<Stage> stage,
               SimulatedParticipant* participant, Programs& programs, Monitor* monitor) {
  auto account = account_of(setup, stage->now_ns());
  auto begun =
      setup.resume_session.empty() ? begin(setup, *stage, programs) : resume(setup, *stage, programs);
  SessionRun run(setup, std::move(begun.director), std::move(begun.log), begun.earlier, std::move(stage),
                 std::move(account), participant, display, monitor, &programs);
  return run.run();
}

}  // namespace

Summary run(const Setup& setup, Display* display, Inputs& inputs, Monitor* monitor) {
  if (setup.observer.empty()) return run(setup, display, inputs, open_devices(setup.rig, inputs), monitor);
  auto room = simulates_capture(setup.rig) ? std::make_unique<SimulatedRoom>(setup.rig) : nullptr;
  return run(setup, display, inputs, std::move(room), monitor);
}

Summary run(const Setup& setup, Display* display, Inputs& inputs, std::unique_ptr<SimulatedRoom> room,
            Monitor* monitor) {
  Programs programs(setup.protocol.path);
  SimulatedParticipant participant(programs.respondent(setup.observer));
  if (room && setup.protocol.sensing) room->ask_for(window_of(*setup.protocol.sensing));
  return run_on(setup, display,
                virtual_stage(simulated_stream(setup.rig), participant, inputs, std::move(room),
                              trigger_setup_of(setup.rig)),
                &participant, programs, monitor);
}

Summary run(const Setup& setup, Display* display, Inputs& inputs, Devices devices, Monitor* monitor) {
  auto capture = card_capture_of(setup.rig);
  if (capture && capture->setup.finger && setup.protocol.sensing)
    capture->setup.finger->window = window_of(*setup.protocol.sensing);
  Programs programs(setup.protocol.path);
  return run_on(
      setup, display,
      real_stage(session_stream(setup.rig), std::move(devices), inputs, capture, trigger_setup_of(setup.rig)),
      nullptr, programs, monitor);
}

}  // namespace turnpoint::session
