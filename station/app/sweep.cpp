#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "station/app/calibrate.hpp"
#include "station/app/stop_signals.hpp"
#include "station/drive/engine.hpp"
#include "station/drive/monotonic.hpp"
#include "station/panel/amplifier.hpp"
#include "station/session/stage.hpp"

namespace turnpoint::app {

namespace {

constexpr double kLead_s = 0.5, kMargin_s = 0.25;
constexpr std::int64_t kPoll_ns = 5'000'000;

drive::Burst burst_of(const SweepStep& step, int rate_Hz) {
  drive::Burst burst;
  burst.length_frames = std::llround(step.length_s * rate_Hz);
  burst.ramp.frames = std::min(std::llround(0.05 * rate_Hz), static_cast<long long>(burst.length_frames / 2));
  burst.tones.count = 1;
  burst.tones.tones[0] = {step.frequency_Hz, step.full_scale, 0, step.channel};
  return burst;
}

/// Every tone at its own absolute frame, so that a vibrometer may count time.
void render(drive::SynchronousStream& stream, const std::vector<SweepStep>& steps, int rate_Hz) {
  for (const auto& step : steps) {
    auto burst = burst_of(step, rate_Hz);
    burst.start_frame = std::llround(step.start_s * rate_Hz);
    stream.schedule(burst);
    stream.advance(burst.start_frame + burst.length_frames - stream.frame());
    while (stream.poll()) {
    }
  }
  stream.advance(std::llround(kLead_s * rate_Hz));
  stream.finish();
}

/// The stream while the guard sees that somebody lives; throws what went wrong, also a signal to end.
void attend(drive::Stream& stream, drive::Amplifier& amplifier, const std::function<bool()>& done) {
  while (!done()) {
    amplifier.session_alive();
    while (const auto event = stream.poll()) {
      using Kind = drive::EventKind;
      if (event->kind == Kind::underrun || event->kind == Kind::device_lost ||
          event->kind == Kind::burst_missed)
        throw std::runtime_error("sweep: the converter lost frames or is gone; begin again");
    }
    if (amplifier.state() == drive::AmplifierState::faulted)
      throw std::runtime_error("sweep: " + amplifier.fault());
    if (const auto signal = StopSignals::told(); !signal.empty())
      throw std::runtime_error("sweep: the program was told to end (" + signal + "); the sweep is not whole");
    drive::sleep_until_ns(drive::monotonic_ns() + kPoll_ns);
  }
}

void play(drive::Stream& stream, drive::Amplifier& amplifier, const std::vector<SweepStep>& steps,
          int rate_Hz) {
  const auto begin = stream.earliest_frame() + std::llround(kLead_s * rate_Hz);
  const auto margin = std::llround(kMargin_s * rate_Hz);
  auto end = begin;
  for (const auto& step : steps) {
    auto burst = burst_of(step, rate_Hz);
    burst.start_frame = begin + std::llround(step.start_s * rate_Hz);
    // By what is rendered, which a device with a long buffer is far ahead of what is heard.
    attend(stream, amplifier, [&] { return stream.earliest_frame() + margin >= burst.start_frame; });
    stream.schedule(burst);
    end = burst.start_frame + burst.length_frames;
  }
  attend(stream, amplifier, [&] { return drive::monotonic_ns() >= stream.time_of(end); });
}

}  // namespace

std::vector<SweepStep> sweep_plan(const rig::Rig& rig, const SweepOptions& options) {
  if (options.points < 5) throw std::invalid_argument("sweep: fewer than 5 points; 5 or more are allowed");
  if (!(options.full_scale > 0 && options.full_scale <= 1))
    throw std::invalid_argument(
        fmt::format("sweep: amplitude {}; above 0 to 1 of full scale is allowed", options.full_scale));
  if (!(options.length_s >= 0.2 && options.pause_s >= 0.2))
    throw std::invalid_argument("sweep: tones and pauses of 0.2 s or more are allowed");
  if (options.length_s > rig.limits.duty * (options.length_s + options.pause_s))
    throw std::invalid_argument(
        fmt::format("sweep: the rig's duty of {} wants longer pauses", rig.limits.duty));
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

double play_sweep(const rig::Rig& rig, const std::vector<SweepStep>& steps, const std::string& uri,
                  const std::function<bool()>& arm) {
  auto config = session::stream_of(rig);
  config.output.uri = uri;
  if (!uri.starts_with("alsa:")) {
    render(*drive::open_synchronous(config), steps, config.output.rate_Hz);
    return steps.empty() ? 0 : steps.back().start_s + steps.back().length_s;
  }
  const auto amplifier = panel::open_amplifier(rig.amplifier_uri);  // outlives the stream
  config.amplifier = amplifier.get();
  StopSignals signals;
  signals.take_over();
  const auto stream = drive::open_realtime(config);  // on its way out it ramps down what sounds
  const auto attend_for = [&](std::int64_t ns) {
    attend(*stream, *amplifier,
           [until_ns = drive::monotonic_ns() + ns] { return drive::monotonic_ns() >= until_ns; });
  };
  attend_for(200'000'000);
  if (!arm()) throw std::runtime_error("sweep: the amplifier was not armed; nothing was played");
  attend_for(50'000'000);
  amplifier->arm();
  amplifier->enable();
  const auto began_ns = drive::monotonic_ns();
  play(*stream, *amplifier, steps, config.output.rate_Hz);
  amplifier->disarm();
  return 1e-9 * static_cast<double>(drive::monotonic_ns() - began_ns);
}

}  // namespace turnpoint::app
