#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/simulation/observer.hpp"
#include "station/trial/director.hpp"
#include "station/trial/machine.hpp"

namespace turnpoint::trial {

/// The moment from which response times of a trial are counted. In a block in which the finger only strokes
/// the surface, it is the end of the interval, because the movement is judged then.
core::ResponseZero zero_of(const protocol::Protocol& protocol, const TrialSpec& spec);

/// How long the page shows what comes, before the first stimulus of a trial.
double cue_s(const protocol::Protocol& protocol, const TrialSpec& spec);

/// Stands for the interval of a part that comes before the first interval.
inline constexpr int kBeforeIntervals = -1;

/// One part of a trial's intervals: what the surface presents without a pause. An interval of a single scene
/// is one part.
struct Part {
  /// the interval to which it belongs: an index of TrialSpec::intervals, or kBeforeIntervals
  int interval = 0;
  double silence_s = 0;  ///< silence before it, from the end of the part before
  double length_s = 0;
  /// Its scenes. A buzz (a response signal on the surface) counts as a scene; after it, the scene before it
  /// comes again.
  std::vector<std::string> scenes;
  /// times from its onset at which its second and later scenes begin, each with a transition from the scene
  /// before
  std::vector<double> starts_s, transitions_s;
  std::size_t changes = 0;  ///< number of changes of scene without those of a buzz
};
/// All parts of a trial, in the order of presentation.
std::vector<Part> parts_of(const protocol::Protocol& protocol, const TrialSpec& spec);

/// When a simulated participant does what it does, given the onset of the last part. If response times
/// count from the finger's contact, the finger touches the surface soon after the onset; if they count from
/// its lift-off, it is lifted when the interval ends.
struct SimulatedTimes {
  std::int64_t zero_ns = 0;    ///< from which response times count
  std::int64_t slider_ns = 0;  ///< from which the slider is moved: the onset of the last scene
  std::optional<std::int64_t> touch_ns, lift_ns;
  std::int64_t open_ns =
      0;  ///< from which answers are taken; a participant who knows the answer earlier waits
};
SimulatedTimes simulated_times(const protocol::Protocol& protocol, const TrialSpec& spec, const Part& last,
                               std::int64_t onset_ns);

/// How long after the onset of an interval of this length the simulated finger touches the surface.
double reach_s(double length_s);

/// What the simulated participant does then, in order of time: asks for the intervals again, if they have
/// been presented again fewer times than it wants, or else answers.
std::vector<Event> simulated_events(const SimulatedTimes& times, const simulation::Reply& reply,
                                    int presented_again = 0);

/// What the simulated participant does in an adjustment, in order of time, besides moving the slider: asks
/// for the intervals again, or presses Done.
std::vector<Event> simulated_events(const SimulatedTimes& times, const TrialSpec& spec,
                                    const simulation::Setting& setting, int presented_again);

/// When the simulated participant presses Done: never before answers count.
std::int64_t simulated_done_ns(const SimulatedTimes& times, const TrialSpec& spec, double done_s);

/// `parts` are those of the trial.
Timing timing_of(const protocol::Protocol& protocol, const protocol::Block& block, const TrialSpec& spec,
                 const std::vector<Part>& parts);

/// Returns the time from the onset of the last part to the response signal, if the signal is part of the
/// stimulus (a tone or a buzz).
std::optional<double> signal_in_stimulus_s(const protocol::Protocol& protocol, const TrialSpec& spec);

}  // namespace turnpoint::trial
