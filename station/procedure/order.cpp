#include "station/procedure/order.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "station/core/number.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

namespace {

using Values = std::vector<std::size_t>;

/// Walks that are tried for runs longer than 1; steps of one search for an order, besides two for each item,
/// and searches.
constexpr int kMostWalks = 500, kMostSteps = 20'000, kMostSearches = 10;
/// Elementary operations of all searches for an order of a list, which end within seconds. A list is read
/// with each file, and ordered at the start of each session.
constexpr double kMostOperations = 2e8;
/// Sequences of values that follow each other; no list is so long.
constexpr double kMostPaths = 1e6;

core::Phrase none_found() { return phrase("no order was found that keeps its rules"); }
core::Phrase loosen() { return phrase("allow longer runs or more pairs, or use other numbers of repeats"); }

/// Whether an item with these values may come directly after one with those of `before`. A run of 1 means
/// that the same value never comes twice in a row; longer ones are not looked at here.
bool may_follow(const Values& before, const Values& now, const OrderRules& rules) {
  return std::ranges::none_of(rules.never,
                              [&](const auto& never) {
                                return before[never.factor] == never.before && now[never.factor] == never.now;
                              }) &&
         std::ranges::none_of(rules.runs, [&](const auto& run) {
           return run.limit == 1 && before[run.factor] == now[run.factor];
         });
}

/// Items with the same values of all factors, or of those that follow each other equally often.
struct Group {
  Values values;  ///< of its first item
  std::vector<std::size_t> items;
};

/// Groups are in the order of their values, so that the same items in another order have the same groups.
std::vector<Group> groups_of(const std::vector<OrderedItem>& items, const std::vector<std::size_t>& by) {
  std::map<Values, Group> sorted;
  for (std::size_t i = 0; i < items.size(); ++i) {
    Values key;
    for (const auto factor : by) key.push_back(items[i].values[factor]);
    auto& group = sorted.try_emplace(key, Group{items[i].values, {}}).first->second;
    group.items.push_back(i);
  }
  std::vector<Group> groups;
  for (auto& [key, group] : sorted) groups.push_back(std::move(group));
  return groups;
}

// --- each after each other, equally often

/// The graph whose nodes are the last `back` groups, and whose edges are the groups that may come next.
struct Graph {
  std::vector<std::vector<std::size_t>> nodes;  ///< groups, the oldest first
  struct Edge {
    std::size_t group = 0, to = 0;
  };
  std::vector<std::vector<Edge>> edges;
};

Graph graph_of(std::size_t groups, std::size_t back, const auto& may) {
  Graph graph;
  std::map<std::vector<std::size_t>, std::size_t> numbers;
  std::vector<std::vector<std::size_t>> longer{{}};
  for (std::size_t length = 0; length < back; ++length) {
    auto shorter = std::exchange(longer, {});
    for (const auto& node : shorter)
      for (std::size_t next = 0; next < groups; ++next)
        if (node.empty() || may(node.back(), next)) {
          longer.push_back(node);
          longer.back().push_back(next);
        }
  }
  graph.nodes = std::move(longer);
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) numbers[graph.nodes[i]] = i;
  graph.edges.resize(graph.nodes.size());
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    for (std::size_t next = 0; next < groups; ++next)
      if (may(graph.nodes[i].back(), next)) {
        std::vector<std::size_t> to(graph.nodes[i].begin() + 1, graph.nodes[i].end());
        to.push_back(next);
        graph.edges[i].push_back({next, numbers.at(to)});
      }
  return graph;
}

/// True if each node has as many edges to it as from it, and at least one, and all can be reached from the
/// first.
bool is_eulerian(const Graph& graph) {
  std::vector<std::size_t> to(graph.nodes.size());
  for (const auto& edges : graph.edges)
    for (const auto& edge : edges) ++to[edge.to];
  std::vector<bool> reached(graph.nodes.size());
  std::vector<std::size_t> open{0};
  for (std::size_t count = 0; !open.empty();) {
    const auto node = open.back();
    open.pop_back();
    if (reached[node]) continue;
    reached[node] = true, ++count;
    for (const auto& edge : graph.edges[node]) open.push_back(edge.to);
    if (count == graph.nodes.size()) break;
  }
  for (std::size_t i = 0; i < to.size(); ++i)
    if (!reached[i] || to[i] == 0 || to[i] != graph.edges[i].size()) return false;
  return !graph.nodes.empty();
}

