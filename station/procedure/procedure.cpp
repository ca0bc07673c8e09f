#include "station/procedure/procedure.hpp"

#include <stdexcept>

#include "station/procedure/adjustment.hpp"
#include "station/procedure/constant_stimuli.hpp"
#include "station/procedure/quest_plus.hpp"
#include "station/procedure/staircase.hpp"

namespace turnpoint::procedure {

void Procedure::record_setting(double) {
  throw std::logic_error("procedure: only an adjustment takes a setting");
}

std::unique_ptr<Procedure> make_procedure(const Spec& spec, const Context& context, const random::Key& key) {
  if (const auto faults = validate(spec); !faults.empty())
    throw std::invalid_argument("procedure " + spec.name + ": " + faults.front().key + ": " +
                                faults.front().what + "; " + faults.front().allowed);
  switch (spec.kind) {
    case Kind::constant_stimuli:
      return std::make_unique<ConstantStimuli>(spec, context, key);
    case Kind::adjustment:
      return std::make_unique<Adjustment>(spec, context, key);
    case Kind::up_down:
    case Kind::weighted_up_down:
      return std::make_unique<Staircase>(spec, context);
    case Kind::quest_plus:
    case Kind::psi:
    case Kind::psi_marginal:
      return std::make_unique<QuestPlus>(spec);
  }
  throw std::invalid_argument("procedure " + spec.name + ": " + name(spec.kind) +
                              " is not a kind of procedure");
}

}  // namespace turnpoint::procedure
