// station_lines amplifier URI   uses the station's amplifier on real lines: arms, enables and keeps it alive.
//                               Prints a fault as "fault STATE REACTION_NS REASON"; once its cause is gone,
//                               clears it, arms and enables again
//               buttons URI     uses the station's buttons: prints "press NAME NS" for each press
// Both run until killed, and print "ready" once the lines are open.
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <string>

#include "station/io/amplifier.hpp"
#include "station/io/buttons.hpp"

namespace {

using turnpoint::audio::AmplifierState;

void say(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

bool begin(turnpoint::audio::Amplifier& amplifier) {
  amplifier.audio_alive();
  amplifier.session_alive();
  auto refusal = amplifier.clear();
  if (!refusal) refusal = amplifier.arm();
  if (!refusal) refusal = amplifier.enable();
  if (refusal) say("refused " + turnpoint::core::describe(*refusal));
  return !refusal;
}

void run_amplifier(const std::string& uri) {
  const auto amplifier = turnpoint::io::open_amplifier(uri);
  bool running = begin(*amplifier);
  for (say("ready");; ::usleep(10'000)) {
    amplifier->audio_alive();
    amplifier->session_alive();
    if (running && amplifier->state() == AmplifierState::faulted) {
      say(std::string("fault ") + name(amplifier->state()) + " " + std::to_string(amplifier->reaction_ns()) +
          " " + turnpoint::core::describe(amplifier->fault()));
      running = false;
    } else if (!running) {
      ::usleep(200'000);
      running = begin(*amplifier);
      if (running) say("enabled again");
    }
  }
}

void run_buttons(const std::string& uri) {
  std::vector<std::string> names;
  turnpoint::io::ButtonsHandlers handlers;
  handlers.press = [&names](const auto& press) {
    say("press " + names.at(static_cast<std::size_t>(press.button)) + " " + std::to_string(press.time_ns));
  };
  handlers.fault = [](const auto& fault) { say("fault " + fault.what); };
  const auto buttons =
      turnpoint::io::open_buttons(turnpoint::io::ButtonsConfig{uri}, std::nullopt, std::move(handlers));
  names = buttons->names();
  say("ready");
  ::pause();
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string what = argc == 3 ? argv[1] : "";
  if (what == "amplifier") run_amplifier(argv[2]);
  if (what == "buttons") run_buttons(argv[2]);
  return std::fprintf(stderr, "station_lines amplifier|buttons URI\n"), 2;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "station_lines: %s\n", error.what()), 1;
}
