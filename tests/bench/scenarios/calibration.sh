# proves: a calibration can be made from a sweep that is played on a sound card and measured by a simulated vibrometer; in a live session with this calibration, the simulated surface moves as far as the database says
# timeout: 500
gpio_sim AMP_EN AMP_FAULT STOP AMP_HB BTN_L BTN_R
for line in AMP_EN AMP_FAULT STOP AMP_HB BTN_L BTN_R; do pull $line down; done
loopback
rig_with output=alsa:hw:Loopback,0 amplifier=gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB buttons=gpio:left=BTN_L,right=BTN_R \
  <"$SOURCE/deploy/rigs/simulated.toml" >rig.toml
sed -e 's/device = "touch"/device = "buttons"/' "$SOURCE/tests/ui/short.toml" >short.toml
live() { turnpoint run short.toml --rig rig.toml --mode live --participant P1 --db lab.sqlite --buttons-only --json "$@"; }

# cut_short: interrupts a steady tone. The tone must end with its ramp before the amplifier is switched off.
cut_short() {
  record 20 cut.raw; recorder=$!
  turnpoint synth --rig rig.toml --tone 30000:0.5 --seconds 20 --out alsa:hw:Loopback,0 --arm 2>cut.txt & tone=$!
  eventually 10 equals level AMP_EN 1
  sleep 1.2; kill $tone
  status=0; wait $tone || status=$?
  kill $recorder; wait $recorder || true
  cat cut.txt
  [ "$(level AMP_EN)" = 0 ] || fail "the amplifier is still on after the tone was interrupted"
  # On a stalled host the guard can trip before SIGTERM arrives. Then return 1, so that the test is repeated.
  has cut.txt SIGTERM || return 1
  [ $status = 1 ] || fail "after SIGTERM, turnpoint synth exited with $status, expected 1"
}
cut_short || cut_short || cut_short || fail "in three attempts, the guard tripped each time before SIGTERM arrived"
near "the last 2 ms of the interrupted tone, divided by its peak" "$(python3 - <<'PYTHON'
import array
heard = array.array("i", open("cut.raw", "rb").read())[::2]
last = len(heard) - 1
while heard[last] == 0:
    last -= 1
print(max(map(abs, heard[last - 384:last + 1])) / max(map(abs, heard)))
PYTHON
)" 0 0.01

# Without a calibration a live session must be refused.
fails 2 live </dev/null
has refusal.txt "no valid calibration" || fail "the message does not say \"no valid calibration\""

# true_um FREQUENCY: prints the transducer's true response in um at full scale. It has a resonance that the
# rig file does not contain.
true_um() { awk -v f="$1" 'BEGIN { u = (f - 30000) / 8000; printf "%.6f", 3.1 * (1 + 0.5 * exp(-u * u)) }'; }
# moved FILE: simulates a vibrometer on that transducer. It prints the frequency (Hz) of the recorded tone and
# the displacement (um) that the tone causes.
moved() {
  read -r frequency level _ <<<"$(measure_tone "$1" 192000 2 0)"
  awk -v f="$frequency" -v l="$level" -v r="$(true_um "$frequency")" 'BEGIN { printf "%.3f %.6f\n", f, r * 10 ^ (l / 20) }'
}
turnpoint calibrate --rig rig.toml --sweep --points 24 --amplitude 0.1 >sweep.csv
# On a stalled host the guard trips, which is correct. Then start the sweep again, as an operator would.
sweep() {
  record 60 heard.raw; recorder=$!
  turnpoint calibrate --rig rig.toml --sweep --points 24 --amplitude 0.1 --sweep-out alsa:hw:Loopback,0 --arm || status=$?
  kill $recorder; wait $recorder || true
  return $status
}
status=0; sweep || { status=0; sweep; } || { status=0; sweep; }
[ "$(level AMP_EN)" = 0 ] || fail "the amplifier is still on after the sweep"
python3 - <<'PYTHON'
import csv
data = open("heard.raw", "rb").read()
begin = (len(data) - len(data.lstrip(b"\0"))) // 8
for n, step in enumerate(csv.DictReader(open("sweep.csv"))):
    at = begin + round((float(step["start_s"]) + 0.2) * 192000)
    open(f"step{n}.raw", "wb").write(data[8 * at:8 * (at + 9600)])