/// A random walk that uses each edge `times` times, as groups; it begins with those of its first node.
std::vector<std::size_t> walk(const Graph& graph, std::size_t times, core::Draws& draws) {
  const auto n = graph.nodes.size();
  const auto root = static_cast<std::size_t>(draws.below(n));
  // The last edge by which each node is left: a random tree towards the root, by walks whose loops are cut
  // out.
  std::vector<std::size_t> last(n);
  std::vector<bool> in_tree(n);
  in_tree[root] = true;
  for (std::size_t from = 0; from < n; ++from) {
    for (auto at = from; !in_tree[at]; at = graph.edges[at][last[at]].to)
      last[at] = static_cast<std::size_t>(draws.below(graph.edges[at].size()));
    for (auto at = from; !in_tree[at]; at = graph.edges[at][last[at]].to) in_tree[at] = true;
  }
  std::vector<std::vector<std::size_t>> exits(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t edge = 0; edge < graph.edges[i].size(); ++edge)
      exits[i].insert(exits[i].end(), times - (i != root && edge == last[i] ? 1 : 0), edge);
    draws.shuffle(exits[i]);
    if (i != root) exits[i].push_back(last[i]);
    std::ranges::reverse(exits[i]);
  }
  auto groups = graph.nodes[root];
  for (auto at = root; !exits[at].empty();) {
    const auto& edge = graph.edges[at][exits[at].back()];
    exits[at].pop_back();
    groups.push_back(edge.group);
    at = edge.to;
  }
  return groups;
}

bool keeps_runs(const std::vector<std::size_t>& order, const std::vector<OrderedItem>& items,
                const std::vector<OrderRules::Run>& runs) {
  return std::ranges::all_of(runs, [&](const auto& run) {
    int length = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto value = items[order[i]].values[run.factor];
      length = i > 0 && items[order[i - 1]].values[run.factor] == value ? length + 1 : 1;
      if (length > run.limit) return false;
    }
    return true;
  });
}

ListOrder equally_often(const std::vector<OrderedItem>& items, const OrderRules& rules, core::Draws& draws) {
  ListOrder result;
  auto groups = groups_of(items, rules.equally);
  const auto each = groups.front().items.size();
  if (std::ranges::any_of(groups, [&](const auto& group) { return group.items.size() != each; })) {
    result.problem = phrase("the values that are to follow each other do not come equally often in the list");
    result.allowed = phrase("make \"repeats\" a multiple of the number of combinations in \"balance\"");
    return result;
  }
  // Before the graph is made, which may be large: a list that is long enough for it.
  const double paths = std::pow(static_cast<double>(groups.size()), static_cast<double>(rules.back) + 1);
  const auto may = [&](std::size_t before, std::size_t now) {
    return may_follow(groups[before].values, groups[now].values, rules);
  };
  const bool all_pairs =
      rules.never.empty() && std::ranges::none_of(rules.runs, [](const auto& run) { return run.limit == 1; });
  if ((all_pairs && paths > static_cast<double>(items.size())) || paths > kMostPaths) {
    result.problem = phrase("the list is too short for each value to follow each other one");
    result.allowed =
        phrase("fewer values, a smaller \"back\", or at least %1 trials", {plain(core::number(paths, 6))});
    return result;
  }
  const auto graph = graph_of(groups.size(), rules.back, may);
  if (graph.nodes.empty() || !is_eulerian(graph)) {
    result.problem = phrase("the allowed pairs cannot all come equally often");
    result.allowed = phrase("as many values that may come before each value as may come after it");
    return result;
  }
  std::vector<std::size_t> before(groups.size());
  for (const auto& edges : graph.edges)
    for (const auto& edge : edges) ++before[edge.group];
  if (std::ranges::any_of(before, [&](const auto count) { return count != before.front(); })) {
    result.problem = phrase("the allowed pairs cannot all come equally often if all values do");
    result.allowed = phrase("equally many values that may come before each value");
    return result;
  }
  if (each % before.front() != 0) {
    result.problem = phrase("each value comes %1 times in the list, and may follow %2 others",
                            {plain(static_cast<int>(each)), plain(static_cast<int>(before.front()))});
    result.allowed = phrase("a multiple of %1", {plain(static_cast<int>(before.front()))});
    return result;
  }
  const auto most_walks = std::min(1.0 * kMostWalks, kMostOperations / static_cast<double>(items.size()));
  for (int attempt = 0; attempt < most_walks; ++attempt) {
    result.items.clear();
    auto left = groups;
    for (auto& group : left) draws.shuffle(group.items);
    const auto order = walk(graph, each / before.front(), draws);
    for (std::size_t i = 0; i < order.size(); ++i) {
      auto& from = left[order[i]].items;
      if (i < rules.back) {
        result.items.push_back(from[static_cast<std::size_t>(draws.below(from.size()))]);
      } else {
        result.items.push_back(from.back());
        from.pop_back();
      }
    }
    if (keeps_runs(result.items, items, rules.runs)) return result;
  }
  result.items.clear();
  result.problem = none_found(), result.allowed = loosen();
  return result;
}

