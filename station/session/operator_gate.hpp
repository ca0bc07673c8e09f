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

/// Whether the session continues or ends here.
enum class Flow { go_on, stop };

/// Handles everything that can hold up a session before its next stimulus: pages that somebody has to leave,
/// an amplifier that the operator has to arm, faults that the operator has to repair, and a full disk. Every
/// input of the session passes through it, and it remembers what has to be handled later.
class OperatorGate {
 public:
  /// All references must outlive this object. `display` may be null.
  OperatorGate(const Setup& setup, const Pages& pages, const trial::Director& director, Stage& stage,
               store::SessionLog& log, Display* display);

  /// Carries out an operator's command and logs the result. A button press is returned as the answer that it
  /// chooses, or as a mere touch.
  Input received(Input input);
  /// Remembers an input that has to be handled once the trial or page is over.
  void note(const Input& input);

  void show(const Page& page);
  /// Shows a page until somebody leaves it, which is not possible before `at_least_s`.
  Flow show_and_wait(Page page, double at_least_s);
  /// Handles inputs that matter on every page: somebody stops the session, or a fault that the operator has
  /// to repair.
  Flow handle_on_page(const Input& input);

  /// Makes sure that rows are on the disk before the session continues. If the disk is full, the screen says
  /// so, the surface stays silent, and the same rows are written once there is space. Operator inputs are
  /// kept in memory meanwhile.
  void keep(const std::function<void()>& write);

  /// Waits until the operator has armed the amplifier; until then the surface stays silent.
  Flow until_armed(const Fault& why);
  /// Before a trial: waits until nothing is left to repair and the amplifier is armed.
  Flow until_clear();
  /// After a fault the screen says what happened. The operator repairs it, clears the fault and arms; then
  /// the session continues. If the operator continues too early, the page says what is still missing.
  Flow recover();
  /// A limit of the rig ends the session. The page names the limit before the summary is shown.
  Flow end_at_limit(const std::string& what);

  /// Ends the session after the current trial or page.
  void stop(const std::string& reason);
  bool stop_asked() const { return stop_asked_; }
  const std::string& stop_reason() const { return stop_reason_; }
  /// True once after the operator has requested a pause.
  bool take_pause();
  /// A fault that nobody has dealt with yet.
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
