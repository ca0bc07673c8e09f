#include "station/rehearsal/best_ranges.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace turnpoint::rehearsal {

namespace {

// A group of neighbouring values that count as equal. `weights` holds, for each answer, the total weight of
// the trials in which it is right.
struct Group {
  double first = 0, last = 0;
  Shares weights{};
};

std::vector<Group> groups_of(std::vector<Weighed> values, double grain) {
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  std::vector<Group> groups;
  for (const auto& value : values) {
    if (groups.empty() || value.value - groups.back().first > grain)
      groups.push_back({value.value, value.value, {}});
    groups.back().last = value.value;
    groups.back().weights[static_cast<std::size_t>(value.answer)] += value.weight;
  }
  return groups;
}

constexpr double impossible = -1;
constexpr std::uint8_t no_change = 255;

}  // namespace

// Dynamic programming over the groups. A state is the number of ranges begun so far and the answer of the
// last one; its score is the largest weight of right answers with which the state can be reached. For each
// group and state, `came_from` has the answer of the range before, if a range begins at this group.
std::vector<CueRange> best_ranges(std::vector<Weighed> values, std::size_t answers, double grain) {
  const auto groups = groups_of(std::move(values), grain);
  if (groups.empty()) return {};
  const std::size_t most_ranges = answers + 1, states = most_ranges * answers;
  std::vector<double> scores(states, impossible);
  std::vector<std::uint8_t> came_from(groups.size() * states, no_change);
  for (std::size_t a = 0; a < answers; ++a) scores[a] = groups.front().weights[a];
  for (std::size_t g = 1; g < groups.size(); ++g)
    for (std::size_t k = most_ranges; k-- > 0;) {
      const auto before =
          k == 0 ? scores.begin() : scores.begin() + static_cast<std::ptrdiff_t>((k - 1) * answers);
      const auto best = std::max_element(before, before + static_cast<std::ptrdiff_t>(answers));
      for (std::size_t a = 0; a < answers; ++a) {
        auto& score = scores[k * answers + a];
        if (k > 0 && *best != impossible && *best > score + 1e-12) {
          score = *best;
          came_from[g * states + k * answers + a] = static_cast<std::uint8_t>(best - before);
        }
        if (score != impossible) score += groups[g].weights[a];
      }
    }
  // If several divisions have the same score, use the one with the fewest ranges.
  std::size_t state = 0;
  for (std::size_t s = 1; s < states; ++s)
    if (scores[s] > scores[state] + 1e-12) state = s;
  std::vector<CueRange> ranges{{std::numeric_limits<double>::infinity(), static_cast<int>(state % answers)}};
  for (std::size_t g = groups.size(); g-- > 1;) {
    const auto from = came_from[g * states + state];
    if (from == no_change) continue;
    state = (state / answers - 1) * answers + from;
    ranges.push_back({0.5 * (groups[g - 1].last + groups[g].first), static_cast<int>(from)});
  }
  std::reverse(ranges.begin(), ranges.end());
  return ranges;
}

}  // namespace turnpoint::rehearsal
