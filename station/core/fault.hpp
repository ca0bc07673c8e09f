#pragma once
#include <array>
#include <string>

namespace turnpoint::core {

/// The kinds of faults that can occur during a session. The part of the station that finds a fault (amplifier
/// guard, audio stream, panel, store) chooses its kind. The kind is passed on unchanged to the page that
/// explains the fault. Each kind has its own page.
enum class FaultKind {
  other,                ///< a fault without a kind of its own; see the detail
  converter_gone,       ///< the converter (sound device) was unplugged, or its driver failed
  converter_rate,       ///< the converter does not run at the rate that it reports
  converter_saturated,  ///< samples beyond full scale were clipped, so the stimulus was wrong
  audio_silent,         ///< the audio thread no longer reports to the amplifier guard
  session_silent,       ///< the session thread no longer reports to the amplifier guard
  page_silent,          ///< the participant's page no longer reports to the amplifier guard
  suspended,            ///< the machine was suspended
  amplifier,            ///< the amplifier signals a fault on its fault line
  enable_line,          ///< the amplifier's enable line does not have the level that was written to it
  stop_pressed,         ///< the emergency stop has cut the amplifier's supply
  /// the touch sensor, or the GPIO chip of buttons, contact or amplifier, is disconnected
  lines_gone,
  touch_gone,  ///< the touch panel was unplugged
  disk_full,   ///< there was no room on the disk to store a finished trial
  disarmed,    ///< not a fault: the amplifier is not armed yet, or the operator switched it off
  /// a limit of the rig on exposure or sound level was reached, and the session cannot continue
  limits,
  stimulus_missed,  ///< frames were lost during a stimulus, or a stimulus came too late
  vibration,        ///< the pick-up says that the surface did not move as planned
  capture,          ///< what the surface does cannot be measured: no capture device, or no pilot heard
  sounding,         ///< the pick-up hears a vibration although the amplifier is off
  self_test,        ///< a check of the self-test before the session failed
  program,          ///< the program of a procedure died, was late, or wrote what it must not write
};

inline constexpr std::array fault_kinds{FaultKind::other,           FaultKind::converter_gone,
                                        FaultKind::converter_rate,  FaultKind::converter_saturated,
                                        FaultKind::audio_silent,    FaultKind::session_silent,
                                        FaultKind::page_silent,     FaultKind::suspended,
                                        FaultKind::amplifier,       FaultKind::enable_line,
                                        FaultKind::stop_pressed,    FaultKind::lines_gone,
                                        FaultKind::touch_gone,      FaultKind::disk_full,
                                        FaultKind::disarmed,        FaultKind::limits,
                                        FaultKind::stimulus_missed, FaultKind::vibration,
                                        FaultKind::capture,         FaultKind::sounding,
                                        FaultKind::self_test,       FaultKind::program};

/// Returns the kind's name for the log: "converter_gone", ...
const char* name(FaultKind kind);

/// Describes the kind in plain English for messages: "emergency stop pressed".
const char* describe(FaultKind kind);

/// A fault, or the reason why the station refuses something: its kind, and details from the part that found
/// it.
struct Fault {
  FaultKind kind = FaultKind::other;
  std::string detail;  ///< text for the log and for the small print on a page; may be ""
};
/// Describes the fault with its detail: "GPIO lines disconnected: No such device".
std::string describe(const Fault& fault);

}  // namespace turnpoint::core
