#include "station/rehearsal/cue_table.hpp"

#include <algorithm>
#include <cmath>

#include "station/protocol/combinations.hpp"
#include "station/protocol/resolve.hpp"

namespace turnpoint::rehearsal {

namespace {

using protocol::Linear;
using scene::Cues;

constexpr double Cues::*all_cues[] = {&Cues::pitch_Hz,       &Cues::loudness_dB,  &Cues::wide_end_amplitude_m,
                                      &Cues::stripe_pitch_m, &Cues::edge_width_m, &Cues::strip_width_m,
                                      &Cues::displacement_m, &Cues::friction};

bool same(double a, double b) {
  return std::fabs(a - b) <= 1e-9 * std::max({1.0, std::fabs(a), std::fabs(b)});
}

// Mixes the cues of two scenes. Silence has neither pitch nor loudness, so between silence and a tone these
// two cues cannot be interpolated; they are taken from the nearer scene.
Cues mixed(const Cues& a, const Cues& b, double share_of_b) {
  Cues cues;
  for (const auto cue : all_cues) cues.*cue = (1 - share_of_b) * a.*cue + share_of_b * b.*cue;
  if ((a.pitch_Hz == 0) != (b.pitch_Hz == 0)) {
    const auto& nearer = share_of_b < 0.5 ? a : b;
    cues.pitch_Hz = nearer.pitch_Hz, cues.loudness_dB = nearer.loudness_dB;
  }
  return cues;
}

RovedCues mixed(const RovedCues& a, const RovedCues& b, double share_of_b) {
  RovedCues cues{mixed(a.high, b.high, share_of_b), std::nullopt, a.rove_dB};
  if (a.low && b.low) cues.low = mixed(*a.low, *b.low, share_of_b);
  return cues;
}

Cues weaker(Cues cues, double by_dB) {
  cues.wide_end_amplitude_m *= std::pow(10.0, -by_dB / 20);
  if (cues.pitch_Hz > 0) cues.loudness_dB -= by_dB;
  return cues;
}

}  // namespace

Cues RovedCues::at(double drawn_dB) const {
  const double below_dB = rove_dB - drawn_dB;
  if (!low || rove_dB == 0) return below_dB == 0 ? high : weaker(high, below_dB);
  return mixed(weaker(high, below_dB), weaker(*low, below_dB - 2 * rove_dB), below_dB / (2 * rove_dB));
}

CueTable::CueTable(const protocol::Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey)
    : protocol_(protocol), planner_(rig) {
  for (const auto& sight : survey.sights) {
    const auto& from = protocol.scenes.at(sight.scene);
    auto& scene = scenes_[sight.scene];
    scene.only = protocol::only_expression(from);
    scene.factors.clear();
    Entry entry;
    for (const auto& [name, value] : sight.factors) {
      scene.factors.push_back(name);
      entry.values.push_back(std::get<double>(value));
    }
    if (scene.only) entry.sum = evaluate(*scene.only, sight.factors);
    entry.cues = {sight.cues, sight.cues_roved_down, from.rove_dB};
    scene.entries.push_back(std::move(entry));
  }
}

// Interpolates between the nearest entry below and the nearest entry above the coordinate `at`. `cues_at`
// returns the coordinate and the cues of an entry (or of all entries that have the same coordinate).
template <typename Entries, typename Coordinate, typename CuesAt>
static std::optional<RovedCues> mixed_along(const Entries& entries, double at, Coordinate&& coordinate,
                                            CuesAt&& cues_at) {
  std::optional<double> below, above;
  for (const auto* entry : entries) {
    const double x = coordinate(*entry);
    if (same(x, at)) return cues_at(x);
    if (x < at && (!below || x > *below)) below = x;
    if (x > at && (!above || x < *above)) above = x;
  }
  if (!below || !above) return std::nullopt;
  const auto low = cues_at(*below), high = cues_at(*above);
  if (!low || !high) return std::nullopt;
  return mixed(*low, *high, (at - *below) / (*above - *below));
}

std::optional<RovedCues> CueTable::between(const std::vector<const Entry*>& entries,
                                           const std::vector<double>& wanted, std::size_t axis) {
  if (axis == wanted.size()) return entries.front()->cues;
  return mixed_along(
      entries, wanted[axis], [axis](const Entry& entry) { return entry.values[axis]; },
      [&](double x) {
        std::vector<const Entry*> there;
        for (const auto* entry : entries)
          if (entry->values[axis] == x) there.push_back(entry);
        return between(there, wanted, axis + 1);
      });
}

std::optional<RovedCues> CueTable::planned(const std::string& name, const protocol::Factors& factors) {
  const auto& from = protocol_.scenes.at(name);
  if (from.zone || plans_left_ <= 0) return std::nullopt;
  --plans_left_;
  try {
    RovedCues cues{
        planner_.plan(protocol::resolve(protocol_, name, factors, from.rove_dB)).cues, {}, from.rove_dB};
    if (protocol::edge_moves_with_strength(from))
      cues.low = planner_.plan(protocol::resolve(protocol_, name, factors, -from.rove_dB)).cues;
    return cues;
  } catch (const scene::Unreachable&) {
    return std::nullopt;
  }
}

std::optional<RovedCues> CueTable::find(const std::string& name, const protocol::Factors& factors) {
  const auto found = scenes_.find(name);
  if (found == scenes_.end()) return std::nullopt;
  auto& scene = found->second;
  Entry wanted;
  for (const auto& factor : scene.factors) {
    const auto value = factors.find(factor);
    const auto* number = value == factors.end() ? nullptr : std::get_if<double>(&value->second);
    if (!number) return std::nullopt;
    wanted.values.push_back(*number);
  }
  std::vector<const Entry*> entries;
  for (const auto& entry : scene.entries) {
    if (std::equal(wanted.values.begin(), wanted.values.end(), entry.values.begin(), same)) return entry.cues;
    entries.push_back(&entry);
  }
  if (scene.only) wanted.sum = evaluate(*scene.only, factors);
  if (const auto cues = planned(name, factors)) {
    wanted.cues = *cues;
    scene.entries.push_back(wanted);
    return cues;
  }
  if (!scene.only) return between(entries, wanted.values, 0);
  const auto sum = [](const Entry& entry) { return entry.sum; };
  return mixed_along(entries, wanted.sum, sum, [&](double x) -> std::optional<RovedCues> {
    for (const auto* entry : entries)
      if (entry->sum == x) return entry->cues;
    return std::nullopt;
  });
}

}  // namespace turnpoint::rehearsal
