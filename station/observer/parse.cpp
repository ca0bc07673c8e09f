#include <charconv>
#include <cmath>
#include <map>
#include <string>

#include "station/observer/observer.hpp"
#include "station/terms/usage_error.hpp"

namespace turnpoint::observer {

namespace {

/// Throws terms::UsageError that names the parameter out of range.
void check(const Parameters& p) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw terms::UsageError(std::string("--observer: ") + what);
  };
  require(!p.threshold || *p.threshold != 0, "threshold must not be 0");
  require(p.slope > 0, "slope must be above 0");
  require(p.scatter >= 0, "scatter must be 0 or more");
  require(p.lapse >= 0 && p.lapse <= 1 && p.anticipation >= 0 && p.anticipation <= 1,
          "lapse and anticipation must be probabilities from 0 to 1");
  require(p.bound > 0 && p.residual_s >= 0 && p.travel_s >= 0,
          "bound must be above 0, and residual and travel 0 or more");
  require(p.drift_sd >= 0 && p.start_range >= 0 && p.start_range < 1,
          "drift_sd must be 0 or more, and start_range at least 0 and below 1");
  require(p.residual_range_s >= 0 && p.residual_range_s <= 2 * p.residual_s,
          "residual_range must be from 0 to twice the residual");
}

}  // namespace

Parameters parse(const std::string& text) {
  Parameters p;
  double threshold = 0, floor = 0;
  const std::map<std::string, double*> known{{"threshold", &threshold},
                                             {"gradient", &p.gradient},
                                             {"floor", &floor},
                                             {"slope", &p.slope},
                                             {"lapse", &p.lapse},
                                             {"bias", &p.bias},
                                             {"criterion", &p.criterion},
                                             {"scatter", &p.scatter},
                                             {"bound", &p.bound},
                                             {"residual", &p.residual_s},
                                             {"travel", &p.travel_s},
                                             {"drift_sd", &p.drift_sd},
                                             {"start_range", &p.start_range},
                                             {"residual_range", &p.residual_range_s},
                                             {"anticipation", &p.anticipation}};
  const std::string allowed =
      "sim, or sim: and threshold, gradient, floor, slope, lapse, bias, criterion, scatter, bound, residual, "
      "travel, "
      "drift_sd, start_range, residual_range, anticipation with numbers, as in sim:threshold=6,slope=1.2";
  const auto colon = text.find(':');
  if (text.substr(0, colon) != "sim") throw terms::UsageError("--observer " + text + ": " + allowed);
  for (std::size_t at = colon; at != std::string::npos;) {
    const auto end = text.find(',', at + 1);
    const auto part = text.substr(at + 1, end == std::string::npos ? end : end - at - 1);
    const auto equals = part.find('=');
    const auto found = known.find(part.substr(0, equals));
    double value = 0;
    const char* first = part.data() + (equals == std::string::npos ? part.size() : equals + 1);
    const auto [last, error] = std::from_chars(first, part.data() + part.size(), value);
    if (found == known.end() || error != std::errc{} || last != part.data() + part.size() ||
        !std::isfinite(value))
      throw terms::UsageError("--observer: \"" + part + "\" is not understood; write " + allowed);
    *found->second = value;
    if (found->first == "threshold") p.threshold = value;
    if (found->first == "floor") p.floor = value;
    at = end;
  }
  check(p);
  return p;
}

}  // namespace turnpoint::observer