// --- only pairs that never come, and limits of runs

/// The same items with only those differences that rules can see: factors without rules have one value, and
/// so have all values that no rule of a factor tells apart.
std::vector<OrderedItem> as_ruled(std::vector<OrderedItem> items, const OrderRules& rules) {
  constexpr auto other = std::numeric_limits<std::size_t>::max();
  const auto factors = items.front().values.size();
  std::vector<bool> has_run(factors);
  for (const auto& run : rules.runs) has_run[run.factor] = true;
  std::vector<std::set<std::size_t>> named(factors);
  for (const auto& never : rules.never)
    named[never.factor].insert(never.before), named[never.factor].insert(never.now);
  for (auto& item : items)
    for (std::size_t factor = 0; factor < factors; ++factor)
      if (!has_run[factor] && !named[factor].contains(item.values[factor])) item.values[factor] = other;
  return items;
}

/// Looks for an order, item by item, and takes back items after which there is none.
class Search {
 public:
  Search(const std::vector<OrderedItem>& items, const OrderRules& rules)
      : items_(as_ruled(items, rules)), rules_(rules) {
    Values all(items_.front().values.size());
    std::iota(all.begin(), all.end(), 0);
    kinds_ = groups_of(items_, all);
    kind_of_.resize(items_.size());
    for (std::size_t k = 0; k < kinds_.size(); ++k)
      for (const auto item : kinds_[k].items) kind_of_[item] = k;
    std::set<std::size_t> ruled;
    for (const auto& never : rules_.never) ruled.insert(never.factor);
    for (const auto& run : rules_.runs) ruled.insert(run.factor);
    if (ruled.size() > 1) factors_.assign(ruled.begin(), ruled.end());
  }

  std::size_t kinds() const { return kinds_.size(); }
  /// The largest number of kinds with which a list of this length can be ordered.
  std::size_t most_kinds() const {
    std::size_t most = 1;
    while (operations(most + 1) <= kMostOperations / 2) ++most;
    return most;
  }

  /// False if even a search that takes little back would need too many operations.
  bool prepare() {
    if (operations(kinds_.size()) > kMostOperations / 2) return false;
    relations_.push_back(relation_of([](const Values& values) { return values; }));
    for (const auto factor : factors_)
      relations_.push_back(
          relation_of([factor](const Values& values) { return Values{values[factor]}; }, factor));
    for (const auto& item : items_)
      repeat_at_.push_back(item.repeat), repeats_ = std::max(repeats_, item.repeat + 1);
    std::ranges::sort(repeat_at_);
    return true;
  }

  enum class End { found, none, given_up };

  End run(core::Draws& draws) {
    const auto n = items_.size();
    left_.assign(repeats_, std::vector<int>(kinds_.size()));
    for (std::size_t i = 0; i < n; ++i) ++left_[items_[i].repeat][kind_of_[i]];
    chosen_.clear();
    std::vector<std::vector<std::size_t>> open{choices(repeat_at_[0], draws)};
    const auto take_back = [&] {
      ++left_[repeat_at_[chosen_.size() - 1]][chosen_.back()];
      chosen_.pop_back();
    };
    const auto most_steps = kMostSteps + 2 * n;
    for (std::size_t steps = 0; steps < most_steps && spent_ < kMostOperations;) {
      if (open.back().empty()) {
        open.pop_back();
        if (open.empty()) return End::none;
        take_back();
        continue;
      }
      chosen_.push_back(open.back().back());
      open.back().pop_back();
      const auto repeat = repeat_at_[chosen_.size() - 1];
      --left_[repeat][chosen_.back()];
      if (!can_go_on(repeat)) {
        take_back();
        continue;
      }
      ++steps;
      if (chosen_.size() == n) return End::found;
      open.push_back(choices(repeat_at_[chosen_.size()], draws));
    }
    return End::given_up;
  }

