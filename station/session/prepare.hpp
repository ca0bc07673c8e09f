#pragma once
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "station/core/problem.hpp"
#include "station/core/texts.hpp"
#include "station/session/planned_session.hpp"
#include "station/session/session.hpp"

namespace turnpoint::session {

/// The options of `turnpoint station`, with defaults filled in.
struct StationRequest {
  std::string protocols;  ///< path of the folder with the protocols
  std::string rig, database;
  bool locked = false;      ///< true if the operator's code must be entered before the start page
  bool fullscreen = false;  ///< fill the whole screen, also on a desktop
};

/// Placeholder for a participant's code that will be typed later. With it, all other settings can be checked
/// before.
inline constexpr const char* kCodeToCome = "keypad";

/// The options of `turnpoint run`, as typed.
struct RunRequest {
  std::string protocol, rig, participant, database;
  std::string mode = "pilot";  ///< run mode: live or pilot
  std::string language;        ///< "" uses the protocol's first language
  std::string observer;        ///< the simulated observer, such as "sim"; "" if a person answers
  std::optional<std::uint64_t> seed;
  std::string consent_version;  ///< version of the consent form; "" if the study needs none
  bool headless = false, buttons_only = false;
  bool fullscreen = false;  ///< fill the whole screen, also on a desktop
  /// path of the calibration file; "" uses the newest one beside the rig file, if there is one
  std::string calibration;
  bool self_test = false;  ///< run the self-test before the first block
  /// reason to continue although a check of the self-test failed; if "", the operator is asked
  std::string despite;
  std::optional<int> planned_session;  ///< which planned session; empty: the participant's next one
  std::string early;  ///< reason to begin before the protocol's minimum number of days has passed; or ""
  core::Conditions conditions;
  std::string cleaned;  ///< whether the surface was cleaned just before: yes or no; "" if not stated
};

/// Loads and checks everything that a session needs, and applies the calibration to the rig. Throws
/// core::BadInput with all problems of the two files, of their combination, and of participant code, language
/// and mode; TooEarly if only too few days have passed since the participant's last session, which
/// RunRequest::early overrules. A calibration that has expired or belongs to another rig is an error if the
/// request names it or if the session is live; otherwise it is ignored. Throws protocol::Abandoned soon after
/// `stop` is requested.
Setup prepare(const RunRequest& request, const std::stop_token& stop = {});

/// Returns the reasons why the live session of this request cannot run; empty if it can. The reasons name no
/// option of the command line, so a page can show them. Throws like prepare(), except core::BadInput.
std::vector<core::Phrase> live_problems(const RunRequest& request, const std::stop_token& stop = {});

/// Applies the text of a calibration file to the rig, to the sound levels, and to the values that are stored
/// with the session. Throws core::BadInput or core::UsageError.
void take_calibration(const std::string& source, const std::string& path, Setup& setup);

/// Returns the rig with the named calibration applied. If none is named, applies the newest valid one beside
/// the rig file, if there is one. Says on `messages` which one it is. Throws core::BadInput, or
/// core::UsageError for a named calibration that this rig must not use.
rig::Rig calibrated_rig(const std::string& rig, const std::string& calibration, std::ostream& messages);

}  // namespace turnpoint::session
