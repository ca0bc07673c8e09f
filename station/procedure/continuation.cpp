#include "station/procedure/continuation.hpp"

#include <stdexcept>

#include "station/text/number.hpp"

namespace turnpoint::procedure {

void continue_from(const std::vector<EarlierTrial>& trials, const Spec& spec, Procedure& procedure) {
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto proposal = procedure.next();
    if (!proposal || proposal->level != trials[i].level || proposal->second != trials[i].second)
      throw std::runtime_error(
          "procedure \"" + spec.name + "\" cannot continue: in trial " + std::to_string(i + 1) +
          " of the earlier sessions it " +
          (proposal ? "would present level " + text::exact(proposal->level) : std::string("would be done")) +
          ", but level " + text::exact(trials[i].level) +
          " is stored; the procedure was changed without raising the version of the protocol, or this "
          "program "
          "has changed");
    procedure.record(trials[i].answer);
  }
}

}  // namespace turnpoint::procedure
