#include <algorithm>
#include <stdexcept>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

namespace {

// A Williams square (1949): row r is the zig-zag 0, 1, n-1, 2, n-2, ... with r added to each number modulo n.
// Every condition then follows every other one equally often. If n is odd, this holds only for the rows
// together with the reversed rows.
std::vector<int> williams_row(int n, int row) {
  const bool reversed = n % 2 == 1 && row % (2 * n) >= n;
  std::vector<int> order;
  for (int i = 0; i < n; ++i) {
    const int zigzag = i % 2 == 1 ? (i + 1) / 2 : (n - i / 2) % n;
    order.push_back((zigzag + row) % n);
  }
  if (reversed) std::reverse(order.begin(), order.end());
  return order;
}

void unroll(const Sequence& sequence, const Protocol& protocol, int index, std::size_t part,
            std::vector<Block>& blocks) {
  const auto same = [&](const Factor& factor) { return factor.name == sequence.over; };
  const auto factor = std::find_if(protocol.factors.begin(), protocol.factors.end(), same);
  if (factor == protocol.factors.end() || factor->levels.empty())
    throw std::invalid_argument("sequence " + sequence.name + ": the factor \"" + sequence.over +
                                "\" has no levels");
  auto order = williams_row(static_cast<int>(factor->levels.size()), index);
  for (int cycle = 0; cycle < sequence.cycles; ++cycle) {
    for (const int level : order) {
      auto block = sequence.block;
      block.fixed[sequence.over] = factor->levels[static_cast<std::size_t>(level)];
      block.part = part;
      blocks.push_back(std::move(block));
    }
    if (sequence.mirror) std::reverse(order.begin(), order.end());
  }
}

}  // namespace

std::vector<Block> block_order(const Protocol& protocol, int sequence_index) {
  if (sequence_index < 0)
    throw std::invalid_argument("sequence index " + std::to_string(sequence_index) + ": from 0");
  std::vector<Block> blocks;
  for (std::size_t part = 0; part < protocol.plan.size(); ++part) {
    if (const auto* block = std::get_if<Block>(&protocol.plan[part])) {
      blocks.push_back(*block);
      blocks.back().part = part;
    } else {
      unroll(std::get<Sequence>(protocol.plan[part]), protocol, sequence_index, part, blocks);
    }
  }
  return blocks;
}

}  // namespace turnpoint::protocol
