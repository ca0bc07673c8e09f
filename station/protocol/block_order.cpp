#include <algorithm>
#include <stdexcept>

#include "station/protocol/sources.hpp"
#include "station/protocol/visits.hpp"

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

/// Returns how many earlier sessions contain this sequence. A sequence may be absent from some sessions.
int number_of(const Sequence& sequence, int session) {
  const auto& sessions = sequence.block.audience.sessions;
  const auto earlier = [&](int other) { return other < session; };
  return sessions.empty() ? session - 1
                          : static_cast<int>(std::count_if(sessions.begin(), sessions.end(), earlier));
}

void unroll(const Sequence& sequence, const Protocol& protocol, const Visit& visit, std::size_t part,
            std::vector<Block>& blocks) {
  const auto same = [&](const Factor& factor) { return factor.name == sequence.over; };
  const auto factor = std::find_if(protocol.factors.begin(), protocol.factors.end(), same);
  if (factor == protocol.factors.end() || factor->levels.empty())
    throw std::invalid_argument("sequence " + sequence.name + ": the factor \"" + sequence.over +
                                "\" has no levels");
  // Participants at neighbouring places belong to different groups, so each group goes through all rows of
  // the square.
  const int row = visit.place / group_count(protocol), number = number_of(sequence, visit.session);
  const auto levels = static_cast<int>(factor->levels.size());
  auto order = williams_row(levels, sequence.one_per_session ? row : row + number);
  if (sequence.one_per_session) order = {order.at(static_cast<std::size_t>(number % levels))};
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

std::vector<Block> block_order(const Protocol& protocol, const Visit& visit) {
  if (visit.place < 0)
    throw std::invalid_argument("place in the counterbalancing " + std::to_string(visit.place) + ": from 0");
  if (visit.session < 1) throw std::invalid_argument("session " + std::to_string(visit.session) + ": from 1");
  std::vector<Block> blocks;
  for (std::size_t part = 0; part < protocol.plan.size(); ++part) {
    if (!is_for(block_of(protocol.plan[part]).audience, protocol, visit)) continue;
    if (const auto* block = std::get_if<Block>(&protocol.plan[part])) {
      blocks.push_back(*block);
      blocks.back().part = part;
    } else {
      unroll(std::get<Sequence>(protocol.plan[part]), protocol, visit, part, blocks);
    }
  }
  const auto group = group_of(protocol, visit.place);
  for (auto& block : blocks) block.fixed.insert(group.begin(), group.end());
  return blocks;
}

}  // namespace turnpoint::protocol
