#pragma once
#include <cstdint>
#include <optional>

#include "station/protocol/protocol.hpp"
#include "station/sensing/trial_finger.hpp"
#include "station/session/page.hpp"

namespace turnpoint::session {

/// Decides what the bars on the participant's page show, and when they stand still. Uses no clock and no
/// device.
class Guide {
 public:
  /// shortest time between two movements of the bars
  static constexpr std::int64_t kEvery_ns = 50'000'000;

  /// Without guidance in the protocol, there are no bars.
  explicit Guide(const std::optional<protocol::Sensing>& sensing);

  bool guides() const { return sensing_.has_value(); }
  /// The bars as they were last shown; empty without guidance.
  const std::optional<Guidance>& bars() const { return bars_; }

  /// Moves the bars to the finger's present force and speed. Returns true if the bars have changed.
  bool move(const std::optional<sensing::FingerNow>& finger);
  /// Stops the bars during a stimulus, unless the protocol asks for live guidance. Returns true if this
  /// changed what is shown.
  bool freeze(bool during_stimulus);

 private:
  std::optional<protocol::Sensing> sensing_;
  std::optional<Guidance> bars_;
};

}  // namespace turnpoint::session
