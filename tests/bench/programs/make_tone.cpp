// make_tone RATE FREQUENCY LEVEL_DB SECONDS: writes a sine as raw S32_LE stereo to standard output. Only the
// left channel has the tone, so that swapped channels are detected.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>

int main(int argc, char** argv) {
  if (argc != 5) return std::fprintf(stderr, "make_tone RATE FREQUENCY LEVEL_DB SECONDS\n"), 2;
  const double rate = std::atof(argv[1]), frequency = std::atof(argv[2]);
  const double peak = 2147483647.0 * std::pow(10, std::atof(argv[3]) / 20);
  const auto frames = static_cast<std::int64_t>(rate * std::atof(argv[4]));
  for (std::int64_t i = 0; i < frames; ++i) {
    const double cycles = std::fmod(frequency * static_cast<double>(i), rate) / rate;
    const auto sample =
        static_cast<std::int32_t>(std::lround(peak * std::sin(2 * std::numbers::pi * cycles)));
    const std::int32_t frame[2] = {sample, 0};
    if (std::fwrite(frame, sizeof frame, 1, stdout) != 1) return 1;
  }
}
