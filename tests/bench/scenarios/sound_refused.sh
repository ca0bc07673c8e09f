# proves: a sound device is refused if it has another rate, is behind a resampler, is in use or is absent; the message names the reason
# timeout: 240
loopback
sed '/^rate_Hz/a period_frames = 1920' "$SOURCE/deploy/rigs/simulated.toml" >rig.toml
synth() { turnpoint synth --rig rig.toml --tone 30000:1 --seconds 0.3 --out "$1"; }
refused() { fails 1 synth "$1"; has refusal.txt "$2" || fail "the message does not say \"$2\""; }

refused alsa:hw:CARD=Nobody "Nobody"
refused alsa:plughw:Loopback,0 "plug-in"
aplay -q -D hw:Loopback,0 -t raw -f S32_LE -c 2 -r 192000 /dev/zero & other=$!
eventually 5 grep -q RUNNING /proc/asound/Loopback/pcm0p/sub0/status
refused alsa:hw:Loopback,0 "in use"
kill $other; wait $other || true
# Both sides of the card must have the same rate. While the other side runs at 44.1 kHz, 192 kHz is refused.
record 20 /dev/null 44100; recorder=$!
eventually 5 grep -q RUNNING /proc/asound/Loopback/pcm1c/sub0/status
refused alsa:hw:Loopback,0 "rate 192000 Hz not supported; it offers 44100"
kill $recorder; wait $recorder || true
synth alsa:hw:Loopback,0     # negative control: without these obstacles the card plays
