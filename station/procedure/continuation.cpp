#include "station/procedure/continuation.hpp"

#include "station/core/number.hpp"
#include "station/core/texts.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

void continue_from(const std::vector<EarlierTrial>& trials, const Spec& spec, Procedure& procedure) {
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto proposal = procedure.next();
    if (!proposal || proposal->level != trials[i].level || proposal->second != trials[i].second)
      throw core::Failure(proposal ? phrase("resume.continue_level", {plain(spec.name), plain(i + 1),
                                                                      plain(core::exact(proposal->level)),
                                                                      plain(core::exact(trials[i].level))})
                                   : phrase("resume.continue_done", {plain(spec.name), plain(i + 1),
                                                                     plain(core::exact(trials[i].level))}));
    procedure.record(trials[i].answer);
  }
}

}  // namespace turnpoint::procedure
