#include <cstdint>
#include <memory>
#include <set>
#include <thread>

#include "station/audio/block_ring.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::audio;

namespace {

struct Numbers {
  std::int64_t first = 0, last = 0;
};

template <std::size_t capacity>
bool put(BlockRing<Numbers, capacity>& ring, std::int64_t number) {
  return ring.fill([&](Numbers& slot) { slot = {number, number}; });
}

}  // namespace

TEST_CASE("a block ring gives values back in order, and refuses one more than it can hold", "[drive]") {
  BlockRing<Numbers, 4> ring;
  CHECK(ring.take() == nullptr);
  for (int n = 0; n < 4; ++n) CHECK(put(ring, n));
  CHECK_FALSE(put(ring, 4));
  const Numbers* oldest = ring.take();
  REQUIRE(oldest != nullptr);
  CHECK(oldest->first == 0);
  CHECK_FALSE(put(ring, 4));  // the value that was taken is still in use
  CHECK(oldest->first == 0);
  for (int n = 1; n < 4; ++n) {
    const Numbers* next = ring.take();
    REQUIRE(next != nullptr);
    CHECK(next->first == n);
  }
  CHECK(put(ring, 5));
}

TEST_CASE("a block ring whose values are taken at once uses two slots only", "[drive]") {
  BlockRing<Numbers, 4> ring;
  std::set<const Numbers*> slots;
  for (int n = 0; n < 100; ++n) {
    REQUIRE(put(ring, n));
    slots.insert(ring.take());
  }
  CHECK(slots.size() == 2);
}

TEST_CASE("a block ring passes every value between two threads, whole and in order", "[drive]") {
  constexpr std::int64_t count = 50'000;
  const auto ring = std::make_unique<BlockRing<Numbers, 256>>();
  std::jthread producer([&] {
    for (std::int64_t n = 0; n < count;)
      if (put(*ring, n))
        ++n;
      else
        std::this_thread::yield();
  });
  for (std::int64_t expected = 0; expected < count;) {
    const Numbers* value = ring->take();
    if (value == nullptr) {
      std::this_thread::yield();
      continue;
    }
    if (value->first != expected || value->last != expected) FAIL(value->first << " instead of " << expected);
    ++expected;
  }
  SUCCEED();
}
