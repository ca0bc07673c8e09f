#pragma once
#include <cstddef>
#include <utility>
#include <vector>

#include "station/core/draws.hpp"
#include "station/core/texts.hpp"

namespace turnpoint::procedure {

/// What the order of a list must keep. Factors and values have numbers.
struct OrderRules {
  /// factors whose combinations of values follow each other equally often; may be empty
  std::vector<std::size_t> equally;
  /// how many items back that holds: with 2, each combination comes equally often after each pair of others,
  /// and so on
  std::size_t back = 1;
  struct Never {
    std::size_t factor = 0, before = 0, now = 0;
  };
  std::vector<Never> never;  ///< values of a factor that never follow each other directly
  struct Run {
    std::size_t factor = 0;
    int limit = 1;
  };
  std::vector<Run> runs;  ///< longest run of one value of a factor
  bool empty() const { return equally.empty() && never.empty(); }
};

/// An item of the list: the number of its value of each factor, and the repeat to which it belongs. Repeats
/// come one after the other; an item comes within its repeat.
struct OrderedItem {
  std::vector<std::size_t> values;
  std::size_t repeat = 0;
};

/// A random order of a list that keeps all rules, as numbers of items; or why there is none.
struct ListOrder {
  std::vector<std::size_t> items;
  core::Phrase problem, allowed;  ///< empty if there is an order
};

/// Orders a list. With OrderRules::equally, repeats are ignored, and the list begins with `back` items that
/// come once more, so that each combination (of those that `never` and runs of 1 allow) comes exactly equally
/// often after each other one: a random walk through a graph of de Bruijn that uses each of its edges equally
/// often (all walks have the same probability: the algorithm of Wilson 1996 for trees, with the theorem of
/// van Aardenne-Ehrenfest & de Bruijn 1951). Otherwise a random search, which says that there is no order if
/// it has looked at all of them.
ListOrder in_order(const std::vector<OrderedItem>& items, const OrderRules& rules, core::Draws& draws);

}  // namespace turnpoint::procedure
