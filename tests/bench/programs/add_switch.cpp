// add_switch CARD NAME: adds a mixer switch of this name to a sound card and sets it to "on", as the driver
// of a converter does. The switch exists until the card is removed.
extern "C" {
#include <alsa/asoundlib.h>
}

#include <cstdio>

namespace {

int add(const char* card_name, const char* name) {
  snd_ctl_t* card = nullptr;
  if (const int error = snd_ctl_open(&card, card_name, 0); error < 0) return error;
  snd_ctl_elem_id_t* id = nullptr;
  snd_ctl_elem_id_alloca(&id);
  snd_ctl_elem_id_set_interface(id, SND_CTL_ELEM_IFACE_MIXER);
  snd_ctl_elem_id_set_name(id, name);
  snd_ctl_elem_value_t* on = nullptr;
  snd_ctl_elem_value_alloca(&on);
  snd_ctl_elem_value_set_id(on, id);
  snd_ctl_elem_value_set_boolean(on, 0, 1);
  int error = snd_ctl_elem_add_boolean(card, id, 1);
  // unlock the switch, because otherwise only this process could change it
  if (error >= 0) error = snd_ctl_elem_unlock(card, id);
  if (error >= 0) error = snd_ctl_elem_write(card, on);
  snd_ctl_close(card);
  return error;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "add_switch CARD NAME\n"), 2;
  const int error = add(argv[1], argv[2]);
  if (error < 0) std::fprintf(stderr, "%s: %s: %s\n", argv[1], argv[2], snd_strerror(error));
  return error < 0 ? 1 : 0;
}
