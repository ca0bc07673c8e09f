#include <linux/input.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "station/core/usage_error.hpp"
#include "station/io/buttons.hpp"
#include "station/io/device_watch.hpp"
#include "station/io/evdev_contact.hpp"
#include "station/io/uri.hpp"
#include "station/io/watched_lines.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::io {
namespace {

constexpr int lines_priority = 75, evdev_priority = 60;
constexpr std::int64_t settle_check_ns = 5'000'000;
constexpr std::int64_t glitch_pause_ns = 1'000'000'000;
constexpr std::int64_t evdev_wait_ns = 100'000'000;

// Watches the lines of the buttons and, if there is one, the contact line, which is the last.
class LineReader {
 public:
  LineReader(std::unique_ptr<Lines> lines, const WatchedLines& plan, const ButtonsHandlers& handlers)
      : lines_(std::move(lines)), plan_(plan), handlers_(handlers) {
    for (int k = 0; k < plan_.lines; ++k)
      watched_.emplace_back(k == plan_.contact ? plan_.contact_rules : plan_.button_rules,
                            active(k, lines_->level(k)));
  }

  void look() {
    const std::int64_t now = system::monotonic_ns();
    std::int64_t due = now + settle_check_ns;
    for (const Watched& line : watched_) due = std::min(due, line.filter.due_ns());
    if (const auto edge = lines_->wait(std::max<std::int64_t>(due - now, 0))) return take(*edge);
    // Read the clock before the lines: every edge from before this time has then arrived when the lines have
    // been polled.
    const std::int64_t quiet_until = system::monotonic_ns();
    if (const auto edge = lines_->wait(0)) return take(*edge);
    settle(quiet_until);
  }

 private:
  struct Watched {
    Watched(const EdgeFilter::Rules& rules, bool active) : filter(rules, active) {}
    EdgeFilter filter;
    SequenceCheck sequence;
    std::optional<std::int64_t> glitch_told_ns;
    int untold_glitches = 0;
  };

  bool active(int line, bool level) const {
    return level != (line == plan_.contact ? plan_.contact_low : plan_.buttons_low);
  }
  const std::string& name(int line) const { return plan_.names.at(static_cast<std::size_t>(line)); }

  void take(const Edge& edge) {
    Watched& watched = watched_.at(static_cast<std::size_t>(edge.line));
    if (const auto missed = watched.sequence.missed_before(edge.sequence); missed > 0)
      fault_of_line(edge.line, std::to_string(missed) + " edges of the line were lost");
    decide(edge.line, edge.time_ns);
    tell(edge.line, watched.filter.edge(edge.time_ns, active(edge.line, edge.rising)));
  }

  void settle(std::int64_t now) {
    for (int line = 0; line < plan_.lines; ++line) {
      decide(line, now);
      tell(line,
           watched_[static_cast<std::size_t>(line)].filter.level(now, active(line, lines_->level(line))));
    }
  }

  void decide(int line, std::int64_t now) {
    auto& filter = watched_[static_cast<std::size_t>(line)].filter;
    while (const auto change = filter.decide(now)) tell(line, change);
  }

  void tell(int line, const std::optional<LineChange>& change) {
    if (!change) return;
    if (change->kind == LineChange::Kind::glitch) return tell_glitch(line, *change);
    if (change->kind == LineChange::Kind::lost)
      fault_of_line(line, "the level of the line changed, but the kernel reported no edge");
    if (line == plan_.contact) {
      if (handlers_.contact) handlers_.contact({change->time_ns, change->active, std::nullopt});
    } else if (change->kind == LineChange::Kind::pressed && handlers_.press) {
      handlers_.press({change->time_ns, line});
    }
  }

  // Reports a glitch, but not too often: interference can come thousands of times per second, and people read
  // the log.
  void tell_glitch(int line, const LineChange& change) {
    Watched& watched = watched_[static_cast<std::size_t>(line)];
    if (watched.glitch_told_ns && change.time_ns < *watched.glitch_told_ns + glitch_pause_ns) {
      ++watched.untold_glitches;
      return;
    }
    watched.glitch_told_ns = change.time_ns;
    const int untold = std::exchange(watched.untold_glitches, 0);
    if (handlers_.glitch)
      handlers_.glitch({change.time_ns, name(line), change.edges, change.length_ns, untold});
  }

  void fault_of_line(int line, const std::string& what) {
    if (handlers_.fault)
      handlers_.fault(
          {system::monotonic_ns(), ButtonsFault::Kind::edges_lost, "line " + name(line) + ": " + what});
  }

  std::unique_ptr<Lines> lines_;
  const WatchedLines& plan_;
  const ButtonsHandlers& handlers_;
  std::vector<Watched> watched_;
};

DeviceWatch::Open line_opener(OpenLines open, WatchedLines plan, const ButtonsHandlers& handlers) {
  return [open = std::move(open), plan = std::make_shared<WatchedLines>(std::move(plan)), &handlers] {
    auto reader = std::make_shared<LineReader>(open(), *plan, handlers);
    return [reader] { reader->look(); };
  };
}

DeviceWatch::Open contact_opener(std::string name, int axis, const ButtonsHandlers& handlers) {
  return [name = std::move(name), axis, &handlers] {
    auto contact = std::make_shared<EvdevContact>(name, axis);
    return [contact, &handlers] {
      const auto news = contact->wait(evdev_wait_ns);
      if (news && handlers.contact) handlers.contact(*news);
    };
  };
}

class RigButtons final : public Buttons {
 public:
  explicit RigButtons(ButtonsHandlers handlers) : handlers_(std::move(handlers)) {}

