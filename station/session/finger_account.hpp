#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/rig/rig.hpp"
#include "station/session/exposure.hpp"
#include "station/store/read.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::session {

/// Returns the rig's limits of exposure. There is no limit on the length of a simulated session.
ExposureLimits limits_of(const rig::Rig& rig, core::RunMode mode);

/// The vibration that a participant's finger has received so far: the stimuli of earlier program runs, from
/// the database and in order of time, and the start of the period of exposure on the wall clock (s since
/// 1970). Only a pause of half an hour starts a new period; a restart of the program or another session of
/// this participant does not.
struct FingerHistory {
  std::vector<Exposed> stimuli;
  double period_start_s = 0;
};
inline constexpr double kNewPeriod_s = 1800;

/// The longest time for which the finger may have felt a trial of which nothing is stored but its start, in
/// s. Its parts, with rests between them, together last at most as long as the duty allows.
double longest_trial_s(const ExposureLimits& limits);

/// Computes the history from the sessions that ended within the half hour before `now`, which are the clocks
/// of the program run that begins. Since the machine was started, how long ago a stimulus was is taken from
/// the clock that nobody sets (`boottime_ns`); before that, from the wall clock. A trial that was presented
/// but never finished, because of a crash, counts as a stimulus of `longest_s`. A time after `now` counts as
/// `now`, because the wall clock must have been set back.
FingerHistory finger_history(const std::vector<store::StoredSession>& sessions, const core::SegmentStart& now,
                             double longest_s);

/// Reads the history from a database, which may not exist yet. Simulated sessions have no history.
FingerHistory read_finger_history(const std::string& database, const std::string& participant,
                                  const core::SegmentStart& now, double longest_s);

/// Keeps a period of exposure within the rig's limits. Times are those of the stage's clock, which may be
/// virtual.
class FingerAccount {
 public:
  /// `origin_ns` (on Stage::now_ns(), the session's clock) and `origin_s` (on the wall clock) are the same
  /// moment.
  FingerAccount(const ExposureLimits& limits, const FingerHistory& history, std::int64_t origin_ns,
                double origin_s);

  /// The earliest time, at or after `wanted_ns`, at which a trial may begin. Throws LimitExceeded.
  std::int64_t earliest_ns(std::int64_t wanted_ns, const std::vector<Exposed>& trial) const;
  /// Throws LimitExceeded for a displacement that the rig does not allow.
  void check(double displacement_m, double length_s) const { exposure_.check(displacement_m, length_s); }
  /// Records a stimulus that was presented.
  void add(std::int64_t on_ns, std::int64_t off_ns);

 private:
  double seconds(std::int64_t time_ns) const;

  Exposure exposure_;
  std::int64_t origin_ns_;
};

/// Returns the stimuli of a trial, with times counted from the start of the trial and with their longest
/// possible durations.
std::vector<Exposed> stimuli_of(const protocol::Protocol& protocol, const trial::TrialSpec& trial);

}  // namespace turnpoint::session
