#include "station/core/fault.hpp"

#include <iterator>

namespace turnpoint::core {

namespace {

struct NamedKind {
  FaultKind kind;
  const char *name, *description;
};

constexpr NamedKind all_kinds[] = {
    {FaultKind::other, "other", "a fault of the station"},
    {FaultKind::converter_gone, "converter_gone", "sound device disconnected"},
    {FaultKind::converter_rate, "converter_rate", "sound device running at a wrong rate"},
    {FaultKind::converter_saturated, "converter_saturated", "signal beyond full scale"},
    {FaultKind::audio_silent, "audio_silent", "audio thread not responding"},
    {FaultKind::session_silent, "session_silent", "session not responding"},
    {FaultKind::page_silent, "page_silent", "participant's page not responding"},
    {FaultKind::suspended, "suspended", "machine was suspended"},
    {FaultKind::amplifier, "amplifier", "amplifier reports a fault"},
    {FaultKind::enable_line, "enable_line", "enable line not at the level that was set"},
    {FaultKind::stop_pressed, "stop_pressed", "emergency stop pressed"},
    {FaultKind::lines_gone, "lines_gone", "GPIO lines disconnected"},
    {FaultKind::touch_gone, "touch_gone", "touch panel disconnected"},
    {FaultKind::disk_full, "disk_full", "disk full"},
    {FaultKind::disarmed, "disarmed", "amplifier not armed"},
    {FaultKind::limits, "limits", "safety limit reached"},
    {FaultKind::stimulus_missed, "stimulus_missed", "stimulus incomplete"},
    {FaultKind::vibration, "vibration", "the surface did not move as planned"},
    {FaultKind::capture, "capture", "the surface cannot be measured"},
    {FaultKind::sounding, "sounding", "the surface vibrates although the amplifier is off"},
    {FaultKind::self_test, "self_test", "the self-test failed"},
    {FaultKind::program, "program", "the program of a procedure failed"},
};
static_assert(std::size(all_kinds) == fault_kinds.size());

constexpr const NamedKind& entry(FaultKind kind) {
  for (const NamedKind& candidate : all_kinds)
    if (candidate.kind == kind) return candidate;
  return all_kinds[0];
}

}  // namespace

const char* name(FaultKind kind) { return entry(kind).name; }
const char* describe(FaultKind kind) { return entry(kind).description; }

std::string describe(const Fault& fault) {
  const std::string kind = describe(fault.kind);
  return fault.detail.empty() ? kind : kind + ": " + fault.detail;
}

}  // namespace turnpoint::core
