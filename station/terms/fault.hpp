#pragma once
#include <array>
#include <string>

namespace turnpoint::terms {

/// Everything that can go wrong in the room. A kind is passed on unchanged from whoever finds the fault
/// (amplifier guard, audio stream, panel, store) to the page that explains it. Each kind has its own page.
enum class FaultKind {
  other,                ///< any other fault; see its detail
  converter_gone,       ///< unplugged, or its driver gave up
  converter_rate,       ///< it does not run at the rate that it reports
  converter_saturated,  ///< samples beyond full scale were clipped, so the stimulus was not the requested one
  audio_silent,         ///< the audio thread no longer reports to the amplifier's guard
  session_silent,       ///< the session thread no longer reports
  page_silent,          ///< the participant's page no longer reports
  suspended,            ///< the machine was suspended
  amplifier,            ///< the amplifier reports a fault on its fault line
  enable_line,          ///< the amplifier's enable line does not have the level that was set
  stop_pressed,         ///< the emergency stop in the amplifier's supply
  /// the GPIO chip of buttons, contact or amplifier, or the touch sensor on the surface, is disconnected
  lines_gone,
  touch_gone,       ///< the touch panel was unplugged
  disk_full,        ///< a finished trial could not be stored yet
  disarmed,         ///< not a fault: nobody has armed the amplifier yet, or the operator switched it off
  limits,           ///< a rig limit on exposure or sound level was reached: the session cannot continue
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

/// The name for the log: "converter_gone", ...
const char* name(FaultKind kind);

/// Plain English for messages: "emergency stop pressed".
const char* describe(FaultKind kind);

/// A fault, or the reason why something is refused: its kind, and what the station found.
struct Fault {
  FaultKind kind = FaultKind::other;
  std::string detail;  ///< for the log and for the small print on a page; may be ""
};
/// With the detail: "GPIO lines disconnected: No such device".
std::string describe(const Fault& fault);

}  // namespace turnpoint::terms
