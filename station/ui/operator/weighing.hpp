#pragma once
#include <array>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "station/maintenance/force_weights.hpp"

namespace turnpoint::ui {

/// Passes questions and answers between a page and the calibration of the force cells with dead weights,
/// which runs on another thread.
class Weighing {
 public:
  enum class Answer { read, leave_out, stop };

  /// What the page shows while it waits for an answer.
  struct Shown {
    /// what the operator is asked to do; empty while the cells are read
    std::optional<maintenance::WeightStep> step;
    core::Phrase trouble;  ///< why a reading failed; the step can then not be left out
    /// what the cells read now: in thousandths of the excitation, or in the unit of a converter that has no
    /// excitation to compare with
    std::array<double, 3> cells{};
    bool converter = false;
    core::Phrase unread;  ///< why they cannot be read now; usually ""
  };
  using Show = std::function<void(Shown)>;

  /// Answers the current question. May be called on any thread.
  void answer(Answer answer);

  /// Runs the calibration, which asks for each weight in turn. Returns nothing if the operator or `stop`
  /// ended it. Throws what maintenance::weigh() throws.
  std::optional<maintenance::ForceResult> run(const rig::Rig& rig, const Show& show,
                                              const std::stop_token& stop);

 private:
  /// Waits for an answer, and shows the reading of the cells meanwhile.
  Answer await(maintenance::BridgeReader& bridges, Shown shown, const Show& show,
               const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<Answer> answer_;
};

}  // namespace turnpoint::ui
