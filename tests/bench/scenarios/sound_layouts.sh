# proves: samples reach a sound card unchanged, as S32_LE on a card with 2 channels and as S24_3LE on 2 of 6 channels; a card that needs another layout is refused, with a message that names the layout; the doctor finds a converter that mutes itself, and its advice solves the problem
# timeout: 900
loopback
# Each channel plays a tone with another frequency, so that swapped channels are detected.
second='[[transducer]]\nname = "second"\nchannel = 1\nband_kHz = [60, 80]\num_per_full_scale = 4.0\n'
rig() {  # rig FILE BITS [DEVICE_CHANNELS]: writes a rig file with this output format
  sed -e "s/^rate_Hz.*/&\nbits = $2\nperiod_frames = 1920\nperiods = 40${3:+\ndevice_channels = $3}/" -e "s/^\[output\]/$second\n&/" \
    -e 's/"null:"/"alsa:hw:CARD=Loopback,DEV=0"/' "$SOURCE/deploy/rigs/simulated.toml" >"$1"
}
rig two.toml 24
rig six.toml 24 6
rig deep.toml 32
synth() { turnpoint synth --rig "$1" --tone 30000:1 --tone 70000:2 --seconds 0.5 --out "$2" --json >report.json; }
onset() { sed -n 's/.*"onset_frame": \([0-9]*\).*/\1/p' report.json; }
# expected: computes the samples of the last burst and writes them to expected.raw.
expected() { burst_samples "$(onset)" 0.5 30000:0.25:0 70000:0.5:1 >expected.raw; }
# card FORMAT CHANNELS: records from the loopback card in this format. The card's playback side then accepts
# no other format.
card() {
  arecord -q -D hw:Loopback,1 -t raw -f "$1" -c "$2" -r 192000 --period-size=9600 --buffer-size=76800 heard.raw & recorder=$!
  eventually 10 grep -q RUNNING /proc/asound/Loopback/pcm1c/sub0/status
}
no_card() { kill $recorder; wait $recorder || true; }
# same_bits FILE BYTES CHANNELS: succeeds if FILE contains the whole expected burst, in samples of BYTES
# bytes, and only zeros before and after it.
same_bits() {
  python3 - "$@" <<'PYTHON'
import sys
name, width, channels = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
heard, stereo = open(name, "rb").read(), open("expected.raw", "rb").read()
cut = [stereo[n + 4 - width:n + 4] for n in range(0, len(stereo), 4)]
if any(stereo[n:n + 4 - width].strip(b"\0") for n in range(0, len(stereo), 4)): sys.exit("# more bits than the card takes")
spare = bytes((channels - 2) * width)
wanted = b"".join(left + right + spare for left, right in zip(cut[::2], cut[1::2]))
first = lambda data: (len(data) - len(data.lstrip(b"\0"))) // (channels * width) * channels * width
begin = first(heard) - first(wanted)
same = begin >= 0 and heard[begin:begin + len(wanted)] == wanted and not heard[begin + len(wanted):].strip(b"\0")
print(f"# {name}: {len(wanted) // (channels * width)} frames {'are the same' if same else 'differ'}")
sys.exit(not same)
PYTHON
}

# First check burst_samples: `turnpoint synth` must write the same samples to a file.
synth two.toml wav:tone.wav
expected
tail -c +69 tone.wav >tone.raw
same_bits tone.raw 4 2 || fail "burst_samples and turnpoint synth differ"

plays() {  # plays RIG FORMAT BYTES CHANNELS: plays the burst and compares the samples that the card received
  card "$2" "$4"
  synth "$1" alsa:hw:Loopback,0
  sed -n '/^format\|^channels/p' </proc/asound/Loopback/pcm1c/sub0/hw_params
  sleep 0.7   # wait for the last samples to arrive
  no_card
  has report.json '"underruns": 0' || return 1   # the host stalled, so the caller tries again
  expected
  same_bits heard.raw "$3" "$4" || fail "$2 in $4 channels: the recorded samples are not the expected ones"
}
bits() { plays "$@" || plays "$@" || plays "$@" || fail "three attempts all had an underrun"; }
bits two.toml S32_LE 4 2
bits six.toml S24_3LE 3 6
# Negative controls: the comparison must detect a wrong bit, a missing frame, and a signal in an unused
# channel.
spoilt() {  # spoilt WHAT POSITION BYTES FLIP: changes BYTES bytes by FLIP, or removes them if FLIP is 0
  python3 - "$@" <<'PYTHON'
import sys
data = bytearray(open("heard.raw", "rb").read())
at = (len(data) - len(data.lstrip(b"\0"))) // 18 * 18 + int(sys.argv[2])
data[at:at + int(sys.argv[3])] = bytes(data[at + n] ^ int(sys.argv[4]) for n in range(int(sys.argv[3]))) if int(sys.argv[4]) else b""
open("spoilt.raw", "wb").write(data)
PYTHON
  ! same_bits spoilt.raw 3 6 || fail "same_bits did not detect $1"
}
spoilt "a wrong bit" $((18 * 48000)) 1 1
spoilt "a missing frame" $((18 * 48000)) 18 0
spoilt "a sound in an unused channel" $((18 * 48000 + 6)) 1 1

refused() { fails 1 synth "$1" alsa:hw:Loopback,0; has refusal.txt "$2" || fail "the message does not say \"$2\""; }
card S32_LE 6
refused two.toml "does not accept 2 channels; it accepts 6 (set device_channels in the rig file)"
synth six.toml alsa:hw:Loopback,0
no_card
card S24_3LE 2
refused deep.toml "accepts samples of 24 bits, but the rig file says 32"
refused six.toml "does not accept 6 channels; it accepts 2 (set device_channels in the rig file)"
synth two.toml alsa:hw:Loopback,0
no_card
card S16_LE 2
refused two.toml "accepts neither 32-bit samples (S32_LE) nor 24-bit samples (S24_3LE)"
no_card

# `turnpoint doctor` prints the line "converter mute" only for a card that has a mixer switch named Auto Mute.
doctor() {
  status=0
  turnpoint doctor --rig two.toml --data . >doctor.txt 2>&1 || status=$?
  sed -n '/^converter/,/^amplifier/p' doctor.txt
}
doctor
! has doctor.txt "^converter mute" || fail "the doctor reports a mute switch that the card does not have"
add_switch hw:Loopback "Auto Mute Switch"
doctor
has doctor.txt "^converter mute *failed *Auto Mute is on" || fail "the doctor did not report that Auto Mute is on"
[ $status = 1 ] || fail "the doctor exited with $status, expected 1"
advice=$(sed -n 's/.*-> run \(amixer .*\), then sudo alsactl store/\1/p' doctor.txt)
say "$advice"
eval "$advice"
doctor
has doctor.txt "^converter mute *ok *Auto Mute is off" || fail "the doctor's advice did not switch Auto Mute off"
