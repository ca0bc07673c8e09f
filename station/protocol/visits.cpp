#include "station/protocol/visits.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

#include "station/protocol/conditions.hpp"

namespace turnpoint::protocol {

namespace {

/// With more different places than this, no two participants of a study share one.
constexpr int kMostPlaces = 1'000'000;

}  // namespace

bool is_group(const Factor& factor) { return factor.draw == FactorDraw::per_participant; }

int group_count(const Protocol& protocol) {
  std::size_t count = 1;
  for (const auto& factor : protocol.factors)
    if (is_group(factor)) count *= std::max<std::size_t>(1, factor.levels.size());
  return static_cast<int>(count);
}

Factors group_of(const Protocol& protocol, int place) {
  Factors group;
  auto rest = static_cast<std::size_t>(place);
  for (const auto& factor : protocol.factors) {
    if (!is_group(factor) || factor.levels.empty()) continue;
    group[factor.name] = factor.levels[rest % factor.levels.size()];
    rest /= factor.levels.size();
  }
  return group;
}

std::vector<std::string> group_names(const Protocol& protocol) {
  std::vector<std::string> names;
  for (int place = 0; place < group_count(protocol); ++place) {
    std::string name;
    const auto group = group_of(protocol, place);
    for (const auto& factor : protocol.factors)
      if (const auto found = group.find(factor.name); found != group.end())
        name += (name.empty() ? "" : ", ") + level_in_words(factor.name, found->second);
    if (!name.empty()) names.push_back(name);
  }
  return names;
}

int place_count(const Protocol& protocol) {
  // An order of n levels is one of n rows of a Williams square, or of 2 n if n is odd (block_order.cpp).
  std::int64_t orders = 1;
  for (const auto& part : protocol.plan) {
    const auto* sequence = std::get_if<Sequence>(&part);
    const auto* factor = sequence ? find_factor(protocol.factors, sequence->over) : nullptr;
    const auto levels = factor ? static_cast<std::int64_t>(factor->levels.size()) : 0;
    if (levels > 1) orders = std::lcm(orders, levels % 2 == 0 ? levels : 2 * levels);
    if (orders > kMostPlaces) return kMostPlaces;
  }
  return static_cast<int>(std::min<std::int64_t>(orders * group_count(protocol), kMostPlaces));
}

core::Assignment design(const Protocol& protocol) {
  return {protocol.dropout_after_h.value_or(std::numeric_limits<double>::infinity()), place_count(protocol),
          session_count(protocol), protocol.sessions && protocol.sessions->incomplete == Unfinished::count};
}

std::optional<core::Assignment> assignment(const Protocol& protocol) {
  return protocol.dropout_after_h ? std::optional(design(protocol)) : std::nullopt;
}

int session_count(const Protocol& protocol) { return protocol.sessions ? protocol.sessions->count : 1; }

bool is_for(const Audience& audience, const Protocol& protocol, const Visit& visit) {
  const auto& [sessions, groups] = audience;
  if (!sessions.empty() && std::find(sessions.begin(), sessions.end(), visit.session) == sessions.end())
    return false;
  if (groups.empty()) return true;
  const auto group = group_of(protocol, visit.place);
  return std::any_of(group.begin(), group.end(), [&groups = groups](const auto& level) {
    const auto* name = std::get_if<std::string>(&level.second);
    return name && std::find(groups.begin(), groups.end(), *name) != groups.end();
  });
}

std::vector<Visit> different_visits(const Protocol& protocol) {
  std::vector<Visit> visits;
  for (int session = 1; session <= session_count(protocol); ++session)
    for (int place = 0; place < group_count(protocol); ++place) visits.emplace_back(place, session);
  return visits;
}

std::string group_name(const Protocol& protocol, const Visit& visit) {
  const auto groups = group_names(protocol);
  return groups.empty() ? "" : groups[static_cast<std::size_t>(visit.place) % groups.size()];
}

std::string in_words(const Protocol& protocol, const Visit& visit) {
  std::string words = protocol.sessions ? "session " + std::to_string(visit.session) : "";
  if (const auto group = group_name(protocol, visit); !group.empty())
    words += (words.empty() ? "group " : ", group ") + group;
  return words;
}

}  // namespace turnpoint::protocol
