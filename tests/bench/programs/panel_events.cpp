// panel_events BUTTONS CONTACT SECONDS: prints presses, contacts, glitches (line, time, edges, length),
// faults and recoveries with the kernel's time stamps. Pass "" to leave out a device.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "station/io/buttons.hpp"
#include "station/system/clocks.hpp"

using namespace turnpoint;

namespace {

void run(const std::string& buttons, const std::string& contact, double seconds) {
  io::ButtonsHandlers handlers;
  handlers.press = [](const io::Press& press) {
    std::printf("press %d %lld\n", press.button, static_cast<long long>(press.time_ns));
    std::fflush(stdout);
  };
  handlers.contact = [](const io::Contact& touch) {
    std::printf("contact %d %lld %.3f\n", touch.on ? 1 : 0, static_cast<long long>(touch.time_ns),
                touch.position.value_or(-1));
    std::fflush(stdout);
  };
  handlers.glitch = [](const io::Glitch& glitch) {
    std::printf("glitch %s %lld %d %lld\n", glitch.line.c_str(), static_cast<long long>(glitch.time_ns),
                glitch.edges, static_cast<long long>(glitch.length_ns));
    std::fflush(stdout);
  };
  handlers.fault = [](const io::ButtonsFault& fault) {
    std::printf("fault %s\n", fault.what.c_str());
    std::fflush(stdout);
  };
  handlers.back = [](std::int64_t time_ns) {
    std::printf("back %lld\n", static_cast<long long>(time_ns));
    std::fflush(stdout);
  };
  using Buttons = std::optional<io::ButtonsConfig>;
  using Contact = std::optional<io::ContactConfig>;
  const auto opened = io::open_buttons(buttons.empty() ? Buttons{} : io::ButtonsConfig{buttons},
                                       contact.empty() ? Contact{} : io::ContactConfig{contact}, handlers);
  std::printf("ready\n");
  std::fflush(stdout);
  system::sleep_until_ns(system::monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "panel_events BUTTONS CONTACT SECONDS\n"), 2;
  try {
    run(argv[1], argv[2], std::atof(argv[3]));
    return 0;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
