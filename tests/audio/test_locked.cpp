// The station may record "memory locked" only if that is true. These tests look up in /proc/self/smaps
// whether the audio thread's stack, and all memory that the stream and its output allocate, are locked. The
// stream is opened on a thread of its own, so that its memory is separate from the program's heap.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <thread>
#include <vector>

#include "station/audio/device_stream.hpp"
#include "station/audio/engine.hpp"
#include "tests/audio/watch.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::audio;
using namespace turnpoint::system;

namespace {

/// Finds the address of the audio thread's stack, from inside that thread.
struct StackProbe : Amplifier {
  std::atomic<std::uintptr_t> address{0};

  void audio_alive() noexcept override {
    address = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
  }
  Refusal arm() override { return std::nullopt; }
  void disarm() noexcept override {}
  Refusal enable() override { return std::nullopt; }
  void disable() noexcept override {}
  void trip(core::FaultKind, std::string_view) noexcept override {}
  Refusal clear() override { return std::nullopt; }
  void session_alive() noexcept override {}
  void page_alive(std::int64_t) noexcept override {}
  AmplifierState state() const noexcept override { return AmplifierState::disarmed; }
  AmplifierFault fault() const override { return {}; }
  std::int64_t reaction_ns() const noexcept override { return -1; }
};

struct Mapping {
  std::uintptr_t start = 0, end = 0;
  bool locked = false;
};

std::vector<Mapping> mappings() {
  std::vector<Mapping> all;
  std::ifstream smaps("/proc/self/smaps");
  for (std::string line; std::getline(smaps, line);) {
    Mapping mapping;
    char dash = 0;
    std::istringstream words(line);
    if (line.starts_with("VmFlags:"))
      all.back().locked = line.find(" lo") != std::string::npos;
    else if (words >> std::hex >> mapping.start >> dash >> mapping.end && dash == '-')
      all.push_back(mapping);
  }
  return all;
}

/// Returns how many of the `length` bytes from `start` are not in a locked mapping.
std::size_t unlocked(const std::vector<Mapping>& all, std::uintptr_t start, std::size_t length) {
  std::size_t locked = 0;
  for (const auto& m : all)
    if (m.locked && m.start < start + length && start < m.end)
      locked += std::min(m.end, start + length) - std::max(m.start, start);
  return length - locked;
}

}  // namespace

TEST_CASE("if memory is recorded as locked, the audio thread's stack, its blocks and its rings really are",
          "[drive][realtime]") {
  StackProbe probe;
  std::thread([&probe] {
    StreamConfig config;
    config.output.period_frames = 4096;
    config.output.periods = 2;
    config.amplifier = &probe;
    begin_record();
    const auto stream = open_realtime(config);
    const auto allocations = end_record();
    if (!stream->rights().memory_locked) {
      CHECK_FALSE(stream->rights().note.empty());
      WARN("skipped: memory cannot be locked here, " << stream->rights().note << "; sudo tests/run");
      return;
    }
    while (probe.address == 0) std::this_thread::yield();
    const auto all = mappings();
    CHECK(unlocked(all, probe.address - 16384, 16384) == 0);
    // Leave out the clock's 16 kB of pairs of frame and time: the audio thread does not use them, so they
    // need no lock.
    std::size_t engine = 0, left_out = 0;
    for (const auto& allocation : allocations) {
      if (allocation.size < 1024) continue;
      const auto missing = unlocked(all, reinterpret_cast<std::uintptr_t>(allocation.start), allocation.size);
      engine += allocation.size, left_out += missing;
      INFO(allocation.size << " bytes");
      CHECK((missing == 0 || allocation.size <= 16384));
    }
    CHECK(engine > 150'000);
    CHECK(left_out <= 32'768);
    std::vector<char> other(1 << 20);  // negative control: this memory is not locked
    CHECK(unlocked(all, reinterpret_cast<std::uintptr_t>(other.data()), other.size()) > 0);
  }).join();
}

TEST_CASE("the buffer from which a device is written is locked, and memory that cannot be locked is named",
          "[drive][realtime][alsa]") {
  ::setenv("ALSA_CONFIG_PATH", TURNPOINT_SOURCE_DIR "/tests/audio/asound.conf", 1);
  std::thread([] {
    StreamConfig config;
    config.output.uri = "alsa:straight";
    config.output.allow_plugin = {"null"};
    config.output.period_frames = 4096;
    config.output.periods = 8;
    begin_record();
    const DeviceStream stream(config);
    const auto allocations = end_record();
    const auto rights = lock_memory(stream.memory(), stream.memory_left_out());
    if (!rights.memory_locked) {
      WARN("skipped: memory cannot be locked here, " << rights.note << "; sudo tests/run");
      return;
    }
    CHECK(rights.note == "not locked: alsa-lib's own objects");
    const std::size_t buffer = 2 * sizeof(std::int32_t) * 4096 * 8;
    const auto all = mappings();
    int buffers = 0;
    for (const auto& allocation : allocations) {
      if (allocation.size != buffer) continue;
      ++buffers;
      CHECK(unlocked(all, reinterpret_cast<std::uintptr_t>(allocation.start), allocation.size) == 0);
    }
    CHECK(buffers == 1);
  }).join();
}
