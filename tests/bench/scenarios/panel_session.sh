# proves: the calibration page measures the panel's latency; in a live session on the frame buffer, answered by touches and buttons, each answer has the kernel's time, and each touch also has the panel's latency as its offset
# needs: screen
# timeout: 1200
gpio_sim BTN_L BTN_R AMP_EN AMP_FAULT STOP AMP_HB
for line in BTN_L BTN_R AMP_EN AMP_FAULT STOP AMP_HB; do pull $line down; done
loopback
panel_begin
screen_begin
export XDG_CONFIG_HOME=$PWD/config
echo 2580 | turnpoint operator-code
export TURNPOINT_DPI=132 QT_LOGGING_RULES=turnpoint.startup=true
rig_with output=alsa:hw:Loopback,0 amplifier=gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB buttons=gpio:left=BTN_L,right=BTN_R "touch=evdev:$PANEL" \
  <"$SOURCE/deploy/rigs/simulated.toml" >rig.toml
turnpoint calibrate --rig rig.toml --panel --json >result.json 2>page.log & page=$!
shown() { [ "$(pixel 20 460)" = eef4f6 ]; }
eventually 60 shown
screenshot field
# Press the button for $delay ms, then touch the panel.
for delay in 20 40 30 50 25 35 45 30 20 40 30 35; do
  sleep 0.5
  gpio_line press "$(pull_file BTN_L)" "$delay" | head -1 >>edges.txt
  touch_do tap 600 300
  eventually 5 equals "grep -c ^tapped" panel.out "$(wc -l <edges.txt)"
done
sleep 0.5; screenshot measured
touch_do tap 740 450                                                     # tap "Keep this"
status=0; wait $page || status=$?
cat result.json page.log
[ $status = 0 ] || fail "turnpoint calibrate exited with $status"
# The true latency is the median time from the button's edge to the injected touch.
paste -d ' ' edges.txt <(grep ^tapped panel.out | head -12) | awk '{ print ($4 - $1) * 1e-9 }' | sort -n >truth.txt
truth=$(awk '{ v[NR] = $1 } END { print (v[6] + v[7]) / 2 }' truth.txt)
stored=$(awk '$1 == "response_offset_s" { print $3 }' rig.calibration-*.toml)
near "response_offset_s" "$stored" "$truth" 0.0001
[ "$(awk '$1 == "response_offset_unmatched" { print $3 }' rig.calibration-*.toml)" = 0 ] || fail "not every tap was matched with a press of the button"

# Add the other parts of a calibration. The file must keep the panel's latency.
calibrate_for_live rig.toml
near "response_offset_s after calibrating again" "$(awk '$1 == "response_offset_s" { print $3 }' rig.calibration-*.toml)" "$truth" 0.0001

# Run a live session from the language page to the last page. The amplifier must be on only during stimuli.
sed -e 's/device = "touch"/device = "either"/' "$SOURCE/tests/ui/short.toml" >short.toml
turnpoint run short.toml --rig rig.toml --db lab.sqlite --mode live --consent 2026-03 --json \
  >summary.json 2>session.log & session=$!
tap() { touch_do tap "$1" "$2"; sleep 0.2; }
trials() { sqlite3 lab.sqlite "SELECT count(*) FROM trial" 2>/dev/null || echo 0; }
# touch_answer X and press LINE give an answer, and append the two times (ns) between which it was given to
# given.txt.
touch_answer() { touch_do tap "$1" 370; sleep 0.2; tail -1 panel.out | cut -d ' ' -f 2,3 >>given.txt; }
press() { gpio_line press "$(pull_file "$1")" 50 | head -1 >>given.txt; }
# goes_on: succeeds once answers are accepted. Until then it taps "continue"; call it repeatedly, because a
# new page ignores taps for a moment.
goes_on() { answers_open && return; ! continues || tap 400 390; return 1; }

eventually 60 has session.log "first page"
say "first page after $(awk '/first page/ { print $5 }' session.log) ms in the emulated machine"
screenshot language
eventually 10 shows 200 200
tap 400 210                       # choose English
eventually 10 shows 416 415
sleep 0.7; tap 505 415            # give consent
sleep 1; screenshot code
tap 60 300; tap 130 240           # enter the participant's code A2
tap 700 425
eventually 20 continues
[ "$(level AMP_EN)" = 0 ] || fail "the amplifier is on before the first stimulus"
done=0
for answer in "touch_answer 200" "press BTN_R" "touch_answer 600" "press BTN_L"; do
  eventually 30 goes_on
  [ "$(level AMP_EN)" = 1 ] || fail "the amplifier is off during a stimulus"
  [ $done != 0 ] || screenshot trial
  sleep 0.2
  $answer
  done=$((done + 1))
  eventually 10 equals trials "" $done
  [ $done != 2 ] || { screenshot break; eventually 10 continues; }
done
page_is_clear() { ! shows 60 400; }
eventually 20 page_is_clear
sleep 1; screenshot end
tap 560 390; sleep 0.7; operator_code                                    # tap "Close", which needs the code
status=0; wait $session || status=$?
cat summary.json session.log
[ $status = 0 ] && has summary.json '"completed"' || fail "the session was not completed (exit status $status)"
[ "$(level AMP_EN)" = 0 ] || fail "the amplifier is on after the session"

rows() { sqlite3 -separator ' ' lab.sqlite "$1"; }
[ "$(rows "SELECT participant FROM session")" = A2 ] || fail "the stored participant is not A2"
# Print by how much (ms) each stored answer time lies outside the two times between which the answer was
# given.
rows "SELECT onset_ns + CAST(round(response_time_s * 1e9) AS INTEGER) FROM trial ORDER BY trial_index" >recovered.txt
paste -d ' ' given.txt recovered.txt | awk '
  { late = $3 > $2 ? $3 - $2 : $3 < $1 ? $3 - $1 : 0; sum += late < 0 ? -late : late; after += ($3 - $1) / 1e6; print $1, $2, $3, late * 1e-6 " ms" }
  END { print "mean error", sum / NR * 1e-6, "ms; mean time after the start of the press or touch", after / NR, "ms"; exit NR != 4 || sum / NR > 1e5 }' || fail "the stored answer times are wrong by more than 0.1 ms on average"

turnpoint export --db lab.sqlite --out export >/dev/null
column() { awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i; next } { printf "%s ", $at }' export/short/trials.csv; }
column run_mode; column response; column response_time_quality; column response_offset_s; column xruns
[ "$(column run_mode)" = "live live live live " ] || fail "not all trials are live: $(column run_mode)"
[ "$(column response)" = "left right right left " ] || fail "answers: $(column response)"
[ "$(column response_time_quality)" = "kernel kernel kernel kernel " ] || fail "not every answer has the kernel's time"
read -r touch1 button1 touch2 button2 <<<"$(column response_offset_s)"
for offset in "$button1" "$button2"; do near "offset of a button" "$offset" 0 0; done
for offset in "$touch1" "$touch2"; do near "offset of a touch" "$offset" "$truth" 0.0001; done
