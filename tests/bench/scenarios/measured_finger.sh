# proves: force cells behind a sound card measure the finger of the simulated laboratory during stimuli of four tones: force, its noise, no offset from the tones, position, speed, and the boundary that the finger feels
# needs: fast
# suite: long
# timeout: 3600
loopback 2
cp "$OUT/rig.toml" "$OUT/calibration.toml" "$OUT/strokes.toml" .
mapfile -t about <"$OUT/laboratory.txt"
laboratory_begins rig=rig.toml seconds=2000 truth=finger.txt "${about[@]}"
mkfifo operator
turnpoint run strokes.toml --rig rig.toml --calibration calibration.toml --participant P1 --db lab.sqlite --buttons-only --json \
  <operator >summary.json 2>console.txt & session=$!
exec 8>operator
# During the first stimulus, there are weights on the surface and no finger. The first weight is put there between the tare
# and the tones. Then a finger strokes to and fro six times during each of three stimuli. During the last stimulus, its force
# and its friction do not vary.
weights=("0.5 0 150" "0.2 0.1 150" "1 -0.3 200" "2 0.5 80")
cue_begins() { [ $stimuli -gt 0 ] || laboratory load "${weights[0]}"; }
stimulus_begins() {
  laboratory_lasts
  cp console.txt "$OUT"
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
conduct $session
cp console.txt truth.txt finger.txt "$OUT"
tail -30 console.txt
status=0; wait $session || status=$?
cp summary.json "$OUT"
[ ! -e lab.sqlite ] || cp lab.sqlite* "$OUT"
cat summary.json
laboratory_lasts
[ $status = 0 ] && has summary.json '"completed"' || fail "the session was not completed (exit status $status)"
has summary.json '"xruns": 0' || fail "the playback had gaps"
