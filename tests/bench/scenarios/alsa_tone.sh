# proves: a 192 kHz S32 tone passes through ALSA bit by bit: frequency, level and channel are measured on the other side
# suite: core
# timeout: 240
loopback
make_tone 192000 19600.123 -6 0.8 >played.raw
# On a busy machine snd-aloop may drop the end of what is playing. Append silence, so that nothing else is
# lost.
{ cat played.raw; head -c $((8 * 192000)) /dev/zero; } >with_silence.raw
record 6 tone.raw; recorder=$!
aplay -q -D hw:Loopback,0 -t raw -f S32_LE -c 2 -r 192000 --period-size=1920 --buffer-size=192000 with_silence.raw
wait $recorder
read -r frequency level residual <<<"$(measure_tone tone.raw 192000 2 0)"
near "frequency (Hz)" "$frequency" 19600.123 0.001
near "level (dB)" "$level" -6 0.001
near "residual (dB re tone)" "$residual" -150 50
[ "$(measure_tone tone.raw 192000 2 1)" = "0 -inf 0" ] || fail "channel 1 is not silent"

same_bits() {  # compares both files after the silence at their beginning, which can have any length
  python3 - played.raw "$1" <<'PYTHON'
import sys
played, recorded = ((lambda d: d[(len(d) - len(d.lstrip(b"\0"))) // 8 * 8:])(open(f, "rb").read()) for f in sys.argv[1:])
length = min(len(played), len(recorded))
print(f"# {length // 8} frames compared")
differ = [n // 8 for n in range(0, length, 8) if played[n:n + 8] != recorded[n:n + 8]]
if differ: print(f"# {len(differ)} frames differ, {differ[0]} to {differ[-1]}")
sys.exit(length < 8 * 48000 or played[:length] != recorded[:length])
PYTHON
}
same_bits tone.raw || fail "the recorded samples differ from the played ones"

# Negative control: the comparison must detect that one frame was removed.
{ head -c $((8 * 60000)) played.raw; tail -c +$((8 * 60001 + 1)) played.raw; } >cut.raw
! same_bits cut.raw || fail "same_bits did not detect a missing frame"
read -r _ _ residual <<<"$(tail -c +$((8 * 36001)) cut.raw | head -c $((8 * 48000)) >middle.raw; measure_tone middle.raw 192000 2 0)"
near "residual with a frame missing (dB re tone)" "$residual" 0 30
