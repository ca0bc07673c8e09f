// cut_off_session PROTOCOL RIG DATABASE MODE: runs a session of participant T1, who always gives the second
// answer. In the middle of the stimulus of the third trial, the process kills itself (SIGKILL), to simulate a
// power cut.
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <utility>

#include "station/session/prepare.hpp"
#include "station/session/session.hpp"

using namespace turnpoint;

namespace {

class Room : public session::Display {
 public:
  session::Inputs inputs;

  void show(const session::Page& page) override {
    using session::PageKind;
    // a live session begins disarmed, so arm the amplifier first
    if (page.kind == PageKind::fault) push(session::input::Arm{});
    if (page.kind == PageKind::instructions) push(session::input::Next{});
    if (page.kind == PageKind::rest && page.remaining_s == 0) push(session::input::Next{});
    if (page.kind != PageKind::stimulus || !page.answers_open) return;
    if (page.trials_done == 2) ::raise(SIGKILL);
    // answers count only after a page has been shown for a while
    push(session::input::Answer{1}, 300'000'000);
  }

 private:
  void push(session::input::Any content, std::int64_t after_ns = 0) {
    inputs.push({std::chrono::steady_clock::now().time_since_epoch().count() + after_ns, std::move(content)});
  }
};

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 5) return 2;
  session::RunRequest request;
  request.protocol = argv[1];
  request.rig = argv[2];
  request.participant = "T1";
  request.database = argv[3];
  request.mode = argv[4];
  Room room;
  session::run(session::prepare(request), &room, room.inputs);
  std::fprintf(stderr, "cut_off_session: nobody cut it off\n");
  return 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "cut_off_session: %s\n", error.what());
  return 1;
}
