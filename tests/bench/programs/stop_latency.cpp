// stop_latency COUNT PULL_FILE VALUE_FILE: measures how fast the amplifier reacts to the emergency stop. The
// amplifier is enabled on simulated GPIO lines (AMP_EN, AMP_FAULT, STOP, AMP_HB), and the stop is pressed
// COUNT times at random moments. Meanwhile the processor is fully loaded, and a session that gets hardly any
// processor time keeps calling the amplifier. PULL_FILE is the gpio-sim file that presses the stop;
// VALUE_FILE shows the level of the enable line. Prints a histogram of the times from the stop until the
// enable line is low, and the longest time in ns.
#include <fcntl.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "station/io/amplifier.hpp"
#include "station/system/clocks.hpp"

namespace {

using turnpoint::system::monotonic_ns;

constexpr int edges_us[] = {50, 100, 150, 200, 300, 500, 1000, 10'000, 1'000'000'000};

void check(const turnpoint::audio::Amplifier::Refusal& refusal) {
  if (refusal) throw std::runtime_error("refused: " + turnpoint::core::describe(*refusal));
}

/// Starts four threads that use all the processor time they can get, and a fifth that simulates the session
/// with a lower priority.
std::vector<std::jthread> crowd(turnpoint::audio::Amplifier& amplifier) {
  std::vector<std::jthread> threads;
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([](const std::stop_token& stop) {
      for (volatile unsigned n = 0; !stop.stop_requested();) n = n + 1;
    });
  threads.emplace_back([&amplifier](const std::stop_token& stop) {
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), 19);
    while (!stop.stop_requested()) {
      amplifier.session_alive();
      static_cast<void>(amplifier.state());
      static_cast<void>(amplifier.fault());
    }
  });
  return threads;
}

/// Gives the measuring thread this real-time priority. It must be above the load's, so that the measuring
/// thread need not wait, and below the guard's. A kernel thread of priority 50 delivers edges. With a
/// priority below 50, the measuring thread does not disturb this delivery. Above 50 it delays the delivery,
/// as a busy audio thread would, and the guard has to read the level of the line instead.
void stand_at(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters) != 0)
    throw std::runtime_error("no permission to use SCHED_FIFO");
}
constexpr int priorities[] = {40, 60};

/// Reaction times, one list for stops that the guard noticed by an edge and one for those it noticed by
/// reading the level.
struct Times {
  std::array<std::array<int, std::size(edges_us)>, 2> histogram{};
  std::int64_t longest_ns = 0;

  void add(std::size_t way, std::int64_t took_ns) {
    longest_ns = std::max(longest_ns, took_ns);
    std::size_t bin = 0;
    while (took_ns >= 1000LL * edges_us[bin]) ++bin;
    ++histogram[way][bin];
  }
  void print() const {
    std::printf("%14s %8s %8s\n", "us", "edge", "level");
    for (std::size_t k = 0; k < std::size(edges_us); ++k)
      if (histogram[0][k] + histogram[1][k] > 0)
        std::printf("below %8d %8d %8d\n", edges_us[k], histogram[0][k], histogram[1][k]);
    std::printf("longest_ns %lld\n", static_cast<long long>(longest_ns));
  }
};

class Stop {
 public:
  Stop(const char* pull_file, const char* value_file)
      : pull_(::open(pull_file, O_WRONLY | O_CLOEXEC)), value_(::open(value_file, O_RDONLY | O_CLOEXEC)) {
    if (pull_ < 0 || value_ < 0) throw std::runtime_error("cannot open the files of the lines");
  }

  void pull(const std::string& where) const {
    if (::write(pull_, where.data(), where.size()) < 0) throw std::runtime_error("cannot move the stop");
  }
  bool high() const {
    char level = '?';
    if (::pread(value_, &level, 1, 0) != 1) throw std::runtime_error("cannot see the line");
    return level == '1';
  }
  /// Presses the stop. Returns the time (ns) until the enable line is low.
  std::int64_t press() const {
    const auto start_ns = monotonic_ns();
    pull("pull-up");
    while (high())
      if (monotonic_ns() - start_ns > 1'000'000'000) throw std::runtime_error("the line stays high");
    return monotonic_ns() - start_ns;
  }

 private:
  int pull_, value_;
};

int run(int count, const Stop& stop) {
  const auto amplifier =
      turnpoint::io::open_amplifier("gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB");
  const auto threads = crowd(*amplifier);
  std::mt19937 random(17);
  Times times;
  for (int k = 0; k < count; ++k) {
    const auto way = static_cast<std::size_t>(k % 2);
    // set the priority only now, so that the threads that load the processor do not inherit it
    stand_at(priorities[way]);
    amplifier->audio_alive();
    amplifier->session_alive();
    check(amplifier->clear());
    check(amplifier->arm());
    check(amplifier->enable());
    ::usleep(300 + static_cast<useconds_t>(random() % 1000));  // press the stop at a random moment
    if (!stop.high()) throw std::runtime_error("the line was not high before the stop");
    times.add(way, stop.press());
    stop.pull("pull-down");
  }
  times.print();
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) return std::fprintf(stderr, "stop_latency COUNT PULL_FILE VALUE_FILE\n"), 2;
  return run(std::atoi(argv[1]), Stop(argv[2], argv[3]));
} catch (const std::exception& error) {
  return std::fprintf(stderr, "stop_latency: %s\n", error.what()), 1;
}
