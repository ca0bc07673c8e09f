#include "station/protocol/combinations.hpp"

#include <algorithm>
#include <map>

#include "station/protocol/expression.hpp"
#include "station/text/number.hpp"

namespace turnpoint::protocol {

namespace {

// The values that a factor takes in the trials of a source: its level, what the block fixes, else any level.
std::vector<FactorValue> values_of(const Factor& factor, const Source& source) {
  if (factor.name == source.level) return {source.levels.begin(), source.levels.end()};
  const auto fixed = source.block->fixed.find(factor.name);
  if (fixed != source.block->fixed.end()) return {fixed->second};
  return factor.levels;
}

void cross(const Protocol& protocol, const Source& source, const std::string& scene,
           std::vector<Combination>& all) {
  const auto needed = factors_of(protocol.scenes.at(scene));
  std::vector<Combination> product{{scene, source.block->name, {}}};
  for (const auto& factor : protocol.factors) {
    if (!needed.count(factor.name)) continue;
    std::vector<Combination> next;
    for (const auto& value : values_of(factor, source))
      for (auto combination : product) {
        combination.factors[factor.name] = value;
        next.push_back(std::move(combination));
      }
    product = std::move(next);
    // A design with more is thinned anyway; what is dropped here lies between values that are kept.
    if (product.size() > 20000) product.resize(20000);
  }
  all.insert(all.end(), product.begin(), product.end());
}

}  // namespace

std::set<std::string> factors_of(const Scene& scene) {
  std::set<std::string> names;
  const auto add = [&](const std::optional<Linear>& expression) {
    if (!expression) return;
    for (const auto& [name, coefficient] : expression->terms) names.insert(name);
  };
  for (const auto* expression :
       {&scene.boundary_mm, &scene.displacement_um, &scene.friction, &scene.friction_contrast_dB})
    add(*expression);
  if (scene.zone) add(scene.zone->friction);
  for (const auto& tone : scene.tones)
    add(tone.boundary_mm), add(tone.frequency_Hz), add(tone.displacement_um);
  return names;
}

std::vector<Combination> combinations_of(const Protocol& protocol) {
  std::vector<Combination> all, unique;
  for (const auto& source : sources_of(protocol))
    for (const auto& scene : scenes_used(protocol)) cross(protocol, source, scene, all);
  std::set<std::pair<std::string, Factors>> seen;
  for (auto& combination : all)
    if (seen.insert({combination.scene, combination.factors}).second)
      unique.push_back(std::move(combination));
  return unique;
}

std::vector<Combination> thinned(const std::vector<Combination>& of_one_scene, std::size_t most) {
  if (of_one_scene.size() <= most) return of_one_scene;
  std::map<std::string, std::pair<FactorValue, FactorValue>> extremes;
  for (const auto& combination : of_one_scene)
    for (const auto& [name, value] : combination.factors) {
      auto& [low, high] = extremes.try_emplace(name, value, value).first->second;
      low = std::min(low, value), high = std::max(high, value);
    }
  const auto is_corner = [&](const Combination& combination) {
    return std::all_of(combination.factors.begin(), combination.factors.end(), [&](const auto& factor) {
      const auto& [low, high] = extremes.at(factor.first);
      return factor.second == low || factor.second == high;
    });
  };
  std::vector<Combination> chosen;
  for (const auto& combination : of_one_scene)
    if (chosen.size() < most && is_corner(combination)) chosen.push_back(combination);
  const auto rest = most - chosen.size();
  for (std::size_t i = 0; i < rest; ++i) {
    const auto& combination = of_one_scene[(2 * i + 1) * of_one_scene.size() / (2 * rest)];
    if (!is_corner(combination)) chosen.push_back(combination);
  }
  return chosen;
}

std::string format(const Factors& factors) {
  std::string all;
  for (const auto& [name, value] : factors) {
    const auto* number = std::get_if<double>(&value);
    all += (all.empty() ? "" : ", ") + name + " = " +
           (number ? text::number(*number) : std::get<std::string>(value));
  }
  return all;
}

}  // namespace turnpoint::protocol
