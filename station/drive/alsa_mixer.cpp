#include "station/drive/alsa_mixer.hpp"

#include <alsa/asoundlib.h>

#include <memory>
#include <string_view>

namespace turnpoint::drive {
namespace {

struct Free {
  void operator()(snd_ctl_t* card) const noexcept { snd_ctl_close(card); }
  void operator()(snd_ctl_elem_info_t* info) const noexcept { snd_ctl_elem_info_free(info); }
  void operator()(snd_ctl_elem_value_t* value) const noexcept { snd_ctl_elem_value_free(value); }
};

}  // namespace

std::optional<bool> card_switch(const std::string& output_uri, const std::string& name) {
  constexpr std::string_view scheme = "alsa:";
  if (!output_uri.starts_with("alsa:hw:")) return std::nullopt;
  // Remove the device part of the name: the card of hw:CARD=NAME,DEV=0 is hw:CARD=NAME.
  const std::string card_name = output_uri.substr(scheme.size(), output_uri.find(',') - scheme.size());
  snd_ctl_t* opened = nullptr;
  if (snd_ctl_open(&opened, card_name.c_str(), SND_CTL_READONLY) < 0) return std::nullopt;
  const std::unique_ptr<snd_ctl_t, Free> card(opened);
  snd_ctl_elem_info_t* new_info = nullptr;
  snd_ctl_elem_value_t* new_value = nullptr;
  if (snd_ctl_elem_info_malloc(&new_info) < 0) return std::nullopt;
  const std::unique_ptr<snd_ctl_elem_info_t, Free> info(new_info);
  if (snd_ctl_elem_value_malloc(&new_value) < 0) return std::nullopt;
  const std::unique_ptr<snd_ctl_elem_value_t, Free> value(new_value);
  snd_ctl_elem_info_set_interface(info.get(), SND_CTL_ELEM_IFACE_MIXER);
  snd_ctl_elem_info_set_name(info.get(), name.c_str());
  snd_ctl_elem_value_set_interface(value.get(), SND_CTL_ELEM_IFACE_MIXER);
  snd_ctl_elem_value_set_name(value.get(), name.c_str());
  if (snd_ctl_elem_info(card.get(), info.get()) < 0 || snd_ctl_elem_read(card.get(), value.get()) < 0)
    return std::nullopt;
  for (unsigned channel = 0; channel < snd_ctl_elem_info_get_count(info.get()); ++channel)
    if (snd_ctl_elem_value_get_boolean(value.get(), channel) != 0) return true;
  return false;
}

}  // namespace turnpoint::drive
