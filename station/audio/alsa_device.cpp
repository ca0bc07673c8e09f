#include "station/audio/alsa_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>

#include "station/core/letters.hpp"

namespace turnpoint::audio {

void pack(std::span<const std::int32_t> samples, int channels, const FrameLayout& layout,
          std::span<unsigned char> out) noexcept {
  const auto used = static_cast<std::size_t>(channels);
  const int first_bit = 32 - layout.bits();
  auto* at = out.data();
  for (std::size_t frame = 0; frame < samples.size() / used; ++frame) {
    for (std::size_t channel = 0; channel < used; ++channel) {
      const auto sample = static_cast<std::uint32_t>(samples[frame * used + channel]);
      for (int bit = first_bit; bit < 32; bit += 8) *at++ = static_cast<unsigned char>(sample >> bit);
    }
    at = std::fill_n(at, layout.bytes() - used * static_cast<std::size_t>(layout.bits() / 8), '\0');
  }
}

namespace {

bool captures(snd_pcm_t* pcm) { return snd_pcm_stream(pcm) == SND_PCM_STREAM_CAPTURE; }

constexpr int no_conversion =
    SND_PCM_NO_AUTO_RESAMPLE | SND_PCM_NO_AUTO_FORMAT | SND_PCM_NO_AUTO_CHANNELS | SND_PCM_NO_SOFTVOL;

template <typename... Args>
[[noreturn]] void refuse(const std::string& name, fmt::format_string<Args...> text, Args&&... args) {
  throw OutputRefused("alsa:" + name + ": " + fmt::format(text, std::forward<Args>(args)...));
}

void check(int result, const std::string& name, const char* what) {
  if (result < 0) throw std::system_error(-result, std::generic_category(), "alsa:" + name + ": " + what);
}

using core::lower;

void check_type(snd_pcm_t* pcm, const OutputConfig& config, const std::string& name) {
  const snd_pcm_type_t type = snd_pcm_type(pcm);
  if (type == SND_PCM_TYPE_HW) return;
  const char* known = snd_pcm_type_name(type);  // the name is null for the plug-in dshare in alsa-lib 1.2.8
  const std::string found = known ? lower(known) : fmt::format("type {}", static_cast<int>(type));
  const auto& allowed = config.allow_plugin;
  if (std::find(allowed.begin(), allowed.end(), found) == allowed.end())
    refuse(name,
           "is an alsa-lib plug-in of type '{}', not a hardware device; use a name that begins with hw: (see "
           "'aplay -l')",
           found);
}

// Lists the rates that the device supports without conversion.
std::string offered_rates(snd_pcm_t* pcm, const snd_pcm_hw_params_t* params) {
  std::string text;
  for (const unsigned rate :
       {44100u, 48000u, 88200u, 96000u, 176400u, 192000u, 352800u, 384000u, 705600u, 768000u})
    if (snd_pcm_hw_params_test_rate(pcm, const_cast<snd_pcm_hw_params_t*>(params), rate, 0) == 0)
      text += fmt::format("{}{}", text.empty() ? "" : ", ", rate);
  return text.empty() ? "none of the common rates" : text + " Hz";
}

struct ParamsFree {
  void operator()(snd_pcm_hw_params_t* params) const noexcept { snd_pcm_hw_params_free(params); }
  void operator()(snd_pcm_sw_params_t* params) const noexcept { snd_pcm_sw_params_free(params); }
  void operator()(snd_pcm_info_t* info) const noexcept { snd_pcm_info_free(info); }
};
using HwParams = std::unique_ptr<snd_pcm_hw_params_t, ParamsFree>;

HwParams any_params(snd_pcm_t* pcm, const std::string& name) {
  snd_pcm_hw_params_t* raw = nullptr;
  check(snd_pcm_hw_params_malloc(&raw), name, "hardware parameters");
  HwParams params(raw);
  check(snd_pcm_hw_params_any(pcm, raw), name, "hardware parameters");
  return params;
}

// Lists the channel counts that the device supports.
std::string offered_channels(snd_pcm_t* pcm, snd_pcm_hw_params_t* params) {
  unsigned lowest = 0, highest = 0;
  if (snd_pcm_hw_params_get_channels_min(params, &lowest) < 0 ||
      snd_pcm_hw_params_get_channels_max(params, &highest) < 0)
    return "nothing";
  std::string text;
  for (unsigned count = lowest; count <= std::min(highest, 64u); ++count)
    if (snd_pcm_hw_params_test_channels(pcm, params, count) == 0)
      text += fmt::format("{}{}", text.empty() ? "" : ", ", count);
  return text;
}

// Chooses 32-bit samples, or 24-bit samples if the device has no 32-bit ones. The number of channels is the
// rig's device_channels or, if that is larger, the number of channels in use.
void set_layout(AlsaDevice& device, snd_pcm_hw_params_t* p, const OutputConfig& config,
                const std::string& name) {
  snd_pcm_t* pcm = device.pcm.get();
  device.layout = {SampleFormat::s32_le, std::max(config.channels, config.device_channels)};
  if (snd_pcm_hw_params_set_format(pcm, p, SND_PCM_FORMAT_S32_LE) < 0) {
    if (captures(pcm)) refuse(name, "does not capture 32-bit samples (S32_LE)");
    device.layout.format = SampleFormat::s24_3le;
    if (snd_pcm_hw_params_set_format(pcm, p, SND_PCM_FORMAT_S24_3LE) < 0)
      refuse(name, "accepts neither 32-bit samples (S32_LE) nor 24-bit samples (S24_3LE)");
  }
  if (!captures(pcm) && device.layout.bits() < config.bits)
    refuse(name, "accepts samples of {} bits, but the rig file says {}", device.layout.bits(), config.bits);
  const int channels = device.layout.channels;
  if (snd_pcm_hw_params_set_channels(pcm, p, static_cast<unsigned>(channels)) < 0)
    refuse(name, "does not accept {} channels; it accepts {} (set {} in the rig file)", channels,
           offered_channels(pcm, p), captures(pcm) ? "channels of [capture]" : "device_channels");
}

// Throws for every parameter that the device refuses. Otherwise alsa-lib would silently use another value.
void set_hardware(AlsaDevice& device, const OutputConfig& config, const std::string& name) {
  snd_pcm_t* pcm = device.pcm.get();
  const HwParams params = any_params(pcm, name);
  snd_pcm_hw_params_t* p = params.get();
  check(snd_pcm_hw_params_set_rate_resample(pcm, p, 0), name, "switching resampling off");
  if (snd_pcm_hw_params_set_access(pcm, p, SND_PCM_ACCESS_RW_INTERLEAVED) < 0)
    refuse(name, "does not accept interleaved frames");
  set_layout(device, p, config, name);
  const auto rate = static_cast<unsigned>(config.rate_Hz);
  if (snd_pcm_hw_params_set_rate(pcm, p, rate, 0) < 0)
    refuse(name, "rate {} Hz not supported; it offers {}", rate, offered_rates(pcm, p));
  if (snd_pcm_hw_params_set_period_size(pcm, p, static_cast<snd_pcm_uframes_t>(config.period_frames), 0) < 0)
    refuse(name, "does not accept periods of {} frames", config.period_frames);
  if (snd_pcm_hw_params_set_periods(pcm, p, static_cast<unsigned>(config.periods), 0) < 0)
    refuse(name, "does not accept {} periods of {} frames", config.periods, config.period_frames);
  check(snd_pcm_hw_params(pcm, p), name, "installing hardware parameters");
  unsigned numerator = 0, denominator = 0;
  check(snd_pcm_hw_params_get_rate_numden(p, &numerator, &denominator), name, "reading the rate back");
  if (denominator == 0 || numerator != rate * denominator)
    refuse(name, "runs at {}/{} Hz instead of the requested {} Hz", numerator, denominator, rate);
  const int depth = snd_pcm_hw_params_get_sbits(p);
  if (!captures(pcm) && snd_pcm_type(pcm) == SND_PCM_TYPE_HW && depth > 0 && depth < config.bits)
    refuse(name, "the converter has {} bits, but the rig file says {}", depth, config.bits);
  device.period_frames = static_cast<snd_pcm_uframes_t>(config.period_frames);
  check(snd_pcm_hw_params_get_buffer_size(p, &device.buffer_frames), name, "reading the buffer size");
}

// On underrun the stream keeps running and plays silence; it never stops on its own. A capture keeps running
// too, so that the number of lost frames is known.
void set_software(const AlsaDevice& device, const std::string& name) {
  snd_pcm_t* pcm = device.pcm.get();
  snd_pcm_sw_params_t* p = nullptr;
  check(snd_pcm_sw_params_malloc(&p), name, "software parameters");
  const std::unique_ptr<snd_pcm_sw_params_t, ParamsFree> params(p);
  snd_pcm_uframes_t boundary = 0;
  check(snd_pcm_sw_params_current(pcm, p), name, "software parameters");
  check(snd_pcm_sw_params_get_boundary(p, &boundary), name, "software parameters");
  check(snd_pcm_sw_params_set_start_threshold(pcm, p, boundary), name, "start threshold");
  check(snd_pcm_sw_params_set_stop_threshold(pcm, p, boundary), name, "stop threshold");
  if (!captures(pcm)) {
    check(snd_pcm_sw_params_set_silence_threshold(pcm, p, 0), name, "silence threshold");
    check(snd_pcm_sw_params_set_silence_size(pcm, p, boundary), name, "silence size");
  }
  check(snd_pcm_sw_params_set_avail_min(pcm, p, device.period_frames), name, "wake-up level");
  check(snd_pcm_sw_params_set_tstamp_mode(pcm, p, SND_PCM_TSTAMP_ENABLE), name, "time stamps");
  check(snd_pcm_sw_params_set_tstamp_type(pcm, p, SND_PCM_TSTAMP_TYPE_MONOTONIC), name,
        "monotonic time stamps");
  check(snd_pcm_sw_params(pcm, p), name, "installing software parameters");
}

std::string described(snd_pcm_t* pcm) {
  snd_output_t* buffer = nullptr;
  if (snd_output_buffer_open(&buffer) < 0) return "";
  snd_pcm_dump(pcm, buffer);
  char* text = nullptr;
  const std::size_t size = snd_output_buffer_string(buffer, &text);
  std::string chain(text, size);
  snd_output_close(buffer);
  return chain;
}

// An allowed plug-in may contain a rate converter, so every rate along the plug-in chain must be the
// requested one.
void check_chain(const AlsaDevice& device, const OutputConfig& config, const std::string& name) {
  if (device.chain.empty()) refuse(name, "alsa-lib does not say through which plug-ins the samples pass");
  if (device.chain.find("Rate conversion PCM") != std::string::npos)
    refuse(name, "resamples: the plug-in chain contains a rate converter");
  for (std::size_t at = device.chain.find("  rate "); at != std::string::npos;
       at = device.chain.find("  rate ", at + 1)) {
    const auto colon = device.chain.find(':', at);
    const long rate =
        colon == std::string::npos ? 0 : std::strtol(device.chain.c_str() + colon + 1, nullptr, 10);
    if (rate != config.rate_Hz)
      refuse(name, "resamples: a plug-in runs at {} Hz instead of {} Hz", rate, config.rate_Hz);
  }
}

// Checks the settings that the kernel itself reports for the hardware.
void check_kernel(snd_pcm_t* pcm, const OutputConfig& config, const std::string& name) {
  if (snd_pcm_type(pcm) != SND_PCM_TYPE_HW) return;
  snd_pcm_info_t* raw = nullptr;
  check(snd_pcm_info_malloc(&raw), name, "device information");
  const std::unique_ptr<snd_pcm_info_t, ParamsFree> info(raw);
  check(snd_pcm_info(pcm, raw), name, "device information");
  const std::string path =
      fmt::format("/proc/asound/card{}/pcm{}{}/sub{}/hw_params", snd_pcm_info_get_card(raw),
                  snd_pcm_info_get_device(raw), captures(pcm) ? 'c' : 'p', snd_pcm_info_get_subdevice(raw));
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("rate: ", 0) != 0) continue;
    if (std::strtol(line.c_str() + 6, nullptr, 10) == config.rate_Hz) return;
    refuse(name, "the kernel runs the device at {} instead of the requested {} Hz ({})", line.substr(6),
           config.rate_Hz, path);
  }
  refuse(name, "the sample rate is missing in {}", path);
}

