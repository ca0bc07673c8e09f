#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <memory>

#include "station/audio/engine.hpp"
#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/cli/tones.hpp"
#include "station/core/number.hpp"
#include "station/maintenance/play_armed.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/transducer.hpp"
#include "station/session/burst.hpp"
#include "station/session/places.hpp"
#include "station/session/stage.hpp"

namespace turnpoint::cli {

namespace synth_command {

struct Options {
  std::string rig, out;
  std::vector<std::string> tones;
  double seconds = 1, ramp_ms = 50;
  bool arm = false;
};

audio::Burst burst_for(const rig::Rig& rig, const Options& options) {
  audio::Burst burst;
  const auto frames = [&rig](double s) {
    return static_cast<std::int64_t>(std::llround(s * rig.output.rate_Hz));
  };
  burst.length_frames = frames(options.seconds);
  burst.ramp.frames = frames(options.ramp_ms * 1e-3);
  if (2 * burst.ramp.frames > burst.length_frames)
    throw UsageError(fmt::format("synth: two ramps of {} ms do not fit into {} s; use --ramp-ms {} or less",
                                 core::number(options.ramp_ms), core::number(options.seconds),
                                 core::number(500 * options.seconds)));
  const auto tones = parse_tones(options.tones);
  if (tones.size() > static_cast<std::size_t>(audio::max_tones))
    throw UsageError(
        fmt::format("synth: {} tones were given; at most {} are allowed", tones.size(), audio::max_tones));
  for (const auto& tone : tones)
    burst.tones.tones[static_cast<std::size_t>(burst.tones.count++)] =
        session::driven(scene::on_transducer(rig, tone));
  return burst;
}

Json to_json(const audio::PlayReport& report, const Options& options) {
  const auto& c = report.counters;
  return {{"out", options.out},
          {"frames", c.frames},
          {"onset_frame", report.onset_frame},
          {"peak", json_number(report.peak)},
          {"largest_sample", json_number(report.largest_sample)},
          {"counters",
           {{"bursts", c.bursts},
            {"missed", c.missed},
            {"underruns", c.underruns},
            {"lost_frames", c.lost_frames},
            {"saturated", c.saturated},
            {"device_losses", c.device_losses}}}};
}

/// Plays the tones to the device or file. Without `--arm` the amplifier is not touched and stays off.
audio::PlayReport play(const rig::Rig& rig, const Options& options) {
  const auto burst = burst_for(rig, options);
  if (!options.arm) {
    auto config = session::stream_of(rig);
    config.output.uri = options.out;
    return audio::play(config, burst);
  }
  if (!options.out.starts_with("alsa:"))
    throw UsageError("synth: --arm with --out " + options.out +
                     "; --arm is only possible with --out alsa:NAME, which plays through the amplifier");
  if (options.seconds > rig.limits.continuous_s)
    throw UsageError(fmt::format(
        "synth: with --arm for {} s the amplifier would run too long; the rig allows {} s without a pause",
        core::number(options.seconds), core::number(rig.limits.continuous_s)));
  return maintenance::play_armed(rig, options.out, {burst});
}

void synth(const Options& options, Context& context) {
  const auto rig = rig::load(session::rig_or_default(options.rig, context.err));
  const auto report = play(rig, options);
  if (context.json) {
    print_json(context.out, to_json(report, options));
    return;
  }
  fmt::print(context.out, "{}: {} frames, onset at frame {}, peak {} of full scale, {} underruns\n",
             options.out, report.counters.frames, report.onset_frame, core::number(report.peak, 6),
             report.counters.underruns);
}

}  // namespace synth_command

void add_synth(CommandLine& app, Context& context) {
  using namespace synth_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("synth", "Play or render tones");
  add_rig(*command, options->rig);
  command
      ->add_option("--tone", options->tones,
                   "HZ[:UM[:DEG]]: frequency, displacement of the driven edge, phase")
      ->required();
  command->add_option("--seconds", options->seconds, "Duration, including both ramps")
      ->required()
      ->check(between(0.001, 3600.0));
  command->add_option("--ramp-ms", options->ramp_ms, "Length of each ramp")
      ->capture_default_str()
      ->check(not_negative());
  command->add_option("--out", options->out, "null: | wav:FILE | alsa:NAME")->required();
  command->add_flag("--arm", options->arm,
                    "With --out alsa:...: arm the rig's amplifier while the tones play");
  add_json(*command, context);
  command->footer("Example: turnpoint synth --tone 30000:0.5 --seconds 2 --out wav:tone.wav");
  command->callback([options, &context] { with_users_numbers([&] { synth(*options, context); }); });
}

}  // namespace turnpoint::cli