  bool may_try_again() const { return spent_ < kMostOperations; }

  /// The order that was found. Items of one kind and repeat come in a random order.
  std::vector<std::size_t> order(core::Draws& draws) const {
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> left;
    for (std::size_t i = 0; i < items_.size(); ++i) left[{items_[i].repeat, kind_of_[i]}].push_back(i);
    for (auto& [which, list] : left) draws.shuffle(list);
    std::vector<std::size_t> result;
    for (std::size_t at = 0; at < chosen_.size(); ++at) {
      auto& list = left[{repeat_at_[at], chosen_[at]}];
      result.push_back(list.back());
      list.pop_back();
    }
    return result;
  }

 private:
  /// Operations of a search that takes nothing back, if the list had this many kinds.
  double operations(std::size_t kinds) const {
    const auto k = static_cast<double>(kinds);
    const auto rules = static_cast<double>(rules_.never.size() + rules_.runs.size());
    return (2 + static_cast<double>(factors_.size())) * k * k *
           (static_cast<double>(items_.size()) + rules + k / kBits);
  }

  /// The kinds that may come next, in random order; the last one is tried first. It is that of a random item
  /// of those left, the one before it that of a random item of the other kinds, and so on.
  std::vector<std::size_t> choices(std::size_t repeat, core::Draws& draws) {
    std::vector<std::size_t> kinds, result;
    std::uint64_t items = 0;
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
      const auto left = left_[repeat][k];
      if (left == 0 || (!chosen_.empty() && !relations_[0].may[chosen_.back()][k]) || makes_long(k)) continue;
      kinds.push_back(k), items += static_cast<std::uint64_t>(left);
    }
    spent_ += static_cast<double>(kinds_.size() * (1 + rules_.runs.size()) + kinds.size() * kinds.size());
    while (!kinds.empty()) {
      auto item = draws.below(items);
      std::size_t at = 0;
      for (; item >= left_of(repeat, kinds[at]); ++at) item -= left_of(repeat, kinds[at]);
      items -= left_of(repeat, kinds[at]);
      result.push_back(kinds[at]);
      kinds.erase(kinds.begin() + static_cast<std::ptrdiff_t>(at));
    }
    std::ranges::reverse(result);
    return result;
  }

  std::uint64_t left_of(std::size_t repeat, std::size_t kind) const {
    return static_cast<std::uint64_t>(left_[repeat][kind]);
  }

  int run_of(const OrderRules::Run& run) const {
    int length = 0;
    for (auto at = chosen_.rbegin(); at != chosen_.rend() && length < run.limit; ++at, ++length)
      if (kinds_[*at].values[run.factor] != kinds_[chosen_.back()].values[run.factor]) break;
    return length;
  }

  bool makes_long(std::size_t kind) const {
    return !chosen_.empty() && std::ranges::any_of(rules_.runs, [&](const auto& run) {
      return kinds_[kind].values[run.factor] == kinds_[chosen_.back()].values[run.factor] &&
             run_of(run) >= run.limit;
    });
  }

  /// Which classes of items may follow each other: kinds, or the values of one factor.
  struct Relation {
    std::vector<std::size_t> class_of;  ///< by kind
    std::vector<std::vector<bool>> may;
    std::vector<std::vector<bool>> narrower;  ///< whether all that may come before a may come before b, too
  };

  /// `part` is what an item's class depends on; a class of one factor only has the rules of this factor.
  template <class Part>
  Relation relation_of(const Part& part, std::optional<std::size_t> factor = std::nullopt) const {
    OrderRules rules;
    for (const auto& never : rules_.never)
      if (!factor || never.factor == *factor) rules.never.push_back(never);
    for (const auto& run : rules_.runs)
      if (!factor || run.factor == *factor) rules.runs.push_back(run);
    Relation relation;
    std::map<Values, std::size_t> classes;
    std::vector<Values> first;
    for (const auto& kind : kinds_) {
      const auto [found, is_new] = classes.try_emplace(part(kind.values), classes.size());
      if (is_new) first.push_back(kind.values);
      relation.class_of.push_back(found->second);
    }
    const auto n = first.size();
    relation.may.assign(n, std::vector<bool>(n));
    relation.narrower.assign(n, std::vector<bool>(n));
    std::vector<std::vector<std::uint64_t>> before(n, std::vector<std::uint64_t>(n / kBits + 1));
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b)
        if (may_follow(first[a], first[b], rules)) {
          relation.may[a][b] = true;
          before[b][a / kBits] |= std::uint64_t{1} << (a % kBits);
        }
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b)
        relation.narrower[a][b] = std::ranges::equal(
            before[a], before[b], [](std::uint64_t of_a, std::uint64_t of_b) { return (of_a & ~of_b) == 0; });
    return relation;
  }

  /// False if some classes together need more items before them than are left.
  static bool has_enough_before(const Relation& relation, const std::vector<int>& left, std::size_t last) {
    const auto n = relation.may.size();
    std::vector<int> counts(n);
    for (std::size_t k = 0; k < left.size(); ++k) counts[relation.class_of[k]] += left[k];
    for (std::size_t k = 0; k < n; ++k) {
      if (counts[k] == 0) continue;
      int need = 0, have = relation.may[relation.class_of[last]][k] ? 1 : 0;
      for (std::size_t other = 0; other < n; ++other) {
        if (relation.narrower[other][k]) need += counts[other];
        if (relation.may[other][k]) have += counts[other];
      }
      if (need > have) return false;
    }
    return true;
  }

  /// False if the rest of this repeat cannot be ordered: not enough can come before some of its items, or a
  /// value comes too often for its runs.
  bool can_go_on(std::size_t repeat) {
    const auto& left = left_[repeat];
    const auto last = chosen_.back();
    for (const auto& relation : relations_) {
      spent_ += static_cast<double>(relation.may.size() * relation.may.size() + left.size());
      if (!has_enough_before(relation, left, last)) return false;
    }
    const int all = std::accumulate(left.begin(), left.end(), 0);
    return std::ranges::all_of(rules_.runs, [&](const auto& run) {
      std::map<std::size_t, int> counts;
      for (std::size_t k = 0; k < kinds_.size(); ++k)
        if (left[k] > 0) counts[kinds_[k].values[run.factor]] += left[k];
      return std::ranges::all_of(counts, [&](const auto& entry) {
        const bool begun = kinds_[last].values[run.factor] == entry.first;
        return entry.second <= run.limit * (all - entry.second) + run.limit - (begun ? run_of(run) : 0);
      });
    });
  }

  static constexpr std::size_t kBits = 64;

  const std::vector<OrderedItem> items_;
  const OrderRules& rules_;
  std::vector<std::size_t> factors_;  ///< those with rules, if there are several
  std::vector<Group> kinds_;
  std::vector<std::size_t> kind_of_;
  std::vector<Relation> relations_;     ///< of the kinds, and of each of these factors
  std::vector<std::size_t> repeat_at_;  ///< the repeat at each place of the list
  double spent_ = 0;                    ///< operations so far
  std::size_t repeats_ = 1;
  std::vector<std::vector<int>> left_;  ///< by repeat and kind
  std::vector<std::size_t> chosen_;     ///< kinds
};

ListOrder searched(const std::vector<OrderedItem>& items, const OrderRules& rules, core::Draws& draws) {
  Search search(items, rules);
  if (!search.prepare())
    return {
        {},
        phrase(
            "the list is too long for rules of its order: %1 trials, of %2 kinds that the rules tell apart",
            {plain(items.size()), plain(search.kinds())}),
        phrase("fewer trials, or at most %1 such kinds in as many trials", {plain(search.most_kinds())})};
  for (int i = 0; i < kMostSearches && search.may_try_again(); ++i) {
    const auto end = search.run(draws);
    if (end == Search::End::found) return {search.order(draws), {}, {}};
    if (end == Search::End::none) return {{}, phrase("there is no order that keeps its rules"), loosen()};
  }
  return {{}, none_found(), loosen()};
}

}  // namespace

ListOrder in_order(const std::vector<OrderedItem>& items, const OrderRules& rules, core::Draws& draws) {
  if (items.empty()) return {};
  return rules.equally.empty() ? searched(items, rules, draws) : equally_often(items, rules, draws);
}

}  // namespace turnpoint::procedure