void say_nothing(const char*, int, const char*, int, const char*, va_list) {}

// alsa-lib also prints its errors to standard error. This object silences it on this thread, because our own
// messages report the errors.
struct QuietAlsa {
  snd_local_error_handler_t before = snd_lib_error_set_local(say_nothing);
  QuietAlsa() = default;
  QuietAlsa(const QuietAlsa&) = delete;
  QuietAlsa& operator=(const QuietAlsa&) = delete;
  ~QuietAlsa() { snd_lib_error_set_local(before); }
};

}  // namespace

AlsaDevice open_alsa_device(const OutputConfig& config, const std::string& name, Direction direction) {
  const QuietAlsa quiet;
  AlsaDevice device;
  snd_pcm_t* pcm = nullptr;
  const auto stream = direction == Direction::capture ? SND_PCM_STREAM_CAPTURE : SND_PCM_STREAM_PLAYBACK;
  const int opened = snd_pcm_open(&pcm, name.c_str(), stream, no_conversion | SND_PCM_NONBLOCK);
  check(opened, name,
        opened == -EBUSY ? "the device is in use by another program"
        : opened == -EACCES || opened == -EPERM
            ? "this user may not use sound devices; add the user to the group audio"
            : "the device cannot be opened");
  device.pcm.reset(pcm);
  check_type(pcm, config, name);
  set_hardware(device, config, name);
  set_software(device, name);
  device.chain = described(pcm);
  check_chain(device, config, name);
  check_kernel(pcm, config, name);
  return device;
}

