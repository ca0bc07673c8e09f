#include "station/protocol/carrier_advice.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/protocol/combinations.hpp"
#include "station/scene/force_carrier.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

using core::number;
using scene::ToneProduct;

/// Says how far one tone must be moved so that the filter of the force stops the product.
core::Phrase remedy(const ToneProduct& product, double carrier_Hz, int rate_Hz) {
  const double shift_Hz = std::ceil((scene::force_stop_Hz - product.distance_Hz) / std::abs(product.first));
  const auto distance_at = [&](double first_Hz) {
    const double sum_Hz = product.first * first_Hz + product.second * product.second_Hz;
    return std::abs(scene::captured_at(sum_Hz, rate_Hz) - carrier_Hz);
  };
  const double higher_Hz = product.first_Hz + shift_Hz, lower_Hz = product.first_Hz - shift_Hz;
  const bool up = distance_at(higher_Hz) > distance_at(lower_Hz);
  return up ? phrase(
                  "move a tone (that of %1 Hz to %2 Hz or higher), or compare the forces with those of "
                  "trials without these tones before you rely on them",
                  {plain(number(product.first_Hz, 7)), plain(number(higher_Hz, 7))})
            : phrase(
                  "move a tone (that of %1 Hz to %2 Hz or lower), or compare the forces with those of trials "
                  "without these tones before you rely on them",
                  {plain(number(product.first_Hz, 7)), plain(number(lower_Hz, 7))});
}

struct Worst {
  const Sight* sight = nullptr;
  ToneProduct product;
  int cases = 0;
};

}  // namespace

std::vector<core::Problem> carrier_warnings(const Protocol& protocol, const rig::Rig& rig,
                                            const std::vector<Sight>& sights) {
  if (!rig.capture || rig.capture->bridges.empty()) return {};
  const bool calibrated = rig.capture->forces && rig.capture->forces->carrier_Hz > 0;
  const double carrier_Hz = calibrated ? rig.capture->forces->carrier_Hz : core::kForceCarrier_Hz;
  const int rate_Hz = rig.output.rate_Hz;
  std::map<std::string, Worst> worst;
  for (const auto& sight : sights) {
    std::vector<double> tones_Hz;
    for (const auto& tone : sight.tones) tones_Hz.push_back(tone.frequency_Hz);
    const auto product = scene::nearest_product(tones_Hz, carrier_Hz, rate_Hz);
    if (!product || product->distance_Hz >= scene::force_band_Hz) continue;
    auto& of_scene = worst[sight.scene];
    if (of_scene.cases++ == 0 || product->distance_Hz < of_scene.product.distance_Hz)
      of_scene.sight = &sight, of_scene.product = *product;
  }
  std::vector<core::Problem> warnings;
  for (const auto& [name, found] : worst) {
    const auto& sight = *found.sight;
    warnings.push_back(
        {protocol.scenes.at(name).place,
         counted(in_case({name, sight.block, sight.factors},
                         phrase("%1 is only %2 Hz from the carrier of the force cells (%3 Hz), so distortion "
                                "can appear as an oscillation of the force",
                                {plain(scene::name(found.product)),
                                 plain(number(found.product.distance_Hz, 3)), plain(number(carrier_Hz))})),
                 found.cases),
         remedy(found.product, carrier_Hz, rate_Hz)});
  }
  return warnings;
}

}  // namespace turnpoint::protocol
