#include "station/protocol/combinations.hpp"

#include <algorithm>
#include <map>

#include "station/core/number.hpp"
#include "station/protocol/expression.hpp"

namespace turnpoint::protocol {

namespace {

// Returns the values that a factor has in the trials of a source: the levels that the source sets, or the
// value that the block fixes, or otherwise all levels of the factor.
std::vector<FactorValue> values_of(const Factor& factor, const Source& source) {
  if (factor.name == source.level) return {source.levels.begin(), source.levels.end()};
  if (factor.name == source.second) return {source.seconds.begin(), source.seconds.end()};
  if (source.spec && std::ranges::find(source.spec->against, factor.name) != source.spec->against.end())
    return {source.levels.begin(), source.levels.end()};
  if (source.spec)
    if (const auto with = source.spec->with.find(factor.name); with != source.spec->with.end())
      return {with->second};
  const auto fixed = source.block->fixed.find(factor.name);
  if (fixed != source.block->fixed.end()) return {fixed->second};
  return drawn_values(factor);
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
    // thinned() will keep only some of the combinations, so of a large design these first ones are enough.
    if (product.size() > 20000) product.resize(20000);
  }
  all.insert(all.end(), product.begin(), product.end());
}

template <typename T>
std::vector<T> evenly(const std::vector<T>& sorted, std::size_t most) {
  if (sorted.size() <= most) return sorted;
  std::vector<T> chosen;
  for (std::size_t i = 0; i < most; ++i)
    chosen.push_back(sorted[most == 1 ? 0 : i * (sorted.size() - 1) / (most - 1)]);
  return chosen;
}

// Chooses values of each factor so that at most `most` combinations result. It begins with the two extreme
// values of each factor. Then it adds one value at a time, always to the factor of which the smallest
// fraction of values has been chosen.
std::map<std::string, std::set<FactorValue>> grid_of(
    const std::map<std::string, std::set<FactorValue>>& values, std::size_t most) {
  std::map<std::string, std::size_t> counts;
  for (const auto& [name, all] : values) counts[name] = std::min<std::size_t>(2, all.size());
  for (;;) {
    std::size_t product = 1;
    for (const auto& [name, count] : counts) product *= count;
    const std::string* next = nullptr;
    double thinnest = 1;
    for (const auto& [name, all] : values) {
      const double share = static_cast<double>(all.size()) / static_cast<double>(counts[name]);
      if (share > thinnest && product / counts[name] * (counts[name] + 1) <= most)
        thinnest = share, next = &name;
    }
    if (next == nullptr) break;
    ++counts[*next];
  }
  std::map<std::string, std::set<FactorValue>> kept;
  for (const auto& [name, all] : values) {
    const auto some = evenly(std::vector<FactorValue>(all.begin(), all.end()), counts[name]);
    kept[name] = {some.begin(), some.end()};
  }
  return kept;
}

}  // namespace

std::set<std::string> factors_of(const Scene& scene) {
  std::set<std::string> names;
  for (const auto* expression : expressions_of(scene))
    for (const auto& name : factors_in(*expression)) names.insert(name);
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

const Linear* only_expression(const Scene& scene) {
  const Linear* only = nullptr;
  for (const auto* expression : expressions_of(scene)) {
    if (expression->is_constant()) continue;
    if (only != nullptr) return nullptr;
    only = expression;
  }
  return only;
}

bool edge_moves_with_strength(const Scene& scene) {
  const auto by_friction = [](const SceneTone& tone) { return tone.edge.friction.has_value(); };
  return scene.rove_dB > 0 && !scene.zone &&
         (scene.edge.friction || std::any_of(scene.tones.begin(), scene.tones.end(), by_friction));
}

std::vector<Combination> thinned(const Scene& scene, const std::vector<Combination>& of_the_scene,
                                 std::size_t most) {
  if (of_the_scene.size() <= most) return of_the_scene;
  if (const auto* only = only_expression(scene)) {
    auto sorted = of_the_scene;
    const auto less = [&](const Combination& a, const Combination& b) {
      return evaluate(*only, a.factors) < evaluate(*only, b.factors);
    };
    std::stable_sort(sorted.begin(), sorted.end(), less);
    return evenly(sorted, most);
  }
  std::map<std::string, std::set<FactorValue>> values;
  for (const auto& combination : of_the_scene)
    for (const auto& [name, value] : combination.factors) values[name].insert(value);
  const auto kept = grid_of(values, most);
  std::vector<Combination> chosen;
  for (const auto& combination : of_the_scene) {
    const auto on_grid = [&](const auto& factor) { return kept.at(factor.first).count(factor.second) > 0; };
    if (chosen.size() < most && std::all_of(combination.factors.begin(), combination.factors.end(), on_grid))
      chosen.push_back(combination);
  }
  return chosen;
}

core::Phrase in_case(const Combination& combination, core::Phrase what) {
  const auto scene = plain(combination.scene), block = plain(combination.block);
  if (combination.factors.empty())
    return phrase("scene \"%1\" in block \"%2\": %3", {scene, block, std::move(what)});
  return phrase("scene \"%1\" in block \"%2\" at %3: %4",
                {scene, block, plain(format(combination.factors)), std::move(what)});
}

core::Phrase counted(core::Phrase first, int cases) {
  if (cases < 2) return first;
  return phrase("%1 (and in %2 more cases)", {std::move(first), plain(cases - 1)});
}

std::string format(const Factors& factors) {
  std::string all;
  for (const auto& [name, value] : factors) {
    const auto* number = std::get_if<double>(&value);
    all += (all.empty() ? "" : ", ") + name + " = " +
           (number ? core::number(*number) : std::get<std::string>(value));
  }
  return all;
}

}  // namespace turnpoint::protocol
