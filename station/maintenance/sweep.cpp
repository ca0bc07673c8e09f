#include <fmt/format.h>

#include <cmath>

#include "station/drive/engine.hpp"
#include "station/maintenance/calibrate.hpp"
#include "station/maintenance/play_armed.hpp"
#include "station/session/stage.hpp"
#include "station/terms/usage_error.hpp"

namespace turnpoint::maintenance {

namespace {

drive::Burst burst_of(const SweepStep& step, int rate_Hz) {
  drive::Burst burst;
  burst.start_frame = std::llround(step.start_s * rate_Hz);
  burst.length_frames = std::llround(step.length_s * rate_Hz);
  burst.ramp.frames = std::min(std::llround(0.05 * rate_Hz), static_cast<long long>(burst.length_frames / 2));
  burst.tones.count = 1;
  burst.tones.tones[0] = {step.frequency_Hz, step.full_scale, 0, step.channel};
  return burst;
}

/// Renders each tone exactly at its planned frame, so that a vibrometer can find the tones by their times.
void render(drive::SynchronousStream& stream, const std::vector<drive::Burst>& bursts) {
  for (const auto& burst : bursts) {
    stream.schedule(burst);
    stream.advance(burst.start_frame + burst.length_frames - stream.frame());
    while (stream.poll()) {
    }
  }
  stream.advance(stream.config().output.rate_Hz / 2);
  stream.finish();
}

}  // namespace

std::vector<SweepStep> sweep_plan(const rig::Rig& rig, const SweepOptions& options) {
  if (options.points < 5) throw terms::UsageError("sweep: there must be at least 5 points");
  if (!(options.full_scale > 0 && options.full_scale <= 1))
    throw terms::UsageError(fmt::format(
        "sweep: the amplitude must be above 0 and at most 1 (full scale), not {}", options.full_scale));
  if (!(options.length_s >= 0.2 && options.pause_s >= 0.2))
    throw terms::UsageError("sweep: tones and pauses must last 0.2 s or more");
  if (options.length_s > rig.limits.duty * (options.length_s + options.pause_s))
    throw terms::UsageError(
        fmt::format("sweep: the pauses must be longer, because the rig's limit on the duty cycle is {}",
                    rig.limits.duty));
  std::vector<SweepStep> steps;
  for (const auto& transducer : rig.transducers)
    for (int k = 0; k < options.points; ++k) {
      const double f_Hz =
          transducer.low_Hz + (transducer.high_Hz - transducer.low_Hz) * k / (options.points - 1);
      steps.push_back({transducer.name, transducer.channel, f_Hz, options.full_scale,
                       static_cast<double>(steps.size()) * (options.length_s + options.pause_s),
                       options.length_s});
    }
  return steps;
}

std::string to_csv(const std::vector<SweepStep>& steps) {
  std::string csv = "transducer,frequency_Hz,full_scale,start_s,length_s\n";
  for (const auto& step : steps)
    csv += fmt::format("{},{:.3f},{},{:.3f},{:.3f}\n", step.transducer, step.frequency_Hz, step.full_scale,
                       step.start_s, step.length_s);
  return csv;
}

void play_sweep(const rig::Rig& rig, const std::vector<SweepStep>& steps, const std::string& uri) {
  auto config = session::stream_of(rig);
  config.output.uri = uri;
  std::vector<drive::Burst> bursts;
  for (const auto& step : steps) bursts.push_back(burst_of(step, config.output.rate_Hz));
  if (uri.starts_with("alsa:")) {
    play_armed(rig, uri, bursts);
  } else {
    render(*drive::open_synchronous(config), bursts);
  }
}

}  // namespace turnpoint::maintenance
