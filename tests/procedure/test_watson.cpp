#include "station/procedure/trace.hpp"
#include "tests/procedure/watson.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::procedure;

// Tests QUEST+ with the levels and answers of the example runs published with Watson (2017).

TEST_CASE("Watson's run over threshold and slope is reproduced trial by trial", "[procedure]") {
  auto spec = watson_1();
  spec.slope.values = {2, 3, 4, 5};
  const auto result = trace(spec, {}, "1011111111111011011101111011111111111011001111010111011111111111");
  const std::vector<double> published{-18, -22, -12, -13, -15, -16, -17, -18, -19, -21, -24, -25, -26,
                                      -27, -21, -22, -23, -20, -20, -20, -21, -19, -19, -20, -20, -20,
                                      -19, -19, -19, -19, -19, -20, -20, -20, -20, -20, -21, -21, -20,
                                      -20, -20, -19, -18, -18, -19, -19, -19, -18, -18, -17, -18, -18,
                                      -18, -17, -17, -17, -17, -17, -17, -17, -18, -18, -18, -18};
  CHECK(result.levels == published);
  CHECK(result.estimates.at("threshold").mode == -20);
  CHECK(result.estimates.at("slope").mode == 3);
}

TEST_CASE("Watson's second example, with slope and lapse, is reproduced trial by trial", "[procedure]") {
  auto spec = watson_1();
  spec.slope.values = {2, 3, 4, 5};
  spec.lapse.values = {0, 0.01, 0.02, 0.03, 0.04};
  spec.stop.trials = 128;
  const auto result = trace(spec, {},
                            "11110011111111010111111101111111101111111110111011111111011111101111111111111010"
                            "111101101111111011111111111111101110100111101111");
  const std::vector<double> published{
      -18, -22, -25, -28, -30, -21, -12, -14, -15, -16, -18, -19, -20, -22, -23, -18, -19, -16, -17,
      -17, -18, -18, -18, -19, -19, -17, -17, -18, -18, -18, -18, -19, -19, -20, -18, -18, -18, -18,
      -18, -19, -19, -19, -19, -20, -18, -18, -18, -18, -18, -18, -18, -18, -18, -19, -19, -19, -20,
      -18, -18, -18, -18, -19, -19, -19, -18, -18, -18, -18, -19, -19, -19, -19, -19, -19, -19, -19,
      -20, -21, -19, -19, -19, -19, -19, -19, -19, -18, -19, -19, -16, -16, -16, -16, -16, -16, 0,
      0,   -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -21, -21, -19, -19,
      -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19};
  CHECK(result.levels == published);
  CHECK(result.estimates.at("threshold").mode == -20);
  CHECK(result.estimates.at("slope").mode == 5);
  CHECK(result.estimates.at("lapse").mode == 0.04);
}

TEST_CASE("Watson's third example, a cumulative normal with tied asymptotes, is reproduced trial by trial",
          "[procedure]") {
  Spec spec = watson_1();
  spec.function = Function::normal;
  spec.stimuli.values = range(-10, 10, 1);
  spec.threshold.values = range(-5, 5, 1);
  spec.slope.values = range(1, 10, 1);
  spec.lapse.values = {0, 0.01, 0.02, 0.03, 0.04};
  spec.guess = {{}, "lapse"};
  spec.stop.trials = 128;
  const auto result = trace(spec, {},
                            "10011111110100001101100010100100101001011101110000010000100010010001110011010001"
                            "100000100110110101101101000011110100010000111110");
  const std::vector<double> published{
      0,  -1, 2,  -2, 2,  3,  3,  -5, 3,  3,  3,  3,  -7, -7, -7, -7, 4,  -7, 4,  4,  4, -8, -8, -8, 4,  -8,
      4,  -8, -7, 4,  -7, -7, 4,  -7, 4,  -7, -6, 3,  -4, -5, 3,  3,  -7, 2,  2,  1,  0, -7, -6, -6, -6, 2,
      -5, 2,  -6, -5, 3,  -5, -5, 3,  4,  -5, -5, 4,  -4, -4, -4, -4, 4,  3,  3,  4,  5, 5,  -5, 5,  -5, -5,
      4,  5,  5,  -5, -4, -4, -4, -4, 5,  -4, -4, -3, 4,  4,  5,  5,  -4, 5,  -4, -4, 5, 4,  5,  5,  -5, 5,
      -4, -4, -4, -4, 5,  -4, 5,  4,  -4, 4,  -4, -4, -4, 4,  -4, -4, -4, 4,  4,  -4, 4, 4,  4,  -4};
  CHECK(result.levels == published);
  CHECK(result.estimates.at("threshold").mode == 0);
  CHECK(result.estimates.at("slope").mode == 4);
  CHECK(result.estimates.at("lapse").mode == 0.01);
}
