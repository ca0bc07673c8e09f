// burst_samples ONSET SECONDS HZ:AMPLITUDE:CHANNEL...: computes the samples that `turnpoint synth` makes from
// these tones at 192 kHz and 24 bits, and writes them to standard output as raw S32_LE stereo. ONSET is the
// number of the first frame; the dither depends on it.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <vector>

#include "station/audio/synth.hpp"

using namespace turnpoint::audio;

namespace {

std::vector<std::int32_t> samples_of(const Burst& burst) {
  const Format format;
  const auto prepared = prepare(burst, format, {});
  Synth synth(format);
  std::vector<std::int32_t> samples(static_cast<std::size_t>(burst.length_frames * format.channels));
  if (!synth.start(prepared)) std::abort();
  synth.render(burst.start_frame, samples);
  return samples;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return std::fprintf(stderr, "burst_samples ONSET SECONDS HZ:AMPLITUDE:CHANNEL...\n"), 2;
  try {
    Burst burst;
    burst.start_frame = std::atoll(argv[1]);
    burst.length_frames = std::llround(std::atof(argv[2]) * 192000);
    for (int i = 3; i < argc; ++i) {
      auto& tone = burst.tones.tones[static_cast<std::size_t>(burst.tones.count++)];
      tone.phase_rad = std::numbers::pi / 2;
      if (std::sscanf(argv[i], "%lf:%lf:%d", &tone.frequency_Hz, &tone.amplitude, &tone.channel) != 3)
        return 2;
    }
    const auto samples = samples_of(burst);
    return std::fwrite(samples.data(), sizeof samples[0], samples.size(), stdout) == samples.size() ? 0 : 1;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
