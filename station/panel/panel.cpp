#include <stdexcept>
#include <utility>

#include "station/drive/monotonic.hpp"
#include "station/panel/buttons.hpp"
#include "station/panel/device_watch.hpp"
#include "station/panel/evdev_contact.hpp"
#include "station/panel/line_panel.hpp"
#include "station/panel/uri.hpp"

namespace turnpoint::panel {
namespace {

constexpr int panel_priority = 75, evdev_priority = 60;
constexpr std::int64_t settle_check_ns = 5'000'000;
constexpr std::int64_t evdev_wait_ns = 100'000'000;

// Buttons first, then perhaps the contact line, as they are read.
class LineReader {
 public:
  LineReader(std::unique_ptr<Lines> lines, const LinePanel& plan, const PanelHandlers& handlers)
      : lines_(std::move(lines)), plan_(plan), handlers_(handlers) {
    for (int k = 0; k < plan_.lines; ++k) {
      const std::int64_t refractory_ns =
          k == plan_.contact ? plan_.contact_refractory_ns : plan_.refractory_ns;
      filters_.emplace_back(refractory_ns, active(k, lines_->level(k)));
    }
    checks_.resize(filters_.size());
  }

  void look() {
    if (const auto edge = lines_->wait(settle_check_ns))
      take(*edge);
    else
      settle();
  }

 private:
  bool active(int line, bool level) const {
    return level != (line == plan_.contact ? plan_.contact_low : plan_.buttons_low);
  }

  void tell(int line, EdgeFilter::Result result, std::int64_t time_ns) {
    if (result == EdgeFilter::Result::ignored) return;
    const bool pressed = result == EdgeFilter::Result::pressed;
    if (line == plan_.contact) {
      if (handlers_.touch) handlers_.touch({time_ns, pressed, std::nullopt});
    } else if (pressed && handlers_.press) {
      handlers_.press({time_ns, line});
    }
  }

  void take(const Edge& edge) {
    const auto k = static_cast<std::size_t>(edge.line);
    const std::uint32_t missed = checks_[k].missed_before(edge.sequence);
    if (missed > 0 && handlers_.fault)
      handlers_.fault(
          {drive::monotonic_ns(), PanelFault::Kind::edges_lost,
           std::to_string(missed) + " edges of line " + std::to_string(edge.line) + " were lost"});
    tell(edge.line, filters_[k].edge(edge.time_ns, active(edge.line, edge.rising)), edge.time_ns);
  }

  // A level that changed back within the refractory time has no edge of its own left.
  void settle() {
    const std::int64_t now = drive::monotonic_ns();
    for (int line = 0; line < plan_.lines; ++line) {
      EdgeFilter& filter = filters_[static_cast<std::size_t>(line)];
      if (now < filter.settles_ns()) continue;
      tell(line, filter.settle(now, active(line, lines_->level(line))), now);
    }
  }

  std::unique_ptr<Lines> lines_;
  const LinePanel& plan_;
  const PanelHandlers& handlers_;
  std::vector<EdgeFilter> filters_;
  std::vector<SequenceCheck> checks_;
};

DeviceWatch::Open line_opener(OpenLines open, LinePanel plan, const PanelHandlers& handlers) {
  return [open = std::move(open), plan = std::make_shared<LinePanel>(std::move(plan)), &handlers] {
    auto reader = std::make_shared<LineReader>(open(), *plan, handlers);
    return [reader] { reader->look(); };
  };
}

DeviceWatch::Open touch_opener(std::string name, int axis, const PanelHandlers& handlers) {
  return [name = std::move(name), axis, &handlers] {
    auto contact = std::make_shared<EvdevContact>(name, axis);
    return [contact, &handlers] {
      const auto touch = contact->wait(evdev_wait_ns);
      if (touch && handlers.touch) handlers.touch(*touch);
    };
  };
}

class RigPanel final : public Panel {
 public:
  explicit RigPanel(PanelHandlers handlers) : handlers_(std::move(handlers)) {}

  const std::vector<std::string>& buttons() const override { return names_; }
  bool has_contact() const override { return has_contact_; }
  bool tells_position() const override { return tells_position_; }
  std::string missing() const override {
    for (const auto* device : {lines_.get(), touch_.get()})
      if (device && !device->missing().empty()) return device->missing();
    return "";
  }
  void simulate(const Press& press) override {
    check_simulated();
    if (handlers_.press) handlers_.press(press);
  }
  void simulate(const Touch& touch) override {
    check_simulated();
    if (handlers_.touch) handlers_.touch(touch);
  }

