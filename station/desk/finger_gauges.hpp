#pragma once
#include <optional>
#include <string>

#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/session/monitor.hpp"

namespace turnpoint::desk {

/// The finger at this moment, as the operator sees it: a value along a scale, and the value in figures.
struct Gauge {
  std::optional<double> value;  ///< place on the scale, from 0 to 1; empty while no finger is on the surface
  double low = 0, high = 0;     ///< the range that the protocol asks for, from 0 to 1; equal if there is none
  std::string figure;           ///< such as "0.45 N"; "" while there is no value
  bool operator==(const Gauge&) const = default;
};

/// What the force cells say of the finger. Unlike the bars on the participant's page, these gauges need
/// nothing in the protocol, and they include the place of the finger.
struct FingerGauges {
  Gauge force, speed, position;
  bool operator==(const FingerGauges&) const = default;
};

/// Reads the gauges for a finger. Scales end at one and a half times the range that the protocol asks for; at
/// 2 N and 200 mm/s without such a range; and at the end of the strip. Pure.
FingerGauges finger_gauges(const std::optional<session::FingerSeen>& finger,
                           const std::optional<protocol::Sensing>& asked, const rig::Rig& rig);

}  // namespace turnpoint::desk
