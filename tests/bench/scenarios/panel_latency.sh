# proves: the panel's latency, found on its calibration page, stands beside a live session's answers by touch
# needs: screen
# timeout: 1200
gpio_sim BTN_L BTN_R AMP_EN AMP_FAULT STOP AMP_HB
for line in BTN_L BTN_R AMP_EN AMP_FAULT STOP AMP_HB; do pull $line down; done
loopback
panel_begin
screen_begin
export TURNPOINT_DPI=132 QT_LOGGING_RULES=turnpoint.startup=true
rig_with output=alsa:hw:Loopback,0 amplifier=gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB buttons=gpio:left=BTN_L,right=BTN_R "touch=evdev:$PANEL" \
  <"$SOURCE/deploy/rigs/simulated.toml" >rig.toml
turnpoint calibrate --rig rig.toml --panel --json >result.json 2>page.log & page=$!
shown() { [ "$(pixel 20 460)" = eef4f6 ]; }
eventually 60 shown
screenshot field
for delay in 20 40 30 50 25 35 45 30 20 40 30 35; do
  sleep 0.5
  gpio_line press "$(pull_file BTN_L)" "$delay" | head -1 >>edges.txt     # released, and then the panel is touched
  touch_do tap 600 300
  eventually 5 equals "grep -c ^tapped" panel.out "$(wc -l <edges.txt)"
done
sleep 0.5; screenshot measured
touch_do tap 740 450                                                     # Keep this
status=0; wait $page || status=$?
cat result.json page.log
[ $status = 0 ] || fail "calibrate ended with $status"
# The truth: from each edge to its injected touch, and the median of these.
paste -d ' ' edges.txt <(grep ^tapped panel.out | head -12) | awk '{ print ($4 - $1) * 1e-9 }' | sort -n >truth.txt
truth=$(awk '{ v[NR] = $1 } END { print (v[6] + v[7]) / 2 }' truth.txt)
stored=$(awk '$1 == "response_offset_s" { print $3 }' rig.calibration-*.toml)
near "response_offset_s" "$stored" "$truth" 0.0001
[ "$(awk '$1 == "response_offset_unmatched" { print $3 }' rig.calibration-*.toml)" = 0 ] || fail "a tap was not matched"

# The rest of the calibration; what was found of the panel stays in it.
calibrate_for_live rig.toml
near "response_offset_s, calibrated again" "$(awk '$1 == "response_offset_s" { print $3 }' rig.calibration-*.toml)" "$truth" 0.0001

# A live session: three answers by touch, one by a button, the amplifier on while there is something to feel.
sed -e 's/device = "touch"/device = "either"/' "$SOURCE/tests/ui/short.toml" >short.toml
turnpoint run short.toml --rig rig.toml --db lab.sqlite --mode live --participant L1 --language en --json \
  >summary.json 2>session.log & session=$!
trials() { sqlite3 lab.sqlite "SELECT count(*) FROM trial" 2>/dev/null || echo 0; }
touch_answer() { touch_do tap "$1" 370; }
press() { gpio_line press "$(pull_file "$1")" 50 >/dev/null; }
# A tap before the page could have been read does nothing: then once more.
goes_on() { answers_open && return; ! continues || { touch_do tap 400 390; sleep 0.5; }; return 1; }
eventually 60 continues
[ "$(level AMP_EN)" = 0 ] || fail "the amplifier is on before there is anything to feel"
screenshot live
done=0
for answer in "touch_answer 200" "press BTN_R" "touch_answer 600" "touch_answer 200"; do
  eventually 30 goes_on
  [ "$(level AMP_EN)" = 1 ] || fail "a stimulus, and the amplifier is off"
  sleep 0.2
  $answer
  done=$((done + 1))
  eventually 10 equals trials "" $done
  [ $done != 2 ] || eventually 10 continues
done
page_is_clear() { ! shows 60 400; }
eventually 20 page_is_clear
sleep 1; touch_do tap 560 390     # Close
status=0; wait $session || status=$?
cat summary.json session.log
near "first page (ms)" "$(awk '/first page/ { print $5 }' session.log)" 0 3000
[ $status = 0 ] && has summary.json '"completed"' || fail "the session ended with $status"
[ "$(level AMP_EN)" = 0 ] || fail "the amplifier is still on"
turnpoint export --db lab.sqlite --out export >/dev/null
column() { awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i; next } { printf "%s ", $at }' export/short/trials.csv; }
column run_mode; column response; column response_time_quality; column response_offset_s; column xruns
[ "$(column run_mode)" = "live live live live " ] || fail "not a live session: $(column run_mode)"
[ "$(column response)" = "left right right left " ] || fail "answers: $(column response)"
[ "$(column response_time_quality)" = "kernel kernel kernel kernel " ] || fail "an answer without its kernel time"
read -r touch1 button touch2 touch3 <<<"$(column response_offset_s)"
near "offset of the button" "$button" 0 0
for offset in "$touch1" "$touch2" "$touch3"; do near "offset of a touch" "$offset" "$truth" 0.0001; done
