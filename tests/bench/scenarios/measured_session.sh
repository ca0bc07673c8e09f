# proves: a session on a sound card measures with [capture] what the simulated laboratory does: levels, phases, onsets and forces are right, and each fault of the laboratory is named in the trial in which it was, and in no other
# needs: fast
# suite: long
# timeout: 1800
loopback 2
cp "$OUT/rig.toml" "$OUT/calibration.toml" .
sed -e 's/device = "touch"/device = "buttons"/' -e 's/ramp_ms = 20/ramp_ms = 5/' -e 's/^explore_s.*/explore_s = 1.0/' \
  -e 's/^deadline_s.*/deadline_s = 60/' -e 's/^anticipation_s.*/anticipation_s = 0/' -e 's/^repeats.*/repeats = 6/' \
  -e '/^break_after/d' -e 's/^feedback.*/feedback = "none"/' "$SOURCE/tests/ui/short.toml" >short.toml
mkfifo operator laboratory
exec 7<>laboratory
chrt -f 60 plant rig=rig.toml seconds=2000 tones=27847.083464,36160.544818 noise=off commands=laboratory >truth.txt & plant=$!
eventually 60 test -s truth.txt
turnpoint run short.toml --rig rig.toml --calibration calibration.toml --participant P1 --db lab.sqlite --buttons-only --json \
  <operator >summary.json 2>console.txt & session=$!
exec 8>operator

# What each stimulus finds in the laboratory. A good stimulus follows each fault that makes a trial void.
faults=("" "transducer half" "" "transducer dead" "" "frequency off" "" "drive late" "" "clip 0.1" "" "sounding 0.004" \
  "" "broken bridge" "no reference" "finger lifts" "")
printf '%s\n' "${faults[@]}" >"$OUT/faults.txt"
# laboratory LINE: has the laboratory do something, and waits until it is done.
laboratory() {
  local before; before=$(grep -c ^done: truth.txt || true)
  echo "$*" >&7
  eventually 30 sh -c "[ \$(grep -c ^done: truth.txt) -gt $before ]"
}
said() { grep -cE "$1" console.txt || true; }
mended=0 went_on=0 touched=0 answered=0
while kill -0 $session 2>/dev/null; do
  kill -0 $plant 2>/dev/null || { tail console.txt; fail "the laboratory was too slow for the card"; }
  [ "$(said "note REASON")" = 0 ] || { tail console.txt; fail "the self-test found a fault"; }
  if [ "$(said ^fault)" -gt $mended ]; then
    mended=$(said ^fault)
    sleep 0.5
    case $(grep ^fault console.txt | tail -1) in *"arm or stop"*) echo arm ;; *) echo next ;; esac >&8
  fi
  [ "$(said "^(instructions|rest|paused)")" -le $went_on ] || { went_on=$((went_on + 1)); echo next >&8; }
  # The finger touches the surface while the stimulus lasts.
  [ "$(said ^stimulus)" -le $touched ] || { touched=$(said ^stimulus); echo touch 0.8 >&7; }
  # When the stimulus is over, the next fault begins.
  if [ "$(said ^response)" -gt $answered ]; then
    answered=$(said ^response)
    laboratory repair
    [ -z "${faults[$touched]:-}" ] || laboratory fault "${faults[$touched]}"
    echo left >&8
  fi
  sleep 0.1
done
cp console.txt truth.txt "$OUT"
tail -30 console.txt
status=0; wait $session || status=$?
cp summary.json "$OUT"
[ ! -e lab.sqlite ] || cp lab.sqlite* "$OUT"
cat summary.json
kill -0 $plant || fail "the laboratory was too slow for the card"
[ $status = 0 ] && has summary.json '"completed"' || fail "the session was not completed (exit status $status)"
has summary.json '"xruns": 0' || fail "the playback had gaps"
