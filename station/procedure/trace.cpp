#include "station/procedure/trace.hpp"
#include "station/core/usage_error.hpp"

namespace turnpoint::procedure {

Trace trace(const Spec& spec, const Context& context, const std::string& answers, const core::DrawKey& key) {
  const auto procedure = make_procedure(spec, context, key);
  Trace trace;
  for (const char c : answers) {
    if (c != '0' && c != '1')
      throw core::UsageError("answers: \"" + std::string(1, c) + "\" is not an answer; 1 and 0 are allowed");
    const auto proposal = procedure->next();
    if (!proposal)
      throw core::UsageError("answers: " + std::to_string(answers.size()) + " were given, but procedure " +
                             spec.name + " stops after " + std::to_string(trace.levels.size()));
    trace.levels.push_back(proposal->level);
    if (proposal->second) trace.second.push_back(*proposal->second);
    procedure->record(c == '1' ? Answer::one : Answer::zero);
  }
  if (const auto next = procedure->next()) trace.next = next->level, trace.next_second = next->second;
  trace.estimates = procedure->estimates();
  trace.entropy_nats = procedure->entropy_nats();
  trace.reversals = procedure->reversals();
  return trace;
}

}  // namespace turnpoint::procedure
