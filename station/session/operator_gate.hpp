#pragma once
#include <functional>
#include <optional>
#include <string>

#include "station/session/pages.hpp"
#include "station/session/session.hpp"
#include "station/session/stage.hpp"
#include "station/store/session_log.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::session {

/// Whether the session goes on or ends here.
enum class Flow { go_on, stop };

/// What stands between a session and its next stimulus: pages that somebody has to leave, an amplifier that
/// the operator has to arm, faults that the operator has to repair, a disk that has to have space. Every
/// input of the session passes it, and it remembers what has to be acted on.
class OperatorGate {
 public:
  /// All must outlive it. `display` may be null.
  OperatorGate(const Setup& setup, const Pages& pages, const trial::Director& director, Stage& stage,
               store::SessionLog& log, Display* display);

  /// Carries out the operator's commands and logs the result. A button press is returned as the answer that
  /// it chooses, or as a mere touch.
  Input received(Input input);
  /// Remembers what has to be handled once the trial or page is over.
  void note(const Input& input);

  void show(const Page& page);
  /// Shows a page until it is left, which it cannot be before `at_least_s`.
  Flow show_and_wait(Page page, double at_least_s);
  /// What concerns every page: somebody stops, or something fails and the operator has to repair it.
  Flow handle_on_page(const Input& input);

  /// Makes rows durable before the session continues. If the disk is full, the screen says so, nothing
  /// sounds, and the same rows are written once there is space. Operator inputs are kept in memory meanwhile.
  void keep(const std::function<void()>& write);

  /// Waits until the operator has armed the amplifier; nothing sounds before.
  Flow until_armed(const Fault& why);
  /// Holds until nothing is left to repair and the amplifier is armed: before a trial.
  Flow until_clear();
  /// After a fault: the screen says what happened; the operator repairs it, clears and arms; then the session
  /// goes on. Somebody who continues too early sees what is still missing.
  Flow recover();
  /// A limit of the rig ends the session. The page names the limit before the summary is shown.
  Flow end_at_limit(const std::string& what);

  /// The session ends when what runs now is over.
  void stop(const std::string& reason);
  bool stop_asked() const { return stop_asked_; }
  const std::string& stop_reason() const { return stop_reason_; }
  /// True once after the operator has asked for a pause.
  bool take_pause();
  /// What happened and was not dealt with yet.
  const std::optional<Fault>& fault() const { return fault_; }
  void set_fault(const std::optional<Fault>& fault) { fault_ = fault; }

 private:
  void log(const Input& input);
  bool space_again(const std::string& detail);
  bool armed() const;

  const Setup& setup_;
  const Pages& pages_;
  const trial::Director& director_;
  Stage& stage_;
  store::SessionLog& log_;
  Display* display_;
  bool stop_asked_ = false, pause_asked_ = false;
  std::string stop_reason_;
  std::optional<Fault> fault_;
};

}  // namespace turnpoint::session