  const std::vector<std::string>& names() const override { return names_; }
  std::string missing() const override {
    for (const auto* device : {lines_.get(), contact_.get()})
      if (device && !device->missing().empty()) return device->missing();
    return "";
  }
  void simulate(const Press& press) override {
    check_simulated();
    if (handlers_.press) handlers_.press(press);
  }
  void simulate(const Contact& contact) override {
    check_simulated();
    if (handlers_.contact) handlers_.contact(contact);
  }

  std::vector<std::string> names_;
  ButtonsHandlers handlers_;
  std::unique_ptr<DeviceWatch> lines_, contact_;

 private:
  void check_simulated() const {
    if (lines_ || contact_) throw std::logic_error("only simulated buttons can be pressed by the program");
  }
};

EdgeFilter::Rules take_rules(Uri& uri) {
  EdgeFilter::Rules rules;
  rules.hold_ns = take_ms(uri, "hold_ms", rules.hold_ns, 10);
  rules.refractory_ns = take_ms(uri, "refractory_ms", rules.refractory_ns, 1000);
  return rules;
}

void plan_buttons(const std::string& text, RigButtons& buttons, WatchedLines& plan) {
  Uri uri = parse_uri(text);
  if (uri.scheme == "sim") {
    buttons.names_ = {"left", "right"};
    return;
  }
  if (uri.scheme != "gpio")
    throw core::UsageError("buttons '" + text + "'; allowed are sim: and gpio:left=LINE,right=LINE");
  plan.buttons_low = take_low(uri);
  plan.button_rules = take_rules(uri);
  for (const auto& [name, line] : uri.values) {
    buttons.names_.push_back(name);
    plan.names.push_back(name);
    plan.requests.push_back({line, "turnpoint-button-" + name, LineUse::input});
  }
  if (buttons.names_.empty()) throw core::UsageError("buttons '" + text + "' do not name any line");
}

void plan_contact(const std::string& text, RigButtons& buttons, WatchedLines& plan) {
  Uri uri = parse_uri(text);
  if (uri.scheme == "sim") {
  } else if (uri.scheme == "gpio") {
    plan.contact_low = take_low(uri);
    const std::string line = uri.take("line", "");
    plan.contact_rules = take_rules(uri);
    uri.check_empty("line, active, hold_ms, refractory_ms");
    if (line.empty()) throw core::UsageError("contact '" + text + "' does not name a line");
    plan.contact = static_cast<int>(plan.requests.size());
    plan.requests.push_back({line, "turnpoint-contact", LineUse::input});
    plan.names.push_back("contact");
  } else if (uri.scheme == "evdev" && !uri.name.empty()) {
    const std::string axis = uri.take("axis", "x");
    uri.check_empty("axis");
    if (axis != "x" && axis != "y") throw core::UsageError("'" + text + "': axis=" + axis + "; allowed x, y");
    buttons.contact_ = std::make_unique<DeviceWatch>(
        contact_opener(uri.name, axis == "x" ? ABS_X : ABS_Y, buttons.handlers_), evdev_priority,
        buttons.handlers_);
  } else {
    throw core::UsageError("contact '" + text + "'; allowed are sim:, gpio:line=LINE and evdev:NAME");
  }
}

}  // namespace

std::unique_ptr<Buttons> watch_lines(OpenLines open, const WatchedLines& plan, ButtonsHandlers handlers) {
  auto watched = std::make_unique<RigButtons>(std::move(handlers));
  for (int k = 0; k < plan.lines; ++k)
    if (k != plan.contact) watched->names_.push_back(plan.names.at(static_cast<std::size_t>(k)));
  watched->lines_ = std::make_unique<DeviceWatch>(line_opener(std::move(open), plan, watched->handlers_),
                                                  lines_priority, watched->handlers_);
  return watched;
}

std::unique_ptr<Buttons> open_buttons(const std::optional<ButtonsConfig>& buttons,
                                      const std::optional<ContactConfig>& contact, ButtonsHandlers handlers) {
  return open_buttons(buttons, contact, std::move(handlers), open_gpio_lines);
}

std::unique_ptr<Buttons> open_buttons(const std::optional<ButtonsConfig>& buttons,
                                      const std::optional<ContactConfig>& contact, ButtonsHandlers handlers,
                                      const RequestLines& request) {
  auto watched = std::make_unique<RigButtons>(std::move(handlers));
  WatchedLines plan;
  if (buttons) plan_buttons(buttons->uri, *watched, plan);
  if (contact) plan_contact(contact->uri, *watched, plan);
  plan.lines = static_cast<int>(plan.requests.size());
  const auto open = [request, requests = plan.requests] { return request(requests); };
  if (plan.lines > 0)
    watched->lines_ = std::make_unique<DeviceWatch>(line_opener(open, plan, watched->handlers_),
                                                    lines_priority, watched->handlers_);
  return watched;
}

}  // namespace turnpoint::io
