#pragma once
#include <string>
#include <vector>

#include "station/protocol/key_places.hpp"
#include "station/protocol/protocol.hpp"
#include "station/protocol/sources.hpp"

// The parts of advice(), which warns about likely mistakes in a protocol. Each function is for one subject.
namespace turnpoint::protocol {

/// Collects advice on a protocol, each piece at the line of its key.
struct AdviceList {
  explicit AdviceList(const Protocol& of) : protocol(of), places(of.source, of.path) {}

  void add(const std::string& key, const core::Phrase& what, const core::Phrase& allowed = {}) {
    found.push_back({places.of(key), what, allowed});
  }

  const Protocol& protocol;
  const KeyPlaces places;
  std::vector<core::Problem> found;
};

/// The fastest responses to touch take about 0.15 s, so nobody can reliably meet a deadline shorter than
/// this.
constexpr double shortest_deadline_s = 0.2;

/// The path in KeyPlaces of a procedure's key, such as `procedure.levels.start` for the procedure named
/// `levels`.
inline std::string key_of(const procedure::Spec& spec, const std::string& key) {
  return "procedure." + (spec.family.empty() ? spec.name : spec.family) + "." + key;
}

/// The path in KeyPlaces of a key of a block or sequence: `block.main.trials` or
/// `sequence.main.block.trials`.
std::string key_of(const std::variant<Block, Sequence>& part, const std::string& key);

/// The path of the key that sets the levels of a procedure.
std::string levels_key(const procedure::Spec& spec);

/// The proportion correct of a participant who guesses.
double chance(const Protocol& protocol);

/// Compares levels with tolerances, steps and limits; finds factors, scenes and procedures that nothing uses.
void advise_on_levels(AdviceList& advice);
/// Checks which answers are right and how often, also in practice and catch trials.
void advise_on_answers(AdviceList& advice);
/// Finds times that seem to be in the wrong unit, deadlines that are too short, and events that come too
/// late.
void advise_on_times(AdviceList& advice);
/// Checks the grids, rates, thresholds and stopping rules of procedures.
void advise_on_grids(AdviceList& advice);
/// Checks blocks, instructions, labels, questions, and the analysis. Of a file with several tasks, the whole
/// protocol is asked for what concerns all of them, and the protocol as one of them sees it for the rest.
void advise_on_plan(AdviceList& advice);
/// Finds labels of answers that are too long for a small screen.
void advise_on_labels(AdviceList& advice);
/// Finds questions that ask for what identifies a person, and answers that look the same.
void advise_on_interludes(AdviceList& advice);

}  // namespace turnpoint::protocol
