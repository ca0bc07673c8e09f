#include "station/drive/alsa_mixer.hpp"

#include <memory>
#include <string_view>
#include <vector>

#include "station/drive/alsa_device.hpp"

namespace turnpoint::drive {
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

// The card of alsa:hw:CARD=NAME,DEV=0 and of alsa:plughw:CARD=NAME,DEV=0 is hw:CARD=NAME.
std::unique_ptr<snd_ctl_t, Free> open_card(const std::string& uri) {
  constexpr std::string_view scheme = "alsa:", converted = "plug";
  if (!uri.starts_with(scheme)) return nullptr;
  auto name = uri.substr(scheme.size(), uri.find(',') - scheme.size());
  if (name.starts_with("plughw:")) name.erase(0, converted.size());
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
    if (const auto text = values_of(card.get(), info.get(), value.get()); !text.empty()) levels[name] = text;
  }
  return levels;
}

}  // namespace turnpoint::drive