namespace {

struct Free {
  void operator()(snd_ctl_t* card) const noexcept { snd_ctl_close(card); }
  void operator()(snd_ctl_elem_list_t* list) const noexcept {
    snd_ctl_elem_list_free_space(list);
    snd_ctl_elem_list_free(list);
  }
  void operator()(snd_ctl_elem_info_t* info) const noexcept { snd_ctl_elem_info_free(info); }
  void operator()(snd_ctl_elem_value_t* value) const noexcept { snd_ctl_elem_value_free(value); }
};

template <class Made>
std::unique_ptr<Made, Free> made(int (*allocate)(Made**)) {
  Made* object = nullptr;
  if (allocate(&object) < 0) throw std::bad_alloc();
  return std::unique_ptr<Made, Free>(object);
}

std::unique_ptr<snd_ctl_t, Free> open_card(const std::string& uri) {
  const auto name = card_of(uri);
  if (name.empty()) return nullptr;
  const QuietAlsa quiet;
  snd_ctl_t* opened = nullptr;
  if (snd_ctl_open(&opened, name.c_str(), SND_CTL_READONLY) < 0) return nullptr;
  return std::unique_ptr<snd_ctl_t, Free>(opened);
}

// True if somebody can set the element, and the card does not change it by itself.
bool settable(const snd_ctl_elem_info_t* info) {
  return snd_ctl_elem_info_get_interface(info) == SND_CTL_ELEM_IFACE_MIXER &&
         snd_ctl_elem_info_is_readable(info) && snd_ctl_elem_info_is_writable(info) &&
         !snd_ctl_elem_info_is_volatile(info) && !snd_ctl_elem_info_is_inactive(info);
}

std::string item_name(snd_ctl_t* card, snd_ctl_elem_info_t* info, unsigned item) {
  snd_ctl_elem_info_set_item(info, item);
  return snd_ctl_elem_info(card, info) < 0 ? std::to_string(item) : snd_ctl_elem_info_get_item_name(info);
}

// The values of all channels as text; "" for an element that is not a level, a switch or a choice.
std::string values_of(snd_ctl_t* card, snd_ctl_elem_info_t* info, const snd_ctl_elem_value_t* value) {
  std::string text;
  const auto type = snd_ctl_elem_info_get_type(info);
  const auto count = snd_ctl_elem_info_get_count(info);
  for (unsigned k = 0; k < count; ++k) {
    if (k > 0) text += ", ";
    if (type == SND_CTL_ELEM_TYPE_BOOLEAN)
      text += snd_ctl_elem_value_get_boolean(value, k) != 0 ? "on" : "off";
    else if (type == SND_CTL_ELEM_TYPE_INTEGER)
      text += std::to_string(snd_ctl_elem_value_get_integer(value, k));
    else if (type == SND_CTL_ELEM_TYPE_INTEGER64)
      text += std::to_string(snd_ctl_elem_value_get_integer64(value, k));
    else if (type == SND_CTL_ELEM_TYPE_ENUMERATED)
      text += item_name(card, info, snd_ctl_elem_value_get_enumerated(value, k));
    else
      return "";
  }
  return text;
}

}  // namespace

