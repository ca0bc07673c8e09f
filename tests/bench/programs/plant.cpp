// plant KEY=VALUE...: the simulated laboratory between two sides of a loopback card. It captures what the
// station plays on hw:Loopback,0,0 and plays what the station captures on hw:Loopback,1,1. Once a second it
// prints the true state at a captured frame: "FRAME NORMAL_N LATERAL_N CONTACT_M AMPLITUDE_UM TEMPERATURE_C".
// Exits with status 1 if it was ever too slow for the card, because frames are then missing.
//   rig=FILE           a rig file with [capture]: surface, friction, transducers, pick-ups and force cells
//   seconds=S          how long to run
//   tones=HZ,HZ...     the tones that the finger can feel
//   delay_ms=MS        length of the silence that is played first (default 250)
//   touch=S            when a finger begins to stroke; without this key there is no finger
//   fault=NAME@S       a fault and its beginning (s), e.g. "fault=transducer dead@5"; may be repeated
//   noise=off          a finger whose force and friction do not vary
//   commands=FIFO      obeys the lines that are written there: "fault NAME [AMOUNT]", "repair",
//                      "touch SECONDS", "lift", "steady" (as noise=off), "load NORMAL_N LATERAL_N MM" (a
//                      weight on the surface, and a lateral force, at this place; put down within 0.1 s);
//                      each takes effect with the next captured period, and is then printed as "done: LINE"
//   truth=FILE         writes the true state there at each millisecond: "FRAME NORMAL_N LATERAL_N CONTACT_MM"
//   crosstalk_mV=MV    what a tone at full scale adds to each bridge (default 4)
//   from=PCM, to=PCM   the card's sides (default hw:Loopback,1,0 and hw:Loopback,0,1)
#include <alsa/asoundlib.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "station/rig/rig.hpp"
#include "station/session/simulated_room.hpp"
#include "station/simulation/plant.hpp"

using namespace turnpoint;

namespace {

constexpr snd_pcm_uframes_t kPeriod = 1920;  // 10 or 20 ms

struct Arguments {
  std::map<std::string, std::string> values{{"rig", ""},
                                            {"seconds", "10"},
                                            {"tones", ""},
                                            {"delay_ms", "250"},
                                            {"touch", ""},
                                            {"noise", "on"},
                                            {"commands", ""},
                                            {"truth", ""},
                                            {"crosstalk_mV", "4"},
                                            {"from", "hw:Loopback,1,0"},
                                            {"to", "hw:Loopback,0,1"}};
  std::vector<std::string> faults;

  const std::string& text(const std::string& key) const { return values.at(key); }
  double number(const std::string& key) const { return std::stod(values.at(key)); }
};

Arguments read(int argc, char** argv) {
  Arguments arguments;
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k];
    const auto equals = argument.find('=');
    const auto key = argument.substr(0, equals);
    const auto value = equals == std::string::npos ? "" : argument.substr(equals + 1);
    if (key == "fault")
      arguments.faults.push_back(value);
    else if (arguments.values.count(key) > 0)
      arguments.values[key] = value;
    else
      throw std::invalid_argument("unknown argument: " + argument);
  }
  return arguments;
}

std::int64_t frame_at(const simulation::Setup& setup, const std::string& seconds) {
  return std::llround(std::stod(seconds) * setup.rate_Hz);
}

simulation::Setup setup_from(const Arguments& arguments) {
  const auto rig = rig::load(arguments.text("rig"));
  auto setup = session::laboratory_of(rig);
  setup.playback_channels = std::max(setup.playback_channels, rig.output.device_channels);
  setup.loop_delay_frames = 0;
  setup.wires.crosstalk_V_per_full_scale = 1e-3 * arguments.number("crosstalk_mV");
  if (arguments.text("noise") == "off") setup.finger.normal_noise = setup.finger.friction_noise = 0;
  if (!arguments.text("touch").empty())
    setup.finger.touches = {{frame_at(setup, arguments.text("touch")), simulation::kNever}};
  return setup;
}

simulation::FaultKind fault_named(const std::string& name) {
  if (const auto kind = simulation::find_fault(name)) return *kind;
  throw std::invalid_argument("not a fault: " + name);
}

