#include "station/io/amplifier.hpp"

#include <stdexcept>

#include "station/core/usage_error.hpp"
#include "station/io/guarded_amplifier.hpp"
#include "station/io/simulated_lines.hpp"
#include "station/io/uri.hpp"

namespace turnpoint::io {
namespace {

bool is_low(const std::string& value, const Uri& uri) {
  if (value != "low" && value != "high")
    throw core::UsageError("'" + uri.text + "': '" + value + "'; allowed are low and high");
  return value == "low";
}

bool is_on(const std::string& value, const Uri& uri) {
  if (value != "on" && value != "off")
    throw core::UsageError("'" + uri.text + "': read_back=" + value + "; allowed are on and off");
  return value == "on";
}

/// The settings that the amplifier's URI asks for. `requests` is empty for a simulated amplifier.
struct Asked {
  GuardLines roles;
  std::vector<LineRequest> requests;
};

Asked read(const std::string& text) {
  Uri uri = parse_uri(text);
  if (uri.scheme == "sim" && uri.name.empty() && uri.values.empty()) return {kSimulatedAmplifier, {}};
  if (uri.scheme != "gpio" || !uri.name.empty())
    throw core::UsageError("amplifier '" + text +
                           "'; allowed are sim: and "
                           "gpio:enable=LINE,fault=LINE,stop=LINE,heartbeat=LINE,gate=LINE");
  Asked asked;
  const auto want = [&](const char* key, const char* consumer, LineUse use) {
    const std::string line = uri.take(key, "");
    if (line.empty()) return -1;
    asked.requests.push_back({line, consumer, use});
    return static_cast<int>(asked.requests.size()) - 1;
  };
  auto& roles = asked.roles;
  roles.enable = want("enable", "turnpoint-amp-enable", LineUse::output_low);
  roles.heartbeat = want("heartbeat", "turnpoint-amp-heartbeat", LineUse::output_low);
  roles.fault = want("fault", "turnpoint-amp-fault", LineUse::input);
  roles.stop = want("stop", "turnpoint-amp-stop", LineUse::input);
  roles.gate = want("gate", "turnpoint-amp-gate", LineUse::input);
  const std::string active = uri.take("active", "high");
  roles.fault_active_low = is_low(uri.take("fault_active", active), uri);
  roles.stop_active_low = is_low(uri.take("stop_active", active), uri);
  roles.read_back = is_on(uri.take("read_back", "on"), uri);
  uri.check_empty("enable, heartbeat, fault, stop, gate, active, fault_active, stop_active, read_back");
  if (roles.enable < 0) throw core::UsageError("amplifier '" + text + "' has no enable line");
  if (roles.gate >= 0 && roles.heartbeat < 0)
    throw core::UsageError("amplifier '" + text +
                           "': gate needs a heartbeat line, which keeps the gate open");
  return asked;
}

}  // namespace

std::unique_ptr<audio::Amplifier> open_amplifier(const std::string& text) {
  const Asked asked = read(text);
  if (asked.requests.empty())
    return guard_amplifier([] { return std::make_unique<SimulatedAmplifierLines>(); }, asked.roles);
  return guard_amplifier([requests = asked.requests] { return open_gpio_lines(requests); }, asked.roles);
}

void force_amplifier_off(const std::string& text) {
  Asked asked = read(text);
  if (asked.requests.empty()) return;
  std::erase_if(asked.requests, [](const LineRequest& wanted) { return wanted.use == LineUse::input; });
  // requesting the lines as outputs already sets them low
  const auto lines = open_gpio_lines(asked.requests);
  const auto level = asked.roles.read_back ? lines->read_back(asked.roles.enable) : std::nullopt;
  if (level.value_or(false))
    throw std::runtime_error("gpio line " + asked.requests.front().name +
                             ": the line was set low but reads high");
}

}  // namespace turnpoint::io
