#include <alsa/asoundlib.h>

#include <cstdlib>

#include "station/audio/alsa_capture.hpp"
#include "station/audio/engine.hpp"
#include "station/audio/output.hpp"
#include "tests/audio/bursts.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::audio;

namespace {

void quiet(const char*, int, const char*, int, const char*, ...) {}

// Makes alsa-lib read the device definitions of these tests.
const bool configured = [] {
  ::setenv("ALSA_CONFIG_PATH", TURNPOINT_SOURCE_DIR "/tests/audio/asound.conf", 1);
  snd_lib_error_set_handler(quiet);
  return true;
}();

OutputConfig config_for(const std::string& name) {
  OutputConfig config;
  config.uri = "alsa:" + name;
  return config;
}

bool opens(const OutputConfig& config) {
  try {
    open_output(config);
    return true;
  } catch (const OutputRefused&) {
    return false;
  } catch (const std::system_error&) {
    return false;
  }
}

/// Returns the reason why this capture is refused; "" if it opens.
std::string capture_refused(const OutputConfig& config) {
  try {
    DeviceCapture capture(config);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

// Opens the device like a program that checks only the rate. Returns true if alsa-lib accepts the exact rate.
bool accepts_exact_rate(const char* name, unsigned rate) {
  snd_pcm_t* pcm = nullptr;
  if (snd_pcm_open(&pcm, name, SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK) < 0) return false;
  snd_pcm_hw_params_t* params = nullptr;
  snd_pcm_hw_params_alloca(&params);
  snd_pcm_hw_params_any(pcm, params);
  const bool accepted = snd_pcm_hw_params_set_rate(pcm, params, rate, 0) == 0;
  snd_pcm_close(pcm);
  return accepted;
}

const char* const resampling[] = {"rated",
                                  "rated_linear",
                                  "rated_speex",
                                  "rated_samplerate",
                                  "rated_lav",
                                  "plugged",
                                  "file_over_rate",
                                  "hooks_over_rate",
                                  "copy_over_rate",
                                  "linear_over_rate",
                                  "route_over_rate",
                                  "multi_over_rate",
                                  "softvol_over_rate",
                                  "mmap_over_rate",
                                  "asym_over_rate",
                                  "empty_over_rate",
                                  "lfloat_over_rate",
                                  "plug_over_file_over_rate"};

}  // namespace

TEST_CASE("every plug-in of alsa-lib that resamples or mixes is refused by default", "[drive][alsa]") {
  REQUIRE(configured);
  for (const char* name : resampling) {
    INFO(name);
    CHECK_FALSE(opens(config_for(name)));
  }
  CHECK_FALSE(opens(config_for("straight")));  // "straight" does not resample, but is not hardware either
}

TEST_CASE("a resampler behind an allowed plug-in is refused as well", "[drive][alsa]") {
  for (const char* name : resampling) {
    OutputConfig config = config_for(name);
    config.allow_plugin = {"rate",  "plug",    "file",  "hooks",     "copy",         "linear", "route",
                           "multi", "softvol", "meter", "mmap_emul", "linear_float", "null"};
    INFO(name);
    CHECK_FALSE(opens(config));
  }
}

TEST_CASE("requesting an exact rate is not enough: alsa-lib's plug-ins accept it and resample",
          "[drive][alsa]") {
  // Negative control for the two tests above: these devices can be opened, and claim to run at 192 kHz.
  for (const char* name :
       {"rated", "rated_linear", "plugged", "file_over_rate", "copy_over_rate", "asym_over_rate",
        "empty_over_rate", "hooks_over_rate", "route_over_rate", "multi_over_rate"}) {
    INFO(name);
    CHECK(accepts_exact_rate(name, 192000));
  }
}

TEST_CASE("plug-ins that pass samples on unchanged are accepted if the rig allows them", "[drive][alsa]") {
  OutputConfig config = config_for("straight");
  config.allow_plugin = {"null"};
  CHECK(opens(config));
  config = config_for("to_file");
  config.allow_plugin = {"file"};
  CHECK(opens(config));
  config = config_for("plugged_any");
  config.allow_plugin = {"plug"};
  CHECK(opens(config));
}

TEST_CASE("a refusal names the device and its kind; a missing device is reported as ENODEV or ENOENT",
          "[drive][alsa]") {
  CHECK_THROWS_WITH(
      open_output(config_for("plugged")),
      "alsa:plugged: is an alsa-lib plug-in of type 'plug', not a hardware device; use a name that begins "
      "with hw: (see 'aplay -l')");
  OutputConfig config = config_for("rated");
  config.allow_plugin = {"rate",  "plug",    "file",  "hooks",     "copy",         "linear", "route",
                         "multi", "softvol", "meter", "mmap_emul", "linear_float", "null"};
  CHECK_THROWS_WITH(open_output(config),
                    "alsa:rated: resamples: the plug-in chain contains a rate converter");
  config = config_for("plugged");
  config.allow_plugin = {"plug"};
  CHECK_THROWS_WITH(open_output(config), "alsa:plugged: rate 192000 Hz not supported; it offers 48000 Hz");
  try {
    open_output(config_for("hw:7,3"));
    FAIL("opened");
  } catch (const std::system_error& error) {
    CHECK(error.code().value() == ENOENT);
  }
}

TEST_CASE("a device that takes neither 32 nor 24 bits is refused", "[drive][alsa]") {
  auto config = config_for("compressed");
  config.allow_plugin = {"adpcm"};
  CHECK_THROWS_WITH(open_output(config),
                    "alsa:compressed: accepts neither 32-bit samples (S32_LE) nor 24-bit samples (S24_3LE)");
}

TEST_CASE("a device with more channels than the stream is opened with all its channels", "[drive][alsa]") {
  auto config = config_for("straight");
  config.allow_plugin = {"null"};
  config.device_channels = 10;
  const auto output = open_output(config);
  CHECK(output->config().channels == 2);
  const std::vector<std::int32_t> block(2 * 384);
  CHECK(output->write(block).taken == 384);
}

TEST_CASE("a capture is refused like a playback if alsa-lib would resample or convert",
          "[drive][alsa][capture]") {
  for (const char* name : resampling) {
    INFO(name);
    CHECK(capture_refused(config_for(name)) != "");
    OutputConfig config = config_for(name);
    config.allow_plugin = {"rate",  "plug",    "file",  "hooks",     "copy",         "linear", "route",
                           "multi", "softvol", "meter", "mmap_emul", "linear_float", "null",   "asym"};
    const bool straight = std::string(name) == "asym_over_rate";  // resamples the playback only
    CHECK(capture_refused(config).empty() == straight);
  }
  CHECK(capture_refused(config_for("straight")).find("plug-in of type 'null'") != std::string::npos);
  auto config = config_for("straight");
  config.allow_plugin = {"null"};
  CHECK(capture_refused(config) == "");
  config = config_for("rated");
  config.allow_plugin = {"rate", "null"};
  CHECK(capture_refused(config) == "alsa:rated: resamples: the plug-in chain contains a rate converter");
  config = config_for("compressed");
  config.allow_plugin = {"adpcm"};
  CHECK(capture_refused(config) == "alsa:compressed: does not capture 32-bit samples (S32_LE)");
  config = config_for("straight");
  config.uri = "wav:a.wav";
  CHECK(capture_refused(config) == "capture 'wav:a.wav' is not supported; allowed: alsa:NAME");
}
