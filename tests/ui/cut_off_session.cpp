// cut_off_session PROTOCOL RIG DATABASE MODE: runs a session of participant T1, who always gives the second
// answer. In the middle of the stimulus of the third trial, the process kills itself (SIGKILL), to simulate a
// power cut.
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <exception>

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
    if (page.kind == PageKind::fault) push(session::InputKind::arm);
    if (page.kind == PageKind::instructions) push(session::InputKind::next);
    if (page.kind == PageKind::rest && page.remaining_s == 0) push(session::InputKind::next);
    if (page.kind != PageKind::stimulus || !page.answers_open) return;
    if (page.trials_done == 2) ::raise(SIGKILL);
    push(session::InputKind::answer, 1);
  }

 private:
  void push(session::InputKind kind, int value = 0) {
    session::Input input;
    input.time_ns = std::chrono::steady_clock::now().time_since_epoch().count();
    // answers count only after a page has been shown for a while
    if (kind == session::InputKind::answer) input.time_ns += 300'000'000;
    input.kind = kind;
    input.value = value;
    inputs.push(input);
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
