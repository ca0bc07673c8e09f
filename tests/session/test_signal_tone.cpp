// A response signal that is a tone: whether it is where the protocol says, in the samples that are played.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "station/audio/synth.hpp"
#include "station/core/read_file.hpp"
#include "station/session/plan_ahead.hpp"
#include "station/session/stage.hpp"
#include "station/trial/timing.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/replaced.hpp"

using namespace turnpoint;

namespace {

const std::string kRoot = TURNPOINT_SOURCE_DIR;

rig::Rig with_headphones() {
  return rig::parse(
      core::read_file(kRoot + "/tests/support/thin_plate.toml") +
          "\n[noise]\nchannel = 2\nrms = 0.05\nsignal = { frequency_Hz = 1000, amplitude = 0.2 }\n",
      "rig.toml");
}

protocol::Protocol by_tone(const std::string& window = "window_s = 0.4, by = \"tone\"") {
  return protocol::parse(
      replaced(core::read_file(kRoot + "/protocols/response-signal.toml"), "window_s = 0.4", window),
      "p.toml");
}

/// Returns the samples of a channel in a burst that begins at frame 0. If `stop_at` is set, the burst is
/// stopped.
std::vector<double> channel_of(audio::PreparedBurst burst, const audio::Format& format, int channel,
                               std::optional<std::int64_t> stop_at = {}) {
  const auto length = burst.length_frames;
  burst.start_frame = 0;
  audio::Synth synth(format);
  REQUIRE(synth.start(burst));
  const auto channels = static_cast<std::size_t>(format.channels);
  std::vector<double> block(500 * channels), samples;
  for (std::int64_t frame = 0; frame < length; frame += 500) {
    if (stop_at && frame <= *stop_at && *stop_at < frame + 500) synth.stop(0, *stop_at, {9600});
    synth.render(frame, std::span<double>(block));
    for (std::size_t k = 0; k < 500; ++k)
      samples.push_back(block[k * channels + static_cast<std::size_t>(channel)]);
  }
  return samples;
}

std::pair<std::int64_t, std::int64_t> sounding(const std::vector<double>& samples) {
  const auto loud = [](double sample) { return sample != 0; };
  const auto first = std::find_if(samples.begin(), samples.end(), loud);
  const auto last = std::find_if(samples.rbegin(), samples.rend(), loud);
  return {first - samples.begin(), samples.rend() - last};
}

}  // namespace

TEST_CASE("a tone as response signal begins at its lag after the change, within one frame", "[session]") {
  const auto rig = with_headphones();
  const auto protocol = by_tone();
  const auto stream = session::stream_of(rig);
  const auto format = audio::format_of(stream.output);
  std::set<double> lags;
  for (std::uint64_t seed = 0; seed < 40 && lags.size() < 4; ++seed) {
    trial::Director director(protocol, 0, seed);
    session::PlanAhead plans(rig, protocol, seed);
    const auto spec = *director.next();
    if (!lags.insert(*spec.signal_s).second) continue;
    INFO("lag of " << *spec.signal_s << " s, foreperiod of " << spec.foreperiod_s << " s");
    const auto& burst = plans.take(spec).bursts.back();
    const auto [first, end] = sounding(channel_of(burst, format, 2));
    const auto change = std::llround(spec.foreperiod_s * format.rate_Hz);
    CHECK(burst.changes[0].at_frame == change);
    // The sine begins with a sample of 0, so the tone is seen from its second frame on.
    CHECK(first - 1 == std::llround((spec.foreperiod_s + *spec.signal_s) * format.rate_Hz));
    CHECK(end - (first - 1) == std::llround(0.05 * format.rate_Hz));
    // a stop during the tone ramps it down too, and a stop before it leaves it out
    CHECK(sounding(channel_of(burst, format, 2, first - 9600)).second <= 0);
    const auto cut = channel_of(burst, format, 2, first);
    CHECK(sounding(cut).first == first);
    CHECK(std::abs(cut[static_cast<std::size_t>(first + 9000)]) < 0.01);
  }
  CHECK(lags.size() == 4);
}

TEST_CASE("without by = \"tone\" the headphones are silent at the response signal", "[session]") {
  const auto rig = with_headphones();
  const auto protocol = by_tone("window_s = 0.4");
  trial::Director director(protocol, 0, 1);
  session::PlanAhead plans(rig, protocol, 1);
  const auto spec = *director.next();
  CHECK(!trial::signal_in_stimulus_s(protocol, spec));
  CHECK(plans.take(spec).bursts.back().signal.amplitude == 0);
}
