#include <algorithm>

#include "station/session/session_run.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::session {

namespace {

// Time between pressing the example's button and the stimulus: the participant needs it to move the finger to
// the surface.
constexpr std::int64_t kToSurface_ns = 800'000'000;

}  // namespace

/// Presents an example of an explanation, under the same limits and with the same amplifier guard as a trial.
/// An example that is interrupted is not repeated: the participant can press its button again.
Flow SessionRun::play_example(const protocol::Example& example, Page page) {
  trial::TrialSpec spec;
  spec.block_index = director_.block_index();
  spec.trial_in_block = -++examples_;
  spec.factors = example.with;
  spec.intervals = {{example.scene}};
  spec.rove_dB = {0};
  spec.length_s = example.duration_s;
  if (prepare_trial(spec) == Flow::stop) return Flow::stop;
  if (open_amplifier()) return gate_.recover();
  gate_.show(page);
  const auto onsets = stage_->present(plans_.take(spec).bursts, stage_->now_ns() + kToSurface_ns);
  if (!onsets.empty()) {
    const auto on_ns = onsets.front().time_ns;
    auto off_ns = on_ns + static_cast<std::int64_t>(1e9 * example.duration_s);
    while (stage_->now_ns() < off_ns) {
      auto waited = stage_->wait_until(off_ns);
      if (!waited) continue;
      const auto input = gate_.received(std::move(*waited));
      gate_.note(input);
      if (gate_.stop_asked() || gate_.fault() || input.kind == InputKind::pause) {
        off_ns = std::min(off_ns, stage_->silence(false));
        break;
      }
    }
    if (off_ns > on_ns) account_.add(on_ns, off_ns);
  }
  stage_->close_amplifier();
  if (gate_.stop_asked()) return Flow::stop;
  if (gate_.fault() && gate_.recover() == Flow::stop) return Flow::stop;
  return gate_.pause_if_asked();
}

}  // namespace turnpoint::session
