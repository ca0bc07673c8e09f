#include "station/ui/operator/check_protocol.hpp"

#include <sstream>

#include "station/setup/prepare.hpp"
#include "station/system/fonts.hpp"

namespace turnpoint::ui {

namespace {

/// Number of sessions to simulate for the number of trials and the duration on the start page. Five are
/// simulated quickly, and give the duration to within some minutes.
constexpr int kSessions = 5;

}  // namespace

simulation::Check check_protocol(const std::string& protocol, const std::string& rig,
                                 const std::stop_token& stop) {
  simulation::CheckOptions options{kSessions};
  options.load_rig = [](const std::string& path) {
    std::ostringstream messages;  // the page says elsewhere which calibration is used
    return setup::calibrated_rig(path, "", messages);
  };
  options.drawable = system::drawable;
  return simulation::check(protocol, rig, options, stop);
}

}  // namespace turnpoint::ui
