#pragma once
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/session/page.hpp"

namespace turnpoint::view {

/// A page that participants of a study see, and the key of the text that says what it is ("design.page.cue").
struct SamplePage {
  std::string name;
  session::Page page;
};

/// The pages of a study's first session in one language, in the order in which its first participant sees
/// them. Each kind of block is shown once, with its first trial. Nothing is planned or presented.
std::vector<SamplePage> sample_pages(const protocol::Protocol& protocol, const rig::Rig& rig,
                                     const std::string& language);

}  // namespace turnpoint::view
