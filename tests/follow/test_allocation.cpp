// Counts memory allocations while a follower works.
#include "tests/follow/lab.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/count_allocations.hpp"

using namespace turnpoint;

TEST_CASE("an update allocates no memory, whatever fails", "[follower]") {
  plant::Setup setup;
  auto plan = lab::plan_of(setup);
  plan.control = follow::Control::closed;
  follow::Part part;
  part.shape = follow::Shape::sine, part.from = 0.4, part.to = 0.8, part.cycles_per_m = 250;
  add(plan.pattern, part);
  follow::Follower follower(plan);
  std::int64_t frame = 0;
  follow::BridgeWindow window(follow::Bridges{}, plan.timing, {});
  const std::vector<std::int32_t> frames(4 * 96, 1000);
  std::int64_t captured = 0;
  const long before = allocations;
  for (int k = 0; k < 400; ++k) {
    follow::FingerSample sample;
    sample.frame = frame - 336, sample.normal_N = 0.5, sample.lateral_N = 0.2;
    sample.moment_Nm = 0.5 * (0.05 + 0.05e-3 * k);
    if (k % 100 == 90) sample.fault = follow::Fault::reference;
    if (k % 100 == 80) sample.normal_N = 0;
    if (k % 100 == 70) sample.moment_Nm = 2;
    window.push(frame, frames.data(), 96);
    captured += window.sample().frame;
    follower.update(frame, sample);
    frame += k % 100 == 60 ? 192 : 96;
  }
  CHECK(allocations == before);
  CHECK(captured > 0);
  CHECK(follower.last().interrupted != 0);
  const std::vector<double> counted(1000);
  CHECK(allocations > before);
}
