#pragma once
#include <array>
#include <string>

namespace turnpoint::terms {

/// What can go wrong in the room. The kind travels unchanged from whoever finds the fault (amplifier guard,
/// audio stream, panel, store) to the page that explains it; each kind has a page of its own.
enum class FaultKind {
  other,                ///< only its detail says more
  converter_gone,       ///< unplugged, or its driver gave up
  converter_rate,       ///< it does not run at the rate that it reports
  converter_saturated,  ///< samples beyond full scale were clipped: what is felt is not what was asked for
  audio_silent,         ///< the audio thread no longer reports to the amplifier's guard
  session_silent,       ///< the session thread no longer does
  page_silent,          ///< the participant's page no longer does
  suspended,            ///< the machine was suspended
  amplifier,            ///< the amplifier's own fault line
  enable_line,          ///< the amplifier's enable line does not have the level that was driven
  stop_pressed,         ///< the stop in the amplifier's supply
  lines_gone,       ///< the GPIO chip of buttons, contact or amplifier, or the touch sensor on the surface
  touch_gone,       ///< the touch panel was unplugged
  disk_full,        ///< a finished trial could not be stored yet
  disarmed,         ///< no fault: nobody has armed the amplifier yet, or the operator switched it off
  limits,           ///< a limit of the rig on exposure or sound level: the session cannot go on
  stimulus_missed,  ///< frames were lost, or a stimulus came too late
};

inline constexpr std::array fault_kinds{FaultKind::other,          FaultKind::converter_gone,
                                        FaultKind::converter_rate, FaultKind::converter_saturated,
                                        FaultKind::audio_silent,   FaultKind::session_silent,
                                        FaultKind::page_silent,    FaultKind::suspended,
                                        FaultKind::amplifier,      FaultKind::enable_line,
                                        FaultKind::stop_pressed,   FaultKind::lines_gone,
                                        FaultKind::touch_gone,     FaultKind::disk_full,
                                        FaultKind::disarmed,       FaultKind::limits,
                                        FaultKind::stimulus_missed};

/// "converter_gone", ...: for the log.
const char* name(FaultKind kind);

/// In plain English, for messages: "emergency stop pressed".
const char* describe(FaultKind kind);

/// A fault, or the reason why something is refused: what kind it is, and what the station found.
struct Fault {
  FaultKind kind = FaultKind::other;
  std::string detail;  ///< for the log and for the small print of a page; may be ""
};
/// "GPIO lines disconnected: No such device".
std::string describe(const Fault& fault);

}  // namespace turnpoint::terms
