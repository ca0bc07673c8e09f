#include "station/sensing/planned_lines.hpp"

#include "station/sensing/aligned_blocks.hpp"

namespace turnpoint::sensing {

std::vector<PlannedLine> planned_lines(const Stretch& stretch, const std::vector<PickUp>& pick_ups,
                                       int rate_Hz) {
  std::vector<PlannedLine> lines;
  for (const PlannedTone& tone : stretch.tones) {
    auto same = std::find_if(lines.begin(), lines.end(),
                             [&](const PlannedLine& line) { return line.increment == tone.increment; });
    if (same == lines.end()) {
      PlannedLine line;
      line.phase = tone.phase;
      line.increment = tone.increment;
      line.frequency_Hz = tone.frequency_Hz;
      line.gain = high_pass_gain(tone.frequency_Hz, rate_Hz, high_pass_step(rate_Hz));
      line.expected.resize(pick_ups.size());
      line.seen.resize(pick_ups.size(), 1);
      same = lines.insert(lines.end(), line);
    }
    same->tones.push_back(tone);
    const double turn = 2 * M_PI * 0x1p-64 * static_cast<double>(tone.phase - same->phase);
    for (std::size_t p = 0; p < pick_ups.size(); ++p)
      if (const auto h = response(pick_ups[p], tone.channel, tone.frequency_Hz))
        same->expected[p] += *h * std::polar(tone.amplitude, turn);
      else
        same->seen[p] = 0;
  }
  for (PlannedLine& line : lines) {
    double planned = 0;
    for (const PlannedTone& tone : line.tones) planned += tone.amplitude;
    for (std::size_t p = 0; p < pick_ups.size(); ++p)
      line.seen[p] *= std::abs(line.expected[p]) / (planned * best_response(pick_ups[p]));
  }
  return lines;
}

std::size_t main_pick_up(const std::vector<PlannedLine>& lines, std::size_t pick_ups) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t p = 0; p < pick_ups; ++p) {
    double seen = 0;
    for (const PlannedLine& line : lines) seen += line.seen[p] * line.seen[p];
    if (!(seen > most)) continue;
    most = seen;
    best = p;
  }
  return best;
}

double planned_power(const std::vector<PlannedLine>& lines, std::size_t pick_up) {
  double power = 0;
  for (const PlannedLine& line : lines) power += std::norm(line.expected[pick_up] * line.gain) / 2;
  return power;
}

}  // namespace turnpoint::sensing
