#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "station/analysis/trial_record.hpp"
#include "station/protocol/protocol.hpp"
#include "station/protocol/survey.hpp"
#include "station/rehearsal/cue_guard.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/sound.hpp"
#include "station/scene/under_finger.hpp"

namespace turnpoint::rehearsal {

/// The median of a number over simulated sessions, and the 5 % and 95 % quantiles, between which nine of ten
/// sessions lie. `error` is the Monte Carlo error: each of the three is within it of its value over all
/// sessions in 95 % of cases; with fewer than 20 sessions it is too small.
struct Spread {
  double low = 0, median = 0, high = 0, error = 0;
};
Spread spread_of(std::vector<double> values);  ///< all 0 if there are no values

/// The length of one simulated session. The duration includes the time in which a person would read
/// instructions, explore the surface and set sliders.
struct SessionLength {
  double trials = 0, duration_s = 0;
};
SessionLength session_length(const protocol::Protocol& protocol, std::uint64_t seed);

/// If nobody says how many sessions are simulated, sessions are added until the errors of the number of
/// trials and of the duration (Spread::error) are at most this fraction of their medians, up to this many
/// sessions.
inline constexpr double kLengthPrecision = 0.03;
inline constexpr int kMostSessions = 1000;

/// A part of a session without trials: a questionnaire, a consent, an explanation or a screening.
struct CheckedInterlude {
  protocol::InterludeKind kind = protocol::InterludeKind::questionnaire;
  std::string name;
  std::size_t pages = 0;  ///< number of questions or pages; 0 for a screening
};

/// A block as a participant will run it.
struct CheckedBlock {
  std::string visit;  ///< such as "session 2, group trained"; "" if there is only one session and no group
  int session = 0;    ///< number of the planned session; 0 if the protocol plans none
  std::string group;  ///< "" if the protocol has no groups
  std::string name, instruction;
  bool practice = false;
  Spread trials;
  Spread duration_s = {};  ///< as Check::duration_s: with its instruction and its breaks
  /// what comes before the block and, for the last block of a session, after it
  std::vector<CheckedInterlude> before = {}, after = {};
};

/// How often a limit of runs could not be kept in simulated sessions in which one trial of ten is not
/// answered.
struct CheckedRuns {
  std::string of;  ///< the key of procedure::Spec::max_run
  int limit = 0;   ///< the smallest, if blocks differ
  int longest = 0, longer = 0,
      sessions = 0;                 ///< `longer` of `sessions` had a longer run; `longest` of them all
  analysis::Interval share_longer;  ///< of sessions with a longer run: 95 %, Clopper & Pearson
};

/// The result of `turnpoint check` for a protocol on a rig.
struct Check {
  /// problems of both files and of their combination; if there are any, all other members are empty
  std::vector<core::Problem> problems;
  std::vector<core::Problem> warnings;
  std::vector<core::Problem> notes;  ///< remarks of little importance, which do not count as warnings
  std::string id, title, rig_name;
  std::vector<std::string> languages;  ///< those of the protocol's languages that this machine can draw
  /// what the trials measure, one line for each analysis: "main: threshold of `contrast_dB` at 82 % correct"
  std::vector<std::string> measures;
  std::vector<CheckedBlock> blocks;
  int different_places = 1;  ///< in the counterbalancing: number of combinations of group and orders
  /// time after which a participant who has not completed is replaced; empty: never
  std::optional<double> dropout_after_h;
  std::vector<CheckedRuns> runs;  ///< one for each limit of runs that the protocol sets
  /// values of one session; if sessions or groups differ in length, values of the longest
  Spread trials, duration_s;
  int simulated_sessions = 0, wanted_sessions = 0;
  /// If people may ask for the intervals of a trial again: the longest trial, and the longest session with
  /// its reading, of simulated sessions in which everybody asks as often as allowed in every trial, in s
  std::optional<double> longest_trial_again_s, longest_session_again_s;
  protocol::Survey survey;
  CueGuard cues;
  /// upper limit of the airborne sound level for the loudest combination of factors; empty if
  /// CheckOptions::sound is false or if no limit is known for this rig
  std::optional<scene::SoundBound> sound;
  /// fraction of the displacement that remains under a finger, at the last maxima of the lowest and the
  /// highest tone; empty if CheckOptions::finger is false or there are no last maxima
  std::optional<scene::FingerShares> finger;
  std::vector<protocol::TriggerCode> triggers;  ///< empty if the rig sends no trigger codes
  std::vector<std::string> protocol_defaults, rig_defaults;
  bool stopped = false;  ///< true if the check was ended early by CheckOptions::steps.finish
};

/// What `turnpoint check` computes besides planning every scene of the protocol.
struct CheckOptions {
  /// number of sessions to simulate, to estimate the number of trials and the duration; 0: none; empty: until
  /// both are known to kLengthPrecision
  std::optional<int> sessions;
  /// also compute the upper limit of the airborne sound level, which takes about 10 ms per tone
  bool sound = false;
  /// also compute the fraction of the displacement that remains under a finger, for the lowest and the
  /// highest tone
  bool finger = false;
  /// the function that reads the rig file; a caller that knows a calibration can replace it by one that
  /// applies it
  std::function<rig::Rig(const std::string& path)> load_rig = rig::load;
  /// says whether a character can be drawn on this machine (see protocol::drawn_with); empty: not checked
  std::function<bool(char32_t character)> drawable = {};
  Steps steps = {};
  /// starts the separate programs of the protocol and returns their problems; empty: they are not started
  std::function<std::vector<core::Problem>(const protocol::Protocol&)> try_programs = {};
  /// reads the protocol file; a caller that has its text applies it here
  std::function<protocol::Protocol(const std::string& path)> load_protocol = protocol::load;
};

/// Simulates sessions in which one trial of ten is not answered, and counts those in which runs of trials
/// were longer than the protocol allows. Trials that come again can make a run longer, so hardly any limit is
/// certain. Empty if the protocol limits no runs.
std::vector<CheckedRuns> check_runs(const protocol::Protocol& protocol, int sessions,
                                    const std::stop_token& stop = {}, const Steps& steps = {});

/// Returns a Check with blocks, trials, duration_s and the numbers of sessions only.
Check session_lengths(const protocol::Protocol& protocol, std::optional<int> sessions = {});

/// Reads and checks both files as `run` would. Throws std::system_error if one cannot be read, and
/// protocol::Abandoned soon after `stop` is requested, or if steps.finish is requested while the scenes are
/// being planned. If steps.finish is requested later, the result contains what was computed until then.
Check check(const std::string& protocol_path, const std::string& rig_path, const CheckOptions& options = {},
            const std::stop_token& stop = {});

}  // namespace turnpoint::rehearsal
