#include "station/ui/operator/check_protocol.hpp"

#include <sstream>

#include "station/session/prepare.hpp"
#include "station/session/programs.hpp"
#include "station/system/fonts.hpp"

namespace turnpoint::ui {

namespace {

/// The number of trials and the duration that the start page shows come from this number of simulated
/// sessions. Five take little time and give the duration to within some minutes.
constexpr int kSessions = 5;

rehearsal::CheckOptions options() {
  rehearsal::CheckOptions options{kSessions};
  options.load_rig = [](const std::string& path) {
    std::ostringstream messages;  // not shown, because the page says elsewhere which calibration is used
    return session::calibrated_rig(path, "", messages);
  };
  options.drawable = system::drawable;
  options.try_programs = session::problems_of;
  return options;
}

}  // namespace

rehearsal::Check check_protocol(const std::string& protocol, const std::string& rig,
                                const std::stop_token& stop) {
  return rehearsal::check(protocol, rig, options(), stop);
}

rehearsal::Check check_source(const std::string& source, const std::string& path, const std::string& rig,
                              const std::stop_token& stop) {
  auto with_source = options();
  with_source.load_protocol = [&source](const std::string& file) { return protocol::parse(source, file); };
  return rehearsal::check(path, rig, with_source, stop);
}

}  // namespace turnpoint::ui
