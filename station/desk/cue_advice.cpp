#include "station/desk/cue_advice.hpp"

#include <map>
#include <stdexcept>

namespace turnpoint::desk {

CueAdvice cue_advice(const std::string& cue) {
  struct Keys {
    const char *name, *advice;
  };
  static const std::map<std::string, Keys> all{
      {"pitch", {"cue.pitch", "cue.pitch_advice"}},
      {"loudness", {"cue.loudness", "cue.loudness_advice"}},
      {"amplitude at the wide end", {"cue.amplitude", "cue.amplitude_advice"}},
      {"stripe pitch at the wide end", {"cue.stripes", "cue.stripes_advice"}},
      {"edge sharpness", {"cue.edge", "cue.edge_advice"}},
      {"strip width", {"cue.width", "cue.width_advice"}},
      {"duration", {"cue.duration", "cue.duration_advice"}},
      {"always the same key", {"cue.same_key", "cue.same_key_advice"}}};
  const auto found = all.find(cue);
  if (found == all.end()) throw std::logic_error("there is no advice for the cue \"" + cue + "\"");
  return {{found->second.name, "", {}}, {found->second.advice, "", {}}};
}

}  // namespace turnpoint::desk
