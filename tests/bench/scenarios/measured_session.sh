# proves: a session on a sound card measures with [capture] what the simulated laboratory does: levels, phases, onsets and forces are right, and each fault of the laboratory is named in the trial in which it was, and in no other
# needs: fast
# suite: long
# timeout: 1800
loopback 2
cp "$OUT/rig.toml" "$OUT/calibration.toml" .
sed -e 's/device = "touch"/device = "buttons"/' -e 's/ramp_ms = 20/ramp_ms = 5/' -e 's/^explore_s.*/explore_s = 1.0/' \
  -e 's/^deadline_s.*/deadline_s = 60/' -e 's/^anticipation_s.*/anticipation_s = 0/' -e 's/^repeats.*/repeats = 6/' \
  -e '/^break_after/d' -e 's/^feedback.*/feedback = "none"/' "$SOURCE/tests/ui/short.toml" >short.toml
laboratory_begins rig=rig.toml seconds=2000 tones=27847.083464,36160.544818 noise=off
session_begins short.toml --calibration calibration.toml

# What each stimulus finds in the laboratory. A good stimulus follows each fault that makes a trial void.
faults=("" "transducer half" "" "transducer dead" "" "frequency off" "" "drive late" "" "clip 0.1" "" "sounding 0.004" \
  "" "broken bridge" "no reference" "finger lifts" "")
printf '%s\n' "${faults[@]}" >"$OUT/faults.txt"
# The finger touches the surface while the stimulus lasts. When the stimulus is over, the next fault begins.
stimulus_begins() { laboratory_lasts; echo touch 0.8 >&7; }
answer_is_open() {
  laboratory repair
  [ -z "${faults[$stimuli]:-}" ] || laboratory fault "${faults[$stimuli]}"
  echo left >&8
}
conduct
cp truth.txt "$OUT"
laboratory_lasts
session_ends
