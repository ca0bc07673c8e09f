# proves: alsa-lib device names that resample or mix are refused; only the hardware device itself is accepted
# timeout: 90
loopback
cat >/root/.asoundrc <<'CONF'
pcm.mixed { type dmix ipc_key 71123 slave { pcm "hw:Loopback,0" rate 48000 channels 2 format S32_LE } }
pcm.shared { type dshare ipc_key 71124 slave { pcm "hw:Loopback,0" rate 48000 channels 2 format S32_LE } bindings { 0 0 1 1 } }
pcm.plug_over_dmix { type plug slave.pcm mixed }
pcm.plug_over_dshare { type plug slave.pcm shared }
pcm.rated { type rate slave { pcm "hw:Loopback,0" rate 48000 format S32_LE } }
pcm.both { type asym playback.pcm plug_over_dmix capture.pcm "hw:Loopback,1" }
CONF
for name in plughw:Loopback,0 default plug:default sysdefault:CARD=Loopback dmix:CARD=Loopback mixed shared plug_over_dmix \
  plug_over_dshare rated both; do
  if drive_stream "alsa:$name" 1920 0.1 >out.txt 2>&1; then fail "$name was accepted"; fi
  say "$name: $(tail -1 out.txt)"
done
# Negative control: through plug, aplay can play 192 kHz on the same card, although the card runs at 48 kHz.
head -c 1536000 /dev/zero | aplay -q -D plug_over_dmix -f S32_LE -r 192000 -c 2 -t raw || fail "aplay cannot open plug_over_dmix, so this scenario proves nothing"
drive_stream alsa:hw:Loopback,0 1920 0.6 >out.txt || fail "the hardware device hw:Loopback,0 was refused"
