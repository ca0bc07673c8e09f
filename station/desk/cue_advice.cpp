#include "station/desk/cue_advice.hpp"

#include <map>
#include <stdexcept>

namespace turnpoint::desk {

std::string cue_advice(const std::string& cue) {
  static const std::map<std::string, std::string> advice{
      {"pitch",
       "Participants could listen to the tone, or feel the spacing of its ribs, instead of judging the "
       "surface. Choose the place of the mark at random in each trial (by a factor), or use several tones. "
       "Mask the sound with headphones, and run no-touch-control as a control. If pitch is what you "
       "measure, change nothing."},
      {"loudness",
       "Participants could answer by the sound alone. Set rove_dB in the scenes, so that the strength "
       "varies at random, and mask the sound with headphones. Run no-touch-control as a control."},
      {"amplitude at the wide end",
       "A finger at the wide end feels only the strength of the vibration. Set rove_dB in the scenes; 6 dB "
       "usually hides differences of a few dB. If strength is what you measure, change nothing."},
      {"stripe pitch at the wide end",
       "The spacing of the ribs at the wide end reveals the frequency. Choose the place of the mark at "
       "random in each trial, or use several tones, so that the same ribs occur with different answers."},
      {"edge sharpness",
       "How sharp the boundary feels gives the answer. Use the same sharpness in all scenes, or let it "
       "vary at random as a factor of its own."},
      {"strip width",
       "The strip is narrower at one place than at another, so the place gives the answer. Choose the "
       "place of the boundary or the mark at random in each trial, so that each answer occurs at each "
       "place."},
      {"duration",
       "Some intervals last longer than others. Give all scenes of a trial the same duration_s and "
       "ramp_ms."},
      {"always the same key",
       "One answer is right more often than the others. List the levels or the answers equally often, or "
       "set balance, so that always pressing the same key gives no advantage."}};
  const auto found = advice.find(cue);
  if (found == advice.end()) throw std::logic_error("there is no advice for the cue \"" + cue + "\"");
  return found->second;
}

}  // namespace turnpoint::desk
