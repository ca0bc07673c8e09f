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

/// Whether the session continues or ends.
enum class Flow { go_on, stop };

/// Handles everything that can delay the next stimulus of a session: pages that stay until somebody presses
/// Continue, an amplifier that the operator has to arm, faults that the operator has to repair, and a full
/// disk. All inputs of the session pass through this object. It remembers inputs that have to be handled
/// later.
class OperatorGate {
 public:
  /// All references must outlive this object. `display` may be null.
  OperatorGate(const Setup& setup, const Pages& pages, const trial::Director& director, Stage& stage,
               store::SessionLog& log, Display* display);

  /// Carries out an operator's command and logs every input with its result. Returns the input; a button
  /// press is returned as the answer that the button chooses, or as a mere touch if it chooses none.
  Input received(Input input);
  /// Remembers an input that has to be handled after the current trial or page.
  void note(const Input& input);

  void show(const Page& page);
  /// Shows a page until somebody leaves it. The page cannot be left before `at_least_s` have passed.
  Flow show_and_wait(Page page, double at_least_s);
  /// Handles an input that comes while `page` is shown and no trial runs: somebody stops or pauses the
  /// session, or a fault occurs that the operator has to repair. Then shows `page` again if another page has
  /// covered it.
  Flow handle_on_page(const Page& page, const Input& input);

  /// Calls `write` until its rows are on the disk; only then does the session continue. If the disk is full,
  /// the screen says so and the surface stays silent. The same rows are written again when somebody has freed
  /// space. Operator inputs are kept in memory meanwhile. Once the program has been asked to quit,
  /// it does not wait for anybody to free space: it throws StoreError (disk_full), which says what is stored.
  void keep(const std::function<void()>& write);

  /// Waits until the operator has armed the amplifier. Until then the surface stays silent.
  Flow until_armed(const Fault& why);
  /// Call this before each trial. Waits until all faults are repaired, the amplifier is armed, and every
  /// pause that somebody has asked for is over.
  Flow until_clear();
  /// After a fault: the screen says what happened, and the operator repairs the fault, clears it and arms the
  /// amplifier. Then the session continues. If the operator presses Continue too early, the page says what is
  /// still missing.
  Flow recover();
  /// Says what the self-test found, and waits until the operator writes a note with the reason to continue.
  /// Returns "" if somebody stops the session instead, and in simulated sessions, in which nobody could
  /// answer.
  std::string reason_to_continue(const Fault& why);
  /// Ends the session because a limit of the rig was reached. A page names the limit before the summary is
  /// shown.
  Flow end_at_limit(const std::string& what);

  /// Ends the session after the current trial or page.
  void stop(const std::string& reason);
  bool stop_asked() const { return stop_asked_; }
  const std::string& stop_reason() const { return stop_reason_; }
  /// If somebody has asked for a pause, shows the pause page until somebody presses Continue.
  Flow pause_if_asked();
  /// The latest fault, if nobody has dealt with it yet.
  const std::optional<Fault>& fault() const { return fault_; }
  /// Number of pages so far that interrupted the session: those of a pause or a fault.
  int holds() const { return holds_; }
  void set_fault(const std::optional<Fault>& fault) { fault_ = fault; }

 private:
  Flow interrupt(const Page& page, const Input& input);
  void log(const Input& input);
  bool space_again(const std::string& detail);
  bool armed() const;

  const Setup& setup_;
  const Pages& pages_;
  const trial::Director& director_;
  Stage& stage_;
  store::SessionLog& log_;
  Display* display_;
  int shows_ = 0;  ///< number of pages shown
  int holds_ = 0;
  bool stop_asked_ = false, pause_asked_ = false;
  bool quitting_ = false;  ///< the program has been asked to quit, so no page waits for an answer
  std::string stop_reason_;
  std::optional<Fault> fault_;
};

}  // namespace turnpoint::session
