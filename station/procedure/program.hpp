#pragma once
#include <memory>

#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// Makes the procedures of the kind "program", which are separate programs. This layer is pure, so it only
/// knows the interface; station/session starts the programs. Such a procedure throws core::ProgramFailed
/// from next() if its program fails. The next call of ready() or next() then starts the program afresh.
class Programs {
 public:
  virtual ~Programs() = default;
  virtual std::unique_ptr<Procedure> procedure(const Spec& spec, const core::DrawKey& key) = 0;
};

/// Stands for programs in simulations that ask only for the number of trials: presents as many trials as
/// "stop" allows, at levels evenly spread from "min" to "max", whatever the answers are.
class StandIns final : public Programs {
 public:
  std::unique_ptr<Procedure> procedure(const Spec& spec, const core::DrawKey& key) override;
};

}  // namespace turnpoint::procedure