void add_faults(simulation::Plant& plant, const Arguments& arguments) {
  for (const auto& text : arguments.faults) {
    const auto at = text.find('@');
    if (at == std::string::npos) throw std::invalid_argument("not a fault: " + text);
    plant.add({fault_named(text.substr(0, at)), frame_at(plant.setup(), text.substr(at + 1))});
  }
}

std::vector<double> tones_from(const Arguments& arguments) {
  std::vector<double> tones;
  std::istringstream list(arguments.text("tones"));
  for (std::string tone; std::getline(list, tone, ',');) tones.push_back(std::stod(tone));
  return tones;
}

/// A weight that is put down or taken away within 0.1 s, without a jerk that would make the cells ring.
class Weight {
 public:
  void put(const simulation::Load& load) {
    before_ = now();
    after_ = load;
    step_ = 0;
  }
  bool moves() const { return step_ < kSteps; }
  /// Moves the weight on by a millisecond.
  simulation::Load next() {
    ++step_;
    return now();
  }

 private:
  static constexpr int kSteps = 100;

  simulation::Load now() const {
    const double share = simulation::minimum_jerk(static_cast<double>(step_) / kSteps);
    const auto between = [&](double from, double to) { return from + share * (to - from); };
    // What is not there has no place: a weight that comes or goes stays where it is.
    const double from_m = before_.normal_N > 0 ? before_.x_m : after_.x_m;
    const double to_m = after_.normal_N > 0 ? after_.x_m : before_.x_m;
    return {between(before_.normal_N, after_.normal_N), between(before_.lateral_N, after_.lateral_N),
            between(from_m, to_m)};
  }

  simulation::Load before_, after_;
  int step_ = kSteps;
};

void obey(simulation::Plant& plant, Weight& weight, const std::string& line) {
  const auto space = line.find(' ');
  const std::string word = line.substr(0, space),
                    rest = space == std::string::npos ? "" : line.substr(space + 1);
  if (word == "fault") {
    const auto amount = rest.find_first_of("0123456789");
    simulation::Fault fault{fault_named(amount == std::string::npos ? rest : rest.substr(0, amount - 1)),
                            plant.frames() + 1};
    if (amount != std::string::npos) fault.amount = std::stod(rest.substr(amount));
    plant.add(fault);
  } else if (word == "repair")
    plant.repair();
  else if (word == "touch")
    plant.touch(frame_at(plant.setup(), rest));
  else if (word == "lift")
    plant.lift(0);
  else if (word == "steady")
    plant.steady_finger();
  else if (word == "load") {
    simulation::Load load;
    std::istringstream(rest) >> load.normal_N >> load.lateral_N >> load.x_m;
    load.x_m *= 1e-3;
    weight.put(load);
  } else
    throw std::invalid_argument("not a command: " + line);
  std::printf("done: %s\n", line.c_str());
  std::fflush(stdout);
}

/// Lines that other programs write to a FIFO. Without a FIFO there are none.
class Commands {
 public:
  explicit Commands(const std::string& path) {
    if (path.empty()) return;
    // Opened for writing too, so that the FIFO does not end when a writer closes it.
    fifo_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK);
    if (fifo_ < 0) throw std::runtime_error(path + ": " + std::strerror(errno));
  }
  ~Commands() {
    if (fifo_ >= 0) ::close(fifo_);
  }
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  std::optional<std::string> next() {
    char letter = 0;
    while (fifo_ >= 0 && ::read(fifo_, &letter, 1) == 1)
      if (letter == '\n')
        return std::exchange(line_, "");
      else
        line_ += letter;
    return std::nullopt;
  }

 private:
  int fifo_ = -1;
  std::string line_;
};

void check(long result, const std::string& what) {
  if (result < 0) throw std::runtime_error(what + ": " + snd_strerror(static_cast<int>(result)));
}

/// An open side of the loopback card, with S32_LE samples and a buffer of half a second.
struct Side {
  Side(const std::string& name, snd_pcm_stream_t stream, unsigned channels, unsigned rate_Hz) : what(name) {
    check(snd_pcm_open(&pcm, name.c_str(), stream, 0), name);
    check(snd_pcm_set_params(pcm, SND_PCM_FORMAT_S32_LE, SND_PCM_ACCESS_RW_INTERLEAVED, channels, rate_Hz, 0,
                             500000),
          name);
  }
  ~Side() { snd_pcm_close(pcm); }
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;

