#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "station/core/records.hpp"
#include "station/session/page.hpp"

namespace endurance {

/// Descriptions of violations. A run with an empty list has passed.
using Violations = std::vector<std::string>;

/// Watches the amplifier's line from outside, by rules of its own. It knows the line, the events in the room,
/// the operator's actions and the page on the screen, but none of the program's states. Times are world times
/// in ns and never go back.
///
/// The line must be low unless all of these hold: an operator has armed since power-on and since the last
/// fault, stop or disarming; no cause of a fault is present; and a trial is on the screen, or was until at
/// most 250 ms ago. During a stimulus that is answered, the line must be high.
class AmplifierWatch {
 public:
  explicit AmplifierWatch(Violations& violations) : violations_(violations) {}

  void line(std::int64_t time_ns, bool high);
  /// The station's process begins: no trial is in progress, and the enable line must be low until the
  /// amplifier is armed.
  void begin(std::int64_t time_ns);
  /// A fault begins: the enable line must be low until the amplifier is armed again.
  void cause(std::int64_t time_ns, const std::string& what);
  void lasts(const std::string& what) { present_.insert(what); }
  void over(const std::string& what) { present_.erase(what); }
  void armed(std::int64_t time_ns);  ///< the station accepted the operator's command to arm
  void page(std::int64_t time_ns, turnpoint::session::PageKind kind);
  void stimulus(std::int64_t on_ns, std::int64_t off_ns) { stimuli_.emplace_back(on_ns, off_ns); }
  /// A trial has ended. If it was answered, the enable line must have been high during its stimuli.
  void trial_ended(std::int64_t time_ns, bool answered, std::int64_t answered_ns);

  int changes() const { return changes_; }
  double high_s() const { return 1e-9 * static_cast<double>(high_ns_); }

 private:
  void check(std::int64_t until_ns);
  bool must_be_low() const;
  std::string why_low() const;

  Violations& violations_;
  std::set<std::string> present_;
  std::string last_cause_ = "power came on";
  bool armed_ = false, high_ = false, told_ = false;
  bool trial_page_ = false;
  std::int64_t page_ns_ = 0, on_since_ns_ = 0, low_since_ns_ = 0, now_ns_ = 0, high_ns_ = 0;
  /// start and end of each stimulus of the current trial, and of each time in it when the line was high
  std::vector<std::pair<std::int64_t, std::int64_t>> stimuli_, highs_;
  int changes_ = 0;
};

/// Remembers every trial that was reported as stored, and looks for it in the database.
class TrialWatch {
 public:
  explicit TrialWatch(Violations& violations) : violations_(violations) {}

  void acknowledged(const std::string& session_id, const turnpoint::core::TrialRow& row);
  /// Call after each death and each end of a session: checks that the database is sound and contains every
  /// acknowledged trial unchanged.
  void check(const std::string& database, const std::string& when);
  /// Checks that the experimental trials of a finished session equal those of a session without faults.
  void compare(const std::string& database, const std::string& session_id, const std::string& unbroken);
  void new_database() { kept_.clear(); }

  int total() const { return total_; }
  int lost() const { return lost_; }

 private:
  Violations& violations_;
  std::map<std::pair<std::string, int>, std::string> kept_;
  int total_ = 0, lost_ = 0;
};

/// Samples the memory use of this process during a run.
class MemoryWatch {
 public:
  void sample();
  /// Peak memory use of the second half of the run minus that of the first half, in MiB; 0 with fewer than
  /// eight samples.
  double growth_MiB() const;
  double last_MiB() const { return samples_.empty() ? 0 : samples_.back(); }
  std::size_t samples() const { return samples_.size(); }

 private:
  std::vector<double> samples_;
};

}  // namespace endurance
