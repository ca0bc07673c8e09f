#include "station/protocol/triggers.hpp"

#include <algorithm>

#include "station/protocol/conditions.hpp"

namespace turnpoint::protocol {

namespace {

/// Returns the name of the trial's condition; "" if the trial belongs to none.
std::string trigger_condition(const Protocol& protocol, const Factors& factors) {
  const auto found = factors.find("instruction");
  const auto* instruction = found == factors.end() ? nullptr : std::get_if<std::string>(&found->second);
  const auto condition = condition_of(protocol, factors, instruction == nullptr ? "" : *instruction);
  const auto known = conditions(protocol);
  return std::find(known.begin(), known.end(), condition) == known.end() ? "" : condition;
}

}  // namespace

std::vector<std::string> trigger_event_names() {
  std::vector<std::string> names;
  for (const auto event :
       {TriggerEvent::trial, TriggerEvent::onset, TriggerEvent::change, TriggerEvent::response})
    names.emplace_back(name(event));
  return names;
}

const char* name(TriggerEvent event) {
  switch (event) {
    case TriggerEvent::trial:
      return "trial";
    case TriggerEvent::onset:
      return "onset";
    case TriggerEvent::change:
      return "change";
    case TriggerEvent::response:
      return "response";
  }
  return "";
}

std::vector<TriggerCode> trigger_codes(const Protocol& protocol) {
  auto names = conditions(protocol);
  names.emplace_back();
  std::vector<TriggerCode> codes;
  for (const auto& condition : names)
    for (const auto event : protocol.triggers.send) {
      TriggerCode code{event, condition, static_cast<int>(codes.size()) + 1};
      for (const auto& stated : protocol.triggers.stated)
        if (stated.event == event && stated.condition == condition) code.code = stated.code;
      codes.push_back(std::move(code));
    }
  return codes;
}

int trigger_code(const Protocol& protocol, TriggerEvent event, const Factors& factors) {
  const auto condition = trigger_condition(protocol, factors);
  for (const auto& code : trigger_codes(protocol))
    if (code.event == event && code.condition == condition) return code.code;
  return 0;
}

}  // namespace turnpoint::protocol
