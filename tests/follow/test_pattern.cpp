#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "station/follow/pattern.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::follow;
using turnpoint::core::DrawKey;

namespace {

Pattern of(const Part& part) {
  Pattern pattern;
  pattern.base = 0.7;
  add(pattern, part);
  return pattern;
}

double at(const Pattern& pattern, double place_m, double time_s = 0) {
  return asked_at(pattern, {}, place_m, time_s);
}

Part wave(Shape shape) {
  Part part;
  part.shape = shape;
  part.from = 0.4, part.to = 0.8;
  part.cycles_per_m = 250;  // a period of 4 mm
  part.place_m = 0.01;
  return part;
}

}  // namespace

TEST_CASE("textures have their values from `from` to `to`", "[pattern]") {
  const auto sine = of(wave(Shape::sine)), square = of(wave(Shape::square)),
             triangle = of(wave(Shape::triangle));
  for (const double place : {0.01, 0.05, -0.03}) {  // whole periods from the origin
    CHECK(at(sine, place) == Approx(0.6));
    CHECK(at(sine, place + 0.001) == Approx(0.8));
    CHECK(at(sine, place + 0.003) == Approx(0.4));
    CHECK(at(square, place + 0.0001) == 0.8);
    CHECK(at(square, place + 0.0021) == 0.4);
    CHECK(at(triangle, place + 0.001) == Approx(0.6));
    CHECK(at(triangle, place + 0.002) == Approx(0.8));
    CHECK(at(triangle, place + 0.0039) == Approx(0.42));
  }
}

TEST_CASE("a texture moves with its cycles per second", "[pattern]") {
  auto part = wave(Shape::sine);
  part.cycles_per_s = -25;  // 100 mm/s towards larger places
  const auto pattern = of(part);
  for (const double time : {0.0, 0.013, 1.7}) CHECK(at(pattern, 0.011 + 0.1 * time, time) == Approx(0.8));
}

TEST_CASE("edges, bumps and gradients are where they are asked for", "[pattern]") {
  Part edge;
  edge.shape = Shape::edge, edge.from = 0.4, edge.to = 0.8, edge.place_m = 0.1;
  CHECK(at(of(edge), 0.0999) == 0.4);
  CHECK(at(of(edge), 0.1001) == 0.8);
  edge.width_m = 0.002;
  CHECK(at(of(edge), 0.1) == Approx(0.6));
  CHECK(at(of(edge), 0.099) == Approx(0.4));
  CHECK(at(of(edge), 0.1005) == Approx(0.6 + 0.2 * std::sin(std::numbers::pi / 4)));
  Part bump = edge;
  bump.shape = Shape::bump, bump.width_m = 0.02;
  CHECK(at(of(bump), 0.1) == Approx(0.8));
  CHECK(at(of(bump), 0.105) == Approx(0.6));
  CHECK(at(of(bump), 0.0899) == Approx(0.4));
  Part gradient;
  gradient.shape = Shape::gradient, gradient.from = 0.4, gradient.to = 0.8;
  gradient.begin_m = 0.05, gradient.end_m = 0.15;
  CHECK(at(of(gradient), 0.075) == Approx(0.5));
  CHECK(at(of(gradient), 0.16) == 0.7);  // the base, outside the part
}

TEST_CASE("parts replace or add to the parts before them", "[pattern]") {
  Pattern pattern;
  pattern.base = 0.5;
  auto part = wave(Shape::sine);
  part.combine = Combine::add, part.from = -0.1, part.to = 0.1;
  add(pattern, part);
  CHECK(at(pattern, 0.011) == Approx(0.6));
  Part over;
  over.to = 0.3, over.begin_m = 0.05, over.end_m = 0.06;
  add(pattern, over);
  CHECK(at(pattern, 0.055) == 0.3);
  CHECK(at(pattern, 0.061) == Approx(0.4 + 0.2 * (0.5 + 0.5 * std::sin(2 * std::numbers::pi * 12.75))));
}

TEST_CASE("a table is one cycle, and joins its end to its beginning", "[pattern]") {
  Pattern pattern;
  const std::vector<double> samples{0, 1, 0.5, 0.25};
  auto part = wave(Shape::table);
  const auto section = add_table(pattern, samples);
  part.table_first = section.first, part.table_count = section.count;
  add(pattern, part);
  CHECK(at(pattern, 0.011) == Approx(0.8));
  CHECK(at(pattern, 0.0105) == Approx(0.6));
  CHECK(at(pattern, 0.0135) == Approx(0.4 + 0.4 * 0.125));
}

