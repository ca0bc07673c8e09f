#include "station/session/finger_account.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "station/trial/timing.hpp"

namespace turnpoint::session {

namespace {

constexpr double kUnlimited_s = 1e9;

/// When a segment began, on today's wall clock. A board without a clock of its own begins with a wrong time,
/// which the network sets right later.
double start_s(const core::SegmentStart& segment, const core::SegmentStart& now) {
  const bool same_boot = !now.boot_id.empty() && segment.boot_id == now.boot_id;
  const auto start_ns =
      same_boot ? now.realtime_ns - (now.boottime_ns - segment.boottime_ns) : segment.realtime_ns;
  return 1e-9 * static_cast<double>(start_ns);
}

/// The time during which a segment (one program run of a session) was active, in s since 1970.
struct Active {
  double start_s = 0, end_s = 0;
};

/// The length of a stimulus as the session log has written it.
std::optional<double> length_s(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool read = error == std::errc() && end == text.data() + text.size() && value >= 0;
  return read ? std::optional(value) : std::nullopt;
}

void gather(const store::StoredSession& session, const core::SegmentStart& now, double longest_s,
            std::vector<Exposed>& stimuli, std::vector<Active>& active) {
  std::set<int> ended;
  for (const auto& block : session.blocks)
    for (const auto& trial : block.trials) ended.insert(trial.trial_index);
  std::vector<Active> segments;
  for (const auto& segment : session.segments)
    segments.push_back({start_s(segment, now), start_s(segment, now)});
  for (const auto& event : session.events) {
    const auto index = static_cast<std::size_t>(event.segment_index - 1);
    if (index >= segments.size()) continue;
    const double at_s = segments[index].start_s +
                        1e-9 * static_cast<double>(event.time_ns - session.segments[index].monotonic_ns);
    segments[index].end_s = std::max(segments[index].end_s, at_s);
    const bool open = event.kind == "presented" && event.trial_index && !ended.count(*event.trial_index);
    if (event.kind == "stimulus")
      // if the length cannot be read, the longest one counts
      stimuli.push_back({at_s, at_s + length_s(event.value).value_or(longest_s)});
    else if (open)
      stimuli.push_back({at_s, at_s + longest_s});
  }
  active.insert(active.end(), segments.begin(), segments.end());
}

}  // namespace

ExposureLimits limits_of(const rig::Rig& rig, core::RunMode mode) {
  const bool person = mode != core::RunMode::simulated;
  return {rig.limits.displacement_m, rig.limits.continuous_s, rig.limits.duty,
          person ? 60 * rig.limits.session_minutes : kUnlimited_s};
}

double longest_trial_s(const ExposureLimits& limits) {
  return std::max(limits.continuous_s, limits.duty * Exposure::window_s);
}

FingerHistory finger_history(const std::vector<store::StoredSession>& sessions, const core::SegmentStart& now,
                             double longest_s) {
  const double now_s = 1e-9 * static_cast<double>(now.realtime_ns);
  FingerHistory history;
  std::vector<Active> active;
  for (const auto& session : sessions) gather(session, now, longest_s, history.stimuli, active);
  for (auto& stimulus : history.stimuli) {
    const double late_s = std::max(0.0, stimulus.end_s - now_s);
    stimulus.start_s -= late_s, stimulus.end_s -= late_s;
  }
  std::sort(history.stimuli.begin(), history.stimuli.end(),
            [](const auto& a, const auto& b) { return a.start_s < b.start_s; });
  std::sort(active.begin(), active.end(), [](const auto& a, const auto& b) { return a.end_s > b.end_s; });
  history.period_start_s = now_s;
  for (const auto& segment : active)
    if (history.period_start_s - segment.end_s < kNewPeriod_s)
      history.period_start_s = std::min(history.period_start_s, segment.start_s);
  return history;
}

FingerHistory read_finger_history(const std::string& database, const std::string& participant,
                                  const core::SegmentStart& now, double longest_s) {
  std::error_code ignored;
  if (!std::filesystem::exists(database, ignored)) return finger_history({}, now, longest_s);
  auto sessions = store::list_sessions(database, {"", participant, ""});
  std::erase_if(sessions,
                [](const auto& session) { return session.start.run_mode == core::RunMode::simulated; });
  std::int64_t newest = 0;
  for (const auto& session : sessions) newest = std::max(newest, session.last_trial_id);
  std::vector<store::StoredSession> recent;
  for (const auto& session : sessions) {
    const double idle_s = 1e-9 * static_cast<double>(now.realtime_ns - session.last_activity_realtime_ns);
    // The newest session is read whatever the wall clock says, because the clock may have been set ahead.
    if (idle_s < 3600 + kNewPeriod_s || session.last_trial_id == newest)
      recent.push_back(store::read_session(database, session.session_id));
  }
  return finger_history(recent, now, longest_s);
}

namespace {

// Shifts times towards 0. Seconds since 1970 are so large that a double has too few digits left for comparing
// them with a limit.
std::vector<Exposed> shifted(std::vector<Exposed> stimuli, double by_s) {
  for (auto& stimulus : stimuli) stimulus.start_s -= by_s, stimulus.end_s -= by_s;
  return stimuli;
}

}  // namespace

FingerAccount::FingerAccount(const ExposureLimits& limits, const FingerHistory& history,
                             std::int64_t origin_ns, double origin_s)
    : exposure_(limits, history.period_start_s - origin_s, shifted(history.stimuli, origin_s)),
      origin_ns_(origin_ns) {}

double FingerAccount::seconds(std::int64_t time_ns) const {
  return 1e-9 * static_cast<double>(time_ns - origin_ns_);
}

std::int64_t FingerAccount::earliest_ns(std::int64_t wanted_ns, const std::vector<Exposed>& trial) const {
  const double wanted_s = seconds(wanted_ns);
  const double later_s = exposure_.earliest_start_s(wanted_s, trial) - wanted_s;
  return later_s < 1e-4 ? wanted_ns : wanted_ns + static_cast<std::int64_t>(later_s * 1e9);
}

void FingerAccount::add(std::int64_t on_ns, std::int64_t off_ns) {
  exposure_.add({seconds(on_ns), seconds(std::max(on_ns, off_ns))});
}

std::vector<Exposed> stimuli_of(const protocol::Protocol& protocol, const trial::TrialSpec& trial) {
  std::vector<Exposed> stimuli;
  double at_s = trial::cue_s(protocol, trial);
  for (const auto& part : trial::parts_of(protocol, trial)) {
    at_s += part.silence_s;
    stimuli.push_back({at_s, at_s + part.length_s});
    at_s += part.length_s;
  }
  return stimuli;
}

}  // namespace turnpoint::session