std::string card_of(const std::string& device_uri) {
  constexpr std::string_view scheme = "alsa:", converted = "plug";
  if (!device_uri.starts_with(scheme)) return "";
  auto name = device_uri.substr(scheme.size(), device_uri.find(',') - scheme.size());
  if (name.starts_with("plughw:")) name.erase(0, converted.size());
  return name;
}

std::optional<bool> card_switch(const std::string& output_uri, const std::string& name) {
  const auto levels = mixer_levels(output_uri);
  if (!levels) return std::nullopt;
  const auto found = levels->find(name);
  if (found == levels->end()) return std::nullopt;
  return found->second.find("on") != std::string::npos;
}

std::optional<std::map<std::string, std::string>> mixer_levels(const std::string& device_uri) {
  const auto card = open_card(device_uri);
  if (!card) return std::nullopt;
  const QuietAlsa quiet;
  const auto list = made(snd_ctl_elem_list_malloc);
  const auto info = made(snd_ctl_elem_info_malloc);
  const auto value = made(snd_ctl_elem_value_malloc);
  if (snd_ctl_elem_list(card.get(), list.get()) < 0 ||
      snd_ctl_elem_list_alloc_space(list.get(), snd_ctl_elem_list_get_count(list.get())) < 0 ||
      snd_ctl_elem_list(card.get(), list.get()) < 0)
    return std::nullopt;
  std::map<std::string, std::string> levels;
  for (unsigned k = 0; k < snd_ctl_elem_list_get_used(list.get()); ++k) {
    snd_ctl_elem_info_set_numid(info.get(), snd_ctl_elem_list_get_numid(list.get(), k));
    if (snd_ctl_elem_info(card.get(), info.get()) < 0) return std::nullopt;
    if (!settable(info.get())) continue;
    snd_ctl_elem_value_set_numid(value.get(), snd_ctl_elem_list_get_numid(list.get(), k));
    if (snd_ctl_elem_read(card.get(), value.get()) < 0) return std::nullopt;
    auto name = std::string(snd_ctl_elem_info_get_name(info.get()));
    if (const auto index = snd_ctl_elem_info_get_index(info.get()); index > 0)
      name += "," + std::to_string(index);
    // Controls of several devices of a card may have one name and index.
    if (const auto device = snd_ctl_elem_info_get_device(info.get()); device > 0)
      name += ",device " + std::to_string(device);
    if (const auto subdevice = snd_ctl_elem_info_get_subdevice(info.get()); subdevice > 0)
      name += ",subdevice " + std::to_string(subdevice);
    if (const auto text = values_of(card.get(), info.get(), value.get()); !text.empty()) levels[name] = text;
  }
  return levels;
}

}  // namespace turnpoint::audio