PYTHON
echo frequency_Hz,displacement_um,phase_deg >response.csv
for n in {0..23}; do moved step$n.raw | sed 's/ /,/; s/$/,0/' >>response.csv; done
paste -d ' ' <(cut -d , -f 2 sweep.csv | tail -n +2) <(cut -d , -f 1 response.csv | tail -n +2) |
  awk '{ d = $1 - $2; if (d > 0.01 || d < -0.01) exit 1 }' || { paste sweep.csv response.csv; fail "a recorded step of the sweep has another frequency than planned"; }

printf '%s\n' displacement_um,relative_friction 0,1 0.5,0.8 1,0.55 2,0.3 4,0.15 8,0.1 >friction.csv
printf '%s\n' frequency_Hz,level_dB 14000,70 30000,60 60000,50 >sound.csv
turnpoint calibrate --rig rig.toml --response main=response.csv --full-scale 0.1 --friction friction.csv --sound sound.csv --note bench
ls rig.calibration-*.toml

# Run a live session of four trials with this calibration. Buttons give the answers.
record 120 heard.raw; recorder=$!
mkfifo operator
live <operator >summary.json 2>console.txt & session=$!
exec 8>operator
# Answer each prompt of the session. On a stalled host the guard may trip, and the session repeats a trial.
said() { grep -cE "$1" console.txt || true; }
armed=0 went_on=0 answered=0
while kill -0 $session 2>/dev/null; do
  [ "$(said "arm or stop")" -le $armed ] || { armed=$(said "arm or stop"); echo arm >&8; }
  [ "$(said "^(instructions|rest|paused)")" -le $went_on ] || { went_on=$((went_on + 1)); sleep 1.5; echo next >&8; }
  [ "$(said "^stimulus")" -le $answered ] || { answered=$((answered + 1)); sleep 1; gpio_line press "$(pull_file BTN_L)" 50 >/dev/null; }
  sleep 0.1
done
status=0; wait $session || status=$?
kill $recorder
cat summary.json
[ $status = 0 ] && has summary.json '"completed"' || { cat console.txt; fail "the session was not completed (exit status $status)"; }
rows() { sqlite3 -separator ' ' lab.sqlite "$1"; }
[ "$(rows "SELECT run_mode FROM session WHERE calibration_id IN (SELECT calibration_id FROM calibration)")" = live ] ||
  fail "the database has no live session with this calibration"

rows "SELECT DISTINCT frequency_Hz, amplitude_um FROM tone" >told.txt
python3 "$BENCH_SOURCE/guest/bursts.py" heard.raw burst 0.1
heard=0
for burst in burst*.raw; do
  read -r frequency_Hz um <<<"$(moved $burst)"
  # look up the stored frequency, and divide the measured displacement by the stored one
  read -r told_Hz ratio <<<"$(awk -v f="$frequency_Hz" -v u="$um" '{ d = f - $1; if (d < 0.02 && d > -0.02) print $1, u / $2 }' told.txt)"
  near "stimulus $heard (Hz)" "$frequency_Hz" "${told_Hz:-0}" 0.02
  near "measured displacement of the drive edge, divided by the stored one" "$ratio" 1 0.02
  heard=$((heard + 1))
done
[ $heard -ge 4 ] || fail "only $heard stimuli were recorded"
[ "$(wc -l <told.txt)" = 2 ] || fail "expected tones at two levels in the database: $(cat told.txt)"
[ "$(rows "SELECT count(*) FROM trial WHERE outcome = 'answered'")" = 4 ] || fail "$(rows "SELECT * FROM trial")"