  std::vector<std::string> names_;
  bool has_contact_ = false, tells_position_ = false;
  PanelHandlers handlers_;
  std::unique_ptr<DeviceWatch> lines_, touch_;

 private:
  void check_simulated() const {
    if (lines_ || touch_) throw std::logic_error("a panel with real devices cannot be simulated");
  }
};

bool take_low(Uri& uri) {
  const std::string active = uri.take("active", "high");
  if (active != "low" && active != "high")
    throw std::invalid_argument("'" + uri.text + "': active=" + active + "; allowed low, high");
  return active == "low";
}

std::int64_t take_refractory(Uri& uri) {
  const std::string refractory = uri.take("refractory_ms", "50");
  char* end = nullptr;
  const double refractory_ms = std::strtod(refractory.c_str(), &end);
  if (*end != '\0' || !(refractory_ms >= 0 && refractory_ms <= 1000))
    throw std::invalid_argument("'" + uri.text + "': refractory_ms=" + refractory + "; allowed 0 to 1000");
  return static_cast<std::int64_t>(refractory_ms * 1e6);
}

void plan_buttons(const std::string& text, RigPanel& panel, LinePanel& plan) {
  Uri uri = parse_uri(text);
  if (uri.scheme == "sim") {
    panel.names_ = {"left", "right"};
    return;
  }
  if (uri.scheme != "gpio")
    throw std::invalid_argument("buttons '" + text + "'; allowed sim: or gpio:left=LINE,right=LINE");
  plan.buttons_low = take_low(uri);
  plan.refractory_ns = take_refractory(uri);
  for (const auto& [name, line] : uri.values) {
    panel.names_.push_back(name);
    plan.requests.push_back({line, "turnpoint-button-" + name, LineUse::input});
  }
  if (panel.names_.empty()) throw std::invalid_argument("buttons '" + text + "' name no line");
}

void plan_contact(const std::string& text, RigPanel& panel, LinePanel& plan) {
  Uri uri = parse_uri(text);
  panel.has_contact_ = true;
  if (uri.scheme == "sim") {
    panel.tells_position_ = true;
  } else if (uri.scheme == "gpio") {
    plan.contact_low = take_low(uri);
    const std::string line = uri.take("line", "");
    plan.contact_refractory_ns = take_refractory(uri);
    uri.check_empty("line, active, refractory_ms");
    if (line.empty()) throw std::invalid_argument("contact '" + text + "' names no line");
    plan.contact = static_cast<int>(plan.requests.size());
    plan.requests.push_back({line, "turnpoint-contact", LineUse::input});
  } else if (uri.scheme == "evdev" && !uri.name.empty()) {
    const std::string axis = uri.take("axis", "x");
    uri.check_empty("axis");
    if (axis != "x" && axis != "y")
      throw std::invalid_argument("'" + text + "': axis=" + axis + "; allowed x, y");
    panel.touch_ =
        std::make_unique<DeviceWatch>(touch_opener(uri.name, axis == "x" ? ABS_X : ABS_Y, panel.handlers_),
                                      evdev_priority, panel.handlers_);
    panel.tells_position_ = true;
  } else {
    throw std::invalid_argument("contact '" + text + "'; allowed sim:, gpio:line=LINE, evdev:NAME");
  }
}

}  // namespace

std::unique_ptr<Panel> watch_lines(OpenLines open, const LinePanel& plan, std::vector<std::string> names,
                                   PanelHandlers handlers) {
  auto panel = std::make_unique<RigPanel>(std::move(handlers));
  panel->names_ = std::move(names);
  panel->has_contact_ = plan.contact >= 0;
  panel->lines_ = std::make_unique<DeviceWatch>(line_opener(std::move(open), plan, panel->handlers_),
                                                panel_priority, panel->handlers_);
  return panel;
}

std::unique_ptr<Panel> open_panel(const std::optional<ButtonsConfig>& buttons,
                                  const std::optional<ContactConfig>& contact, PanelHandlers handlers) {
  auto panel = std::make_unique<RigPanel>(std::move(handlers));
  LinePanel plan;
  if (buttons) plan_buttons(buttons->uri, *panel, plan);
  if (contact) plan_contact(contact->uri, *panel, plan);
  plan.lines = static_cast<int>(plan.requests.size());
  const auto open = [requests = plan.requests] { return open_gpio_lines(requests); };
  if (plan.lines > 0)
    panel->lines_ = std::make_unique<DeviceWatch>(line_opener(open, plan, panel->handlers_), panel_priority,
                                                  panel->handlers_);
  return panel;
}

}  // namespace turnpoint::panel
