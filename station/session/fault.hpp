#pragma once
#include <string>
#include <string_view>

namespace turnpoint::session {

/// What can go wrong in the room; each has a page of its own. `other` has only its detail.
enum class FaultKind {
  other,
  converter_gone,   ///< unplugged, or its driver gave up
  converter_rate,   ///< it does not run at the rate that it reports
  amplifier,        ///< its fault line, or a reason that the station found itself
  stop_pressed,     ///< the stop in the amplifier's supply
  touch_gone,       ///< the touch panel was unplugged
  lines_gone,       ///< the GPIO chip of buttons, contact or amplifier, or the touch sensor on the surface
  disk_full,        ///< a finished trial could not be stored yet
  disarmed,         ///< no fault: nobody has armed the amplifier yet, or the operator switched it off
  stimulus_missed,  ///< frames were lost, or a stimulus came too late
};

/// With this the station itself trips the amplifier.
inline constexpr std::string_view kConverterGone = "the converter is gone";

/// A fault in words for whoever stands before the screen: what happened, what is safe, what to do.
struct FaultText {
  std::string happened, safe, to_do;
};

/// In the language asked for (two-letter code), or in English where the station does not speak it.
FaultText fault_text(FaultKind kind, const std::string& language);

/// What has latched the amplifier's fault, from its reason (drive::Amplifier::fault).
FaultKind fault_of_amplifier(std::string_view reason);

/// "converter_gone", ...: for the log.
const char* name(FaultKind kind);

}  // namespace turnpoint::session
