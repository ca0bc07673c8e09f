#include "station/io/sync_line.hpp"

#include <utility>

#include "station/core/usage_error.hpp"
#include "station/io/edge_filter.hpp"
#include "station/io/uri.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::io {

namespace {

constexpr int kPriority = 60;
constexpr std::int64_t kWait_ns = 100'000'000;

DeviceWatch::Open opener(const OpenLines& open, bool low, const SyncLine::Pulse& pulse,
                         const ButtonsHandlers& handlers) {
  return [open, low, &pulse, &handlers] {
    std::shared_ptr<Lines> lines = open();
    const auto sequence = std::make_shared<SequenceCheck>();
    return [lines, sequence, low, &pulse, &handlers] {
      const auto edge = lines->wait(kWait_ns);
      if (!edge) return;
      if (const auto missed = sequence->missed_before(edge->sequence); missed > 0 && handlers.fault)
        handlers.fault({system::monotonic_ns(), ButtonsFault::Kind::edges_lost,
                        "sync line: " + std::to_string(missed) + " edges were lost"});
      if (edge->rising != low) pulse(edge->time_ns);
    };
  };
}

}  // namespace

SyncLine::SyncLine(const OpenLines& open, bool low, Pulse pulse, ButtonsHandlers handlers)
    : pulse_(std::move(pulse)),
      handlers_(std::move(handlers)),
      watch_(opener(open, low, pulse_, handlers_), kPriority, handlers_) {}

std::unique_ptr<SyncLine> open_sync_line(const std::string& text, SyncLine::Pulse pulse,
                                         ButtonsHandlers handlers) {
  Uri uri = parse_uri(text);
  if (uri.scheme == "sim") return nullptr;
  const auto line = uri.take("line", "");
  const bool low = take_low(uri);
  uri.check_empty("line, active");
  if (uri.scheme != "gpio" || line.empty())
    throw core::UsageError("sync '" + text + "'; allowed are sim: and gpio:line=LINE");
  const auto open = [line] { return open_gpio_lines({{line, "turnpoint-sync", LineUse::input}}); };
  return std::make_unique<SyncLine>(open, low, std::move(pulse), std::move(handlers));
}

}  // namespace turnpoint::io
