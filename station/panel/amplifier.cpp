#include "station/panel/amplifier.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "station/drive/monotonic.hpp"
#include "station/drive/rights.hpp"
#include "station/panel/guard.hpp"
#include "station/panel/guarded_amplifier.hpp"
#include "station/panel/simulated_lines.hpp"
#include "station/panel/uri.hpp"

namespace turnpoint::panel {
namespace {

constexpr int guard_priority = 75;
constexpr std::int64_t look_again_ns = 100'000'000;

class GuardedAmplifier final : public drive::Amplifier {
 public:
  GuardedAmplifier(OpenLines open, const GuardLines& roles) : open_(std::move(open)), roles_(roles) {
    take_up();
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  ~GuardedAmplifier() override {
    thread_.request_stop();
    thread_.join();
    drive_low();
  }

  void arm() override { carry_out("armed", &Guard::arm); }
  void enable() override { carry_out("enabled", &Guard::enable); }
  void clear() override {
    const std::lock_guard lock(mutex_);
    check_guarded();
    if (const std::string why = guard_.clear(); !why.empty())
      throw std::runtime_error("amplifier: cannot be cleared: " + why);
  }
  void disarm() noexcept override {
    const std::lock_guard lock(mutex_);
    guard_.disarm();
    drive_low();
  }
  void disable() noexcept override {
    const std::lock_guard lock(mutex_);
    guard_.disable();
    drive_low();
  }
  void trip(std::string_view reason) noexcept override {
    const std::lock_guard lock(mutex_);
    guard_.trip(drive::monotonic_ns(), reason);
    drive_low();
  }
  void audio_alive() noexcept override { audio_ns_.store(drive::monotonic_ns()); }
  void session_alive() noexcept override { session_ns_.store(drive::monotonic_ns()); }

  drive::AmplifierState state() const noexcept override {
    const std::lock_guard lock(mutex_);
    return guard_.state();
  }
  std::string fault() const override {
    const std::lock_guard lock(mutex_);
    return guard_.fault();
  }
  std::int64_t fault_time_ns() const noexcept override {
    const std::lock_guard lock(mutex_);
    return guard_.fault_time_ns();
  }
  std::int64_t reaction_ns() const noexcept override { return reaction_ns_.load(); }

 private:
  void carry_out(const char* what, std::string (Guard::*step)(std::int64_t)) {
    const std::lock_guard lock(mutex_);
    check_guarded();
    const std::int64_t now = drive::monotonic_ns();
    take_signs();
    if (const std::string why = (guard_.*step)(now); !why.empty())
      throw std::runtime_error(std::string("amplifier: cannot be ") + what + ": " + why);
    lines_->drive(roles_.enable, guard_.outputs().enable);
  }

  // An amplifier that nobody can watch stays off.
  void check_guarded() const {
    if (!lines_) throw std::runtime_error("amplifier: its lines are gone (" + gone_ + ")");
  }

  void take_signs() noexcept {
    if (const auto at = audio_ns_.load(); at >= 0) guard_.audio_alive(at);
    if (const auto at = session_ns_.load(); at >= 0) guard_.session_alive(at);
  }

  // A line that cannot be driven belongs to a chip that is gone; the thread finds that out by itself.
  void drive_low() noexcept {
    try {
      if (lines_) lines_->drive(roles_.enable, 0);
    } catch (const std::exception&) {
    }
  }

  bool fault_at(bool level) const noexcept { return level != roles_.fault_active_low; }
  bool stop_at(bool level) const noexcept { return level != roles_.stop_active_low; }

  // Lines that are low, and what was pressed or faulty before.
  void take_up() {
    auto lines = open_();
    lines->drive(roles_.enable, 0);
    const std::lock_guard lock(mutex_);
    const std::int64_t now = drive::monotonic_ns();
    if (roles_.fault >= 0) guard_.fault_line(now, fault_at(lines->level(roles_.fault)));
    if (roles_.stop >= 0) guard_.stop_line(now, stop_at(lines->level(roles_.stop)));
    lines_ = std::move(lines);
  }

  // Without its lines the guard cannot guard: the heartbeat ends, and what monitors it outside acts.
  void let_go(const std::string& why) {
    const std::lock_guard lock(mutex_);
    guard_.trip(drive::monotonic_ns(), "its lines are gone: " + why);
    gone_ = why;
    lines_.reset();
  }

  // The line goes low first; only then are locks taken and reasons kept.
  void edge(const Edge& edge) {
    const bool fault = edge.line == roles_.fault;
    const bool active = fault ? fault_at(edge.rising) : stop_at(edge.rising);
    if (active) {
      lines_->drive(roles_.enable, 0);
      reaction_ns_.store(drive::monotonic_ns() - edge.time_ns);
    }
    const std::lock_guard lock(mutex_);
    fault ? guard_.fault_line(edge.time_ns, active) : guard_.stop_line(edge.time_ns, active);
    lines_->drive(roles_.enable, guard_.outputs().enable);
  }

  void beat() {
    const std::lock_guard lock(mutex_);
    take_signs();
    guard_.tick(drive::monotonic_ns());
    lines_->drive(roles_.enable, guard_.outputs().enable);
    if (roles_.heartbeat >= 0) lines_->drive(roles_.heartbeat, guard_.outputs().heartbeat);
  }

  // Edges until the next beat, and then the beat.
  void watch() {
    const auto seen = lines_->wait(std::max<std::int64_t>(0, beat_ns_ - drive::monotonic_ns()));
    if (seen) edge(*seen);
    if (drive::monotonic_ns() < beat_ns_) return;
    beat();
    const std::lock_guard lock(mutex_);
    beat_ns_ = guard_.next_tick_ns();
  }

  void run(const std::stop_token& stop) noexcept {
    static_cast<void>(drive::become_realtime(guard_priority));
    while (!stop.stop_requested()) {
      try {
        if (lines_) {
          watch();
        } else {
          drive::sleep_until_ns(drive::monotonic_ns() + look_again_ns);
          take_up();
        }
      } catch (const std::exception& error) {
        let_go(error.what());
      }
    }
  }

  OpenLines open_;
  GuardLines roles_;
  mutable std::mutex mutex_;
  std::unique_ptr<Lines> lines_;  ///< none while they are gone; the guard's thread alone changes that, locked
  Guard guard_;
  std::string gone_;  ///< why
  std::int64_t beat_ns_ = 0;
  std::atomic<std::int64_t> audio_ns_{-1}, session_ns_{-1}, reaction_ns_{-1};
  std::jthread thread_;
};

bool is_low(const std::string& value, const Uri& uri) {
  if (value != "low" && value != "high")
    throw std::invalid_argument("'" + uri.text + "': '" + value + "'; allowed low, high");
  return value == "low";
}

}  // namespace

std::unique_ptr<drive::Amplifier> guard_amplifier(OpenLines open, const GuardLines& roles) {
  return std::make_unique<GuardedAmplifier>(std::move(open), roles);
}

std::unique_ptr<drive::Amplifier> open_amplifier(const std::string& text) {
  Uri uri = parse_uri(text);
  if (uri.scheme == "sim" && uri.name.empty() && uri.values.empty())
    return guard_amplifier([] { return std::make_unique<SimulatedLines>(4); }, {0, 1, 2, 3, false, false});
  if (uri.scheme != "gpio" || !uri.name.empty())
    throw std::invalid_argument("amplifier '" + text +
                                "'; allowed sim: or gpio:enable=LINE,fault=LINE,stop=LINE,heartbeat=LINE");
  GuardLines roles;
  std::vector<LineRequest> requests;
  const auto want = [&](const char* key, const char* consumer, LineUse use) {
    const std::string line = uri.take(key, "");
    if (line.empty()) return -1;
    requests.push_back({line, consumer, use});
    return static_cast<int>(requests.size()) - 1;
  };
  roles.enable = want("enable", "turnpoint-amp-enable", LineUse::output_low);
  roles.heartbeat = want("heartbeat", "turnpoint-amp-heartbeat", LineUse::output_low);
  roles.fault = want("fault", "turnpoint-amp-fault", LineUse::input);
  roles.stop = want("stop", "turnpoint-amp-stop", LineUse::input);
  const std::string active = uri.take("active", "high");
  roles.fault_active_low = is_low(uri.take("fault_active", active), uri);
  roles.stop_active_low = is_low(uri.take("stop_active", active), uri);
  uri.check_empty("enable, heartbeat, fault, stop, active, fault_active, stop_active");
  if (roles.enable < 0) throw std::invalid_argument("amplifier '" + text + "' has no enable line");
  return guard_amplifier([requests] { return open_gpio_lines(requests); }, roles);
}

}  // namespace turnpoint::panel
