#include "station/sensing/raw_ring.hpp"

#include <vector>

#include "tests/support/catch.hpp"

using namespace turnpoint::sensing;

namespace {

constexpr int kRate_Hz = 1000;

/// The samples of two channels in these frames: frame n has 10 n and 10 n + 1.
std::vector<std::int32_t> frames(std::int64_t first, std::int64_t end) {
  std::vector<std::int32_t> samples;
  for (auto n = first; n < end; ++n)
    for (int c = 0; c < 2; ++c) samples.push_back(static_cast<std::int32_t>(10 * n + c));
  return samples;
}

void push(RawRing& ring, std::int64_t first, std::int64_t end) {
  const auto samples = frames(first, end);
  ring.push({samples, 2, first, kRate_Hz});
}

}  // namespace

TEST_CASE("a ring returns the newest frames in order, whatever the length of the blocks", "[sensing][raw]") {
  const std::int64_t length = GENERATE(1, 3, 7, 10, 25);
  RawRing ring(kRate_Hz, 2, 0.01);
  CHECK(ring.newest().samples.empty());
  std::int64_t next = -20;
  for (; next < 60; next += length) {
    push(ring, next, next + length);
    const auto raw = ring.newest();
    CAPTURE(length, next);
    REQUIRE(raw.first_frame == std::max<std::int64_t>(-20, next + length - 10));
    REQUIRE(raw.samples == frames(raw.first_frame, next + length));
  }
  CHECK(ring.newest().channels == 2);
  CHECK(ring.newest().rate_Hz == kRate_Hz);
}

TEST_CASE("frames that were lost are noted in the ring, and frames that are numbered anew replace it",
          "[sensing][raw]") {
  RawRing ring(kRate_Hz, 2, 0.01);
  push(ring, 100, 104);
  push(ring, 106, 108);
  auto expected = frames(100, 108);
  for (std::size_t k = 8; k < 12; ++k) expected[k] = kNotCaptured;
  CHECK(ring.newest().first_frame == 100);
  CHECK(ring.newest().samples == expected);

  SECTION("a gap as long as the ring") {
    push(ring, 118, 120);
    CHECK(ring.newest().first_frame == 118);
    CHECK(ring.newest().samples == frames(118, 120));
  }
  SECTION("an earlier number") {
    push(ring, 50, 53);
    CHECK(ring.newest().first_frame == 50);
    CHECK(ring.newest().samples == frames(50, 53));
  }
}

TEST_CASE("a sample with the value that means lost is changed by the least amount", "[sensing][raw]") {
  RawRing ring(kRate_Hz, 1, 0.01);
  const std::vector<std::int32_t> samples{kNotCaptured, 5, kNotCaptured + 1};
  ring.push({samples, 1, 0, kRate_Hz});
  CHECK(ring.newest().samples == std::vector<std::int32_t>{kNotCaptured + 1, 5, kNotCaptured + 1});
}
