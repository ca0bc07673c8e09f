# proves: force cells behind a sound card measure the finger of the simulated laboratory during stimuli of four tones: force, its noise, no offset from the tones, position, speed, and the boundary that the finger feels
# needs: fast
# suite: long
# timeout: 3600
loopback 2
cp "$OUT/rig.toml" "$OUT/calibration.toml" "$OUT/strokes.toml" .
mapfile -t about <"$OUT/laboratory.txt"
laboratory_begins rig=rig.toml seconds=2000 truth=finger.txt "${about[@]}"
session_begins strokes.toml --calibration calibration.toml
# During the first stimulus, there are weights on the surface and no finger. The first weight is put there between the tare
# and the tones. Then a finger strokes to and fro six times during each of three stimuli. During the last stimulus, its force
# and its friction do not vary.
weights=("0.5 0 150" "0.2 0.1 150" "1 -0.3 200" "2 0.5 80")
cue_begins() { [ $stimuli -gt 0 ] || laboratory load "${weights[0]}"; }
stimulus_begins() {
  laboratory_lasts
  if [ $stimuli = 5 ]; then
    laboratory steady
    echo touch 8.6 >&7
    sleep 9
    echo left >&8
  elif [ $stimuli -gt 1 ]; then
    echo touch 20.7 >&7
  else
    sleep 1
    for weight in "${weights[@]:1}"; do laboratory load "$weight"; sleep 0.8; done
    laboratory load 0 0 0
    sleep 3
    echo left >&8
  fi
}
answer_is_open() { [ $stimuli = 1 ] || [ $stimuli = 5 ] || echo left >&8; }
conduct
cp truth.txt finger.txt "$OUT"
laboratory_lasts
session_ends
