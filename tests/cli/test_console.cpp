// What the operator without a screen reads: each page says what can be typed to go on.
#include <sstream>

#include "station/cli/operator_console.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using Catch::Matchers::EndsWith;

namespace {

/// Returns the last line that the console prints for a page.
std::string printed(const session::Page& page) {
  std::ostringstream messages;
  session::Inputs inputs;
  const rig::Rig rig;
  cli::OperatorConsole console(rig, inputs, messages);
  console.show(page);
  auto text = messages.str();
  text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

TEST_CASE("the console names the command that goes on after a fault", "[cli][console]") {
  session::Page page;
  page.kind = session::PageKind::fault;
  page.text = "The self-test found a fault";
  page.fault = {session::FaultKind::self_test, "gate: it stays open"};
  // only a note goes on, because the reason is stored with the session
  CHECK(printed(page) ==
        "fault: The self-test found a fault (gate: it stays open); note REASON continues, stop ends the "
        "session");
  page.fault.kind = session::FaultKind::limits;
  CHECK_THAT(printed(page), EndsWith("; next ends the session"));
  page.fault.kind = session::FaultKind::capture;
  CHECK_THAT(printed(page), EndsWith("; next continues"));
  page.amplifier = "faulted";
  CHECK_THAT(printed(page), EndsWith("; amplifier faulted: arm or stop"));
}
