#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "station/core/instruction_sets.hpp"
#include "station/sensing/sample_loops.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::sensing;

// The same loops for every processor, to compare them with those that this machine chooses.
namespace turnpoint::sensing::plain {
using loops::kTones;
}
#undef TURNPOINT_CLONES
#define TURNPOINT_CLONES
#define loops plain
#pragma GCC diagnostic ignored "-Wpsabi"
#include "station/sensing/sample_loops.cpp"  // NOLINT(bugprone-suspicious-include)
#undef loops

namespace {

/// The functions of one set of loops.
struct Loops {
  decltype(&loops::scale) scale;
  decltype(&loops::high_pass) high_pass;
  decltype(&loops::energy) energy;
  decltype(&loops::largest) largest;
  decltype(&loops::fold) fold;
  decltype(&loops::tones) tones;
  decltype(&loops::pick_four) pick_four;
  decltype(&loops::carrier) carrier;
  decltype(&loops::eight) eight;
};

template <class Number>
std::vector<Number> noise(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<Number> uniform(-1, 1);
  std::vector<Number> made(count);
  for (Number& value : made) value = uniform(random);
  return made;
}

std::vector<std::int32_t> samples_of(std::size_t count) {
  std::mt19937 random(5);
  std::vector<std::int32_t> made(count);
  for (auto& sample : made) sample = static_cast<std::int32_t>(random());
  return made;
}

/// Everything that the loops compute from one set of inputs, in one list.
std::vector<double> results(const Loops& loops, int frames) {
  const auto count = static_cast<std::size_t>(frames);
  std::vector<double> all;
  const auto keep = [&](const auto& some) { all.insert(all.end(), some.begin(), some.end()); };
  const auto s = noise<double>(count + 8, 1);
  std::vector<double> y(count);
  loops.high_pass(s.data() + 4, frames, 2, y.data());
  keep(y);
  all.push_back(loops.energy(s.data(), frames));
  all.push_back(loops.largest(s.data(), frames));
  const auto samples = samples_of(6 * count);
  loops.scale(samples.data() + 4, 6, frames, y.data());
  keep(y);
  const std::size_t half = count / 2;
  std::vector<double> even(half), odd(half);
  loops.fold(s.data(), half, even.data(), odd.data());
  keep(even), keep(odd);
  const auto rows = noise<double>(3 * count, 2), table = noise<double>(16 * count, 3);
  std::vector<double> sums(3 * 16);
  loops.tones(rows.data(), 3, count, table.data() + 8, 16, sums.data());
  keep(sums);
  for (const auto& channels : {std::array{1, 2, 3, 4}, std::array{5, 0, 2, 3}}) {
    std::vector<float> four(4 * count);
    loops.pick_four(samples.data(), frames, channels.data(), 6, four.data());
    keep(four);
  }
  const auto signals = noise<float>(4 * (2 * count + 1), 6), cosine = noise<float>(4 * (count + 1), 7),
             sine = noise<float>(4 * (count + 1), 8);
  std::array<float, 4> re{}, im{};
  loops.carrier(signals.data() + 4 * count, frames, cosine.data(), sine.data(), re.data(), im.data());
  keep(re), keep(im);
  const auto lanes = noise<double>(8 * (2 * count + 1), 9), taps = noise<double>(count + 1, 10);
  std::array<double, 8> eight{};
  loops.eight(lanes.data() + 8 * count, frames, taps.data(), eight.data());
  keep(eight);
  return all;
}

}  // namespace

TEST_CASE("the loops over samples give the same bits on every processor", "[sensing]") {
  for (const int frames : {1, 7, 88, 89, 90, 91, 192}) {
    namespace p = plain;
    const auto generic = results({p::scale, p::high_pass, p::energy, p::largest, p::fold, p::tones,
                                  p::pick_four, p::carrier, p::eight},
                                 frames);
    namespace l = loops;
    const auto best = results({l::scale, l::high_pass, l::energy, l::largest, l::fold, l::tones, l::pick_four,
                               l::carrier, l::eight},
                              frames);
    CAPTURE(frames);
    REQUIRE(generic.size() == best.size());
    for (std::size_t k = 0; k < generic.size(); ++k) {
      CAPTURE(k);
      REQUIRE(std::bit_cast<std::uint64_t>(generic[k]) == std::bit_cast<std::uint64_t>(best[k]));
    }
  }
}

TEST_CASE("the loops over samples compute the sums that their comments state", "[sensing]") {
  constexpr std::int64_t half = 89;
  const auto x = noise<float>(4 * (2 * half + 1), 1), even = noise<float>(4 * (half + 1), 2),
             odd = noise<float>(4 * (half + 1), 3);
  std::array<float, 4> re{}, im{};
  loops::carrier(x.data() + 4 * half, half, even.data(), odd.data(), re.data(), im.data());
  for (std::size_t i = 0; i < 4; ++i) {
    double real = 0, imaginary = 0;
    for (std::int64_t n = 0; n <= half; ++n) {
      const auto at = [&](const std::vector<float>& list, std::int64_t place) -> double {
        return list[static_cast<std::size_t>(4 * place) + i];
      };
      real += (at(x, half + n) + at(x, half - n)) * at(even, n);
      imaginary += (at(x, half + n) - at(x, half - n)) * at(odd, n);
    }
    CHECK(std::fabs(re[i] - real) < 1e-5);
    CHECK(std::fabs(im[i] - imaginary) < 1e-5);
  }
  const auto lanes = noise<double>(8 * (2 * half + 1), 4), taps = noise<double>(half + 1, 5);
  std::array<double, 8> eight{};
  loops::eight(lanes.data() + 8 * half, half, taps.data(), eight.data());
  for (std::size_t i = 0; i < 8; ++i) {
    double sum = 0;
    for (std::int64_t n = 0; n <= half; ++n)
      sum += (lanes[static_cast<std::size_t>(8 * (half + n)) + i] +
              lanes[static_cast<std::size_t>(8 * (half - n)) + i]) *
             taps[static_cast<std::size_t>(n)];
    CHECK(std::fabs(eight[i] - sum) < 1e-13);
  }
}

TEST_CASE("a missing sample makes the energy NaN, and is skipped by the largest sample", "[sensing]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::size_t missing : {std::size_t{0}, std::size_t{5}, std::size_t{17}}) {
    std::vector<double> s(18, 0.25);
    s[3] = -0.75;
    s[missing] = nan;
    CHECK(std::isnan(loops::energy(s.data(), 18)));
    CHECK(loops::largest(s.data(), 18) == 0.75);
  }
}