  std::string what;
  snd_pcm_t* pcm = nullptr;
};

std::int32_t sample_of(double full_scale) {
  return static_cast<std::int32_t>(std::clamp(full_scale * 0x1p31, -0x1p31, 0x1p31 - 1));
}

void print(const simulation::Truth& truth) {
  std::printf("%lld %.4f %.4f %.5f %.4f %.2f\n", static_cast<long long>(truth.frame), truth.normal_N,
              truth.lateral_N, truth.finger.contact_m, truth.amplitude_um, truth.temperature_C);
  std::fflush(stdout);
}

/// Writes the true state to a file, if there is a path.
class TruthFile {
 public:
  explicit TruthFile(const std::string& path) {
    if (!path.empty()) file_.open(path);
    if (!path.empty() && !file_) throw std::runtime_error(path + ": " + std::strerror(errno));
  }
  void write(const simulation::Truth& truth) {
    if (file_.is_open())
      file_ << truth.frame << ' ' << truth.normal_N << ' ' << truth.lateral_N << ' '
            << 1e3 * truth.finger.contact_m << '\n';
  }

 private:
  std::ofstream file_;
};

/// Advances the plant, a millisecond at a time.
void advance(simulation::Plant& plant, Weight& weight, TruthFile& truth, std::span<const double> played,
             std::span<double> captured) {
  const auto inputs = static_cast<std::size_t>(plant.setup().playback_channels);
  const auto outputs = static_cast<std::size_t>(plant.setup().capture.count);
  const auto piece = static_cast<std::size_t>(plant.setup().rate_Hz / 1000);
  for (std::size_t at = 0; at < kPeriod; at += piece) {
    if (weight.moves()) plant.set_load(weight.next());
    plant.advance(played.subspan(at * inputs, piece * inputs),
                  captured.subspan(at * outputs, piece * outputs));
    truth.write(plant.truth());
  }
}

void run(const Arguments& arguments) {
  simulation::Plant plant(setup_from(arguments));
  plant.set_tones(tones_from(arguments));
  add_faults(plant, arguments);
  Commands commands(arguments.text("commands"));
  TruthFile truth(arguments.text("truth"));
  Weight weight;
  const auto inputs = static_cast<std::size_t>(plant.setup().playback_channels);
  const auto outputs = static_cast<std::size_t>(plant.setup().capture.count);
  const auto rate_Hz = static_cast<unsigned>(plant.setup().rate_Hz);
  Side from(arguments.text("from"), SND_PCM_STREAM_CAPTURE, static_cast<unsigned>(inputs), rate_Hz);
  Side to(arguments.text("to"), SND_PCM_STREAM_PLAYBACK, static_cast<unsigned>(outputs), rate_Hz);

  std::vector<std::int32_t> in(kPeriod * inputs), out(kPeriod * outputs);
  std::vector<double> played(in.size()), captured(out.size());
  const std::vector<std::int32_t> silence(
      outputs * static_cast<std::size_t>(arguments.number("delay_ms") * rate_Hz / 1000));
  check(snd_pcm_writei(to.pcm, silence.data(), silence.size() / outputs), to.what);
  check(snd_pcm_start(from.pcm), from.what);
  if (snd_pcm_state(to.pcm) != SND_PCM_STATE_RUNNING) check(snd_pcm_start(to.pcm), to.what);
  std::int64_t next = 0;
  while (plant.frames() < frame_at(plant.setup(), arguments.text("seconds"))) {
    while (const auto line = commands.next()) obey(plant, weight, *line);
    check(snd_pcm_readi(from.pcm, in.data(), kPeriod), from.what);
    for (std::size_t k = 0; k < in.size(); ++k) played[k] = in[k] * 0x1p-31;
    advance(plant, weight, truth, played, captured);
    std::transform(captured.begin(), captured.end(), out.begin(), sample_of);
    check(snd_pcm_writei(to.pcm, out.data(), kPeriod), to.what);
    if (plant.frames() < next) continue;
    print(plant.truth());
    next += rate_Hz;
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(read(argc, argv));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "plant: %s\n", error.what());
    return 1;
  }
}