TEST_CASE("noise has the given spectrum exactly, and depends on its key only", "[pattern]") {
  const std::vector<SpectrumPoint> spectrum{{100, 4}, {200, 1}, {300, 1}};
  const double length = 0.1;
  const auto draw = [&](std::uint64_t seed) {
    Pattern pattern;
    const auto section = add_noise(pattern, spectrum, length, 512, DrawKey{seed});
    return std::vector<double>(pattern.table.begin() + section.first,
                               pattern.table.begin() + section.first + section.count);
  };
  const auto one = draw(1), again = draw(1), other = draw(2);
  CHECK(one == again);
  CHECK(one != other);
  double mean = 0, square = 0;
  for (const double x : one) mean += x / 512, square += x * x / 512;
  CHECK(mean == Approx(0.5).margin(1e-3));
  CHECK(std::sqrt(square - mean * mean) == Approx(1.0 / 6).epsilon(0.01));
  // power at k cycles per length: 40 periods of 0.1 m have 4 at 100 per m, and so on
  const auto power = [&](int k) {
    std::complex<double> sum;
    for (int i = 0; i < 512; ++i)
      sum += one[static_cast<std::size_t>(i)] * std::polar(1.0, -2 * std::numbers::pi * k * i / 512);
    return std::norm(sum);
  };
  CHECK(power(10) / power(25) == Approx(4).epsilon(0.05));
  CHECK(power(15) / power(25) == Approx(2.5).epsilon(0.05));
  CHECK(power(9) / power(25) < 1e-2);
  CHECK(power(31) / power(25) < 1e-2);
}

TEST_CASE("events begin and end parts", "[pattern]") {
  Part part;
  part.to = 0.2;
  Situation now{0, 0.05, 0.1, 0.5, true};
  PatternState state;
  const auto value = [&](const Pattern& pattern) {
    note(pattern, state, now);
    return asked_at(pattern, state, now.place_m, now.time_s);
  };
  SECTION("a click: above a force, until it is released") {
    part.trigger.event = Event::force, part.trigger.threshold = 1;
    const auto pattern = of(part);
    now.contact = false, now.normal_N = 0;
    CHECK(value(pattern) == 0.7);
    now.contact = true, now.normal_N = 0.99;
    CHECK(value(pattern) == 0.7);
    now.normal_N = 1.01;
    CHECK(value(pattern) == 0.2);
    now.normal_N = 0.85;  // above four fifths
    CHECK(value(pattern) == 0.2);
    now.normal_N = 0.75;
    CHECK(value(pattern) == 0.7);
    now.normal_N = 1.1;
    CHECK(value(pattern) == 0.2);
  }
  SECTION("a change at contact, after a delay and for a while") {
    part.trigger.event = Event::contact, part.trigger.delay_s = 0.1, part.trigger.lasts_s = 0.2;
    const auto pattern = of(part);
    now.contact = false;
    CHECK(value(pattern) == 0.7);
    now.contact = true, now.time_s = 1;
    CHECK(value(pattern) == 0.7);
    now.time_s = 1.11;
    CHECK(value(pattern) == 0.2);
    now.time_s = 1.31;
    CHECK(value(pattern) == 0.7);
  }
  SECTION("a place that is passed, until the finger lifts") {
    part.trigger.event = Event::place, part.trigger.threshold = 0.06, part.trigger.until = Until::lifted;
    const auto pattern = of(part);
    CHECK(value(pattern) == 0.7);
    now.place_m = 0.061;
    CHECK(value(pattern) == 0.2);
    now.place_m = 0.02;
    CHECK(value(pattern) == 0.2);
    now.contact = false;
    CHECK(value(pattern) == 0.7);
    now.contact = true, now.place_m = 0.07;  // lands behind the place: it has not been passed
    CHECK(value(pattern) == 0.7);
  }
  SECTION("a speed, in both directions") {
    part.trigger.event = Event::speed, part.trigger.threshold = 0.15;
    const auto pattern = of(part);
    CHECK(value(pattern) == 0.7);
    now.speed_m_s = -0.16;
    CHECK(value(pattern) == 0.2);
    now.speed_m_s = -0.1;
    CHECK(value(pattern) == 0.7);
  }
}

TEST_CASE("parts that make no sense are refused", "[pattern]") {
  const auto refused = [](auto change, Shape shape) {
    Pattern pattern;
    auto part = wave(shape);
    change(part);
    CHECK_THROWS_AS(add(pattern, part), std::invalid_argument);
  };
  refused([](Part& p) { p.to = NAN; }, Shape::sine);
  refused([](Part& p) { p.cycles_per_m = 0; }, Shape::square);
  refused([](Part& p) { p.end_m = p.begin_m; }, Shape::sine);
  refused([](Part& p) { p.width_m = 0; }, Shape::bump);
  refused([](Part&) {}, Shape::gradient);
  refused([](Part& p) { p.table_count = 4; }, Shape::table);
  refused([](Part& p) { p.trigger.delay_s = -1; }, Shape::sine);
  Pattern pattern;
  for (int i = 0; i < kMostParts; ++i) add(pattern, wave(Shape::sine));
  CHECK_THROWS_AS(add(pattern, wave(Shape::sine)), std::invalid_argument);
  CHECK_THROWS_AS(add_table(pattern, std::vector<double>{0, 1.5}), std::invalid_argument);
  CHECK_THROWS_AS(add_table(pattern, std::vector<double>(2049, 0.5)), std::invalid_argument);
  CHECK_THROWS_AS(add_noise(pattern, std::vector<SpectrumPoint>{{1, 1}, {2, 1}}, 0.1, 512, {}),
                  std::invalid_argument);
}
