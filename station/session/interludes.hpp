#pragma once
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "station/protocol/interludes.hpp"
#include "station/session/operator_gate.hpp"
#include "station/session/pages.hpp"
#include "station/session/scores.hpp"
#include "station/session/stage.hpp"
#include "station/store/session_log.hpp"

namespace turnpoint::session {

/// What the log of a resumed session contains about interludes and scores.
struct Earlier {
  std::vector<core::EventRow> events;
  std::vector<core::BlockRecord> blocks;
};

/// Runs the interludes before, between and after the blocks: consents, questionnaires, explanations,
/// screenings. Each answer is on the disk before the next question appears, so a session whose process died
/// continues with the next question.
class Interludes {
 public:
  /// Presents an example while `page` is shown.
  using Player = std::function<Flow(const protocol::Example&, Page page)>;

  /// All references must outlive this object. `participant` is null if a person takes part.
  Interludes(const Setup& setup, const Pages& pages, const trial::Director& director, const Scores& scores,
             OperatorGate& gate, Stage& stage, SimulatedParticipant* participant, store::SessionLog& log,
             Player player);

  /// Restores what was answered before the session was resumed.
  void restore(const Earlier& earlier);

  /// Runs the interludes before this block, or those after the last block if there is no such block.
  /// Interludes that are already done are skipped.
  Flow before(int block_index);

  /// Why the session ends before its blocks are done; "" if it does not.
  const std::string& ended_because() const { return ended_because_; }

 private:
  /// What the participant or the operator did on a page; empty if the session stops.
  using Reply = std::optional<Input>;

  Flow run(const protocol::Interlude& interlude);
  Flow ask_items(const protocol::Interlude& interlude);
  Flow consent(const protocol::Interlude& interlude);
  Flow explain(const protocol::Interlude& interlude);
  Flow screen(const protocol::Interlude& interlude);
  Flow end(const protocol::Interlude& interlude, const std::string& reason);
  Reply reply(const Page& page, const std::function<bool(const Input&)>& accepts);
  std::optional<Reply> ask(const protocol::Interlude& interlude, std::size_t index, bool back);
  void simulate_answer(const protocol::Interlude& interlude, std::size_t index);
  void simulate(input::Any content);
  void keep_answer(const protocol::Interlude& interlude, const std::string& item, const std::string& answer,
                   double response_time_s);
  /// The items of this questionnaire that have been answered since the last block, in the order of the
  /// answers.
  std::vector<std::string> given(const protocol::Interlude& interlude) const;
  protocol::Answers answers() const;

  const Setup& setup_;
  const Pages& pages_;
  const trial::Director& director_;
  const Scores& scores_;
  OperatorGate& gate_;
  Stage& stage_;
  SimulatedParticipant* participant_;
  store::SessionLog& log_;
  Player player_;
  const protocol::Visit visit_;
  const std::vector<protocol::Block> blocks_;
  std::vector<core::AnswerRow> standing_;
  std::set<std::string> done_;  ///< the interludes that are done, named by core::place_name()
  int occasion_ = 0;
  std::string ended_because_;
};

}  // namespace turnpoint::session
