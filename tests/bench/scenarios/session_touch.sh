# proves: a whole session answered by touches and buttons on the bare frame buffer; each answer has its kernel time
# needs: screen
# timeout: 500
gpio_sim BTN_L BTN_R
pull BTN_L down; pull BTN_R down
panel_begin
screen_begin
export TURNPOINT_DPI=132 QT_LOGGING_RULES=turnpoint.startup=true
rig_with buttons=gpio:left=BTN_L,right=BTN_R "touch=evdev:$PANEL" <"$SOURCE/deploy/rigs/simulated.toml" >rig.toml
sed -e 's/device = "touch"/device = "either"/' "$SOURCE/tests/ui/short.toml" >short.toml
turnpoint run short.toml --rig rig.toml --db lab.sqlite --consent 2026-03 --json >summary.json 2>session.log & session=$!

tap() { touch_do tap "$1" "$2"; sleep 0.2; }
trials() { sqlite3 lab.sqlite "SELECT count(*) FROM trial" 2>/dev/null || echo 0; }
# Both keep, for each answer, between which times (ns) it was given.
touch_answer() { touch_do tap "$1" 370; sleep 0.2; tail -1 panel.out | cut -d ' ' -f 2,3 >>given.txt; }
press() { gpio_line press "$(pull_file "$1")" 50 | head -1 >>given.txt; }

eventually 60 has session.log "first page"
near "first page (ms)" "$(awk '/first page/ { print $5 }' session.log)" 0 3000
screenshot language
eventually 10 shows 200 200
tap 400 210                       # English
eventually 10 shows 400 410
tap 480 410                       # consent
screenshot code
tap 60 300; tap 130 240           # A2
tap 700 425
eventually 20 continues
done=0
for answer in "touch_answer 200" "press BTN_R" "touch_answer 600" "press BTN_L"; do
  sleep 0.5                       # a page reacts once it can have been read
  ! continues || tap 400 390
  eventually 20 answers_open
  [ $done = 0 ] && screenshot trial
  sleep 0.2
  $answer
  done=$((done + 1))
  eventually 10 equals trials "" $done
  [ $done = 2 ] && { screenshot break; eventually 10 continues; }
  :
done
page_is_clear() { ! shows 60 400; }
eventually 20 page_is_clear
sleep 1; screenshot end
tap 560 390                       # Close
status=0; wait $session || status=$?
cat summary.json
[ $status = 0 ] && has summary.json '"completed"' || fail "the session ended with $status: $(cat session.log)"

rows() { sqlite3 -separator ' ' lab.sqlite "$1"; }
[ "$(rows "SELECT group_concat(response, ' ') FROM trial")" = "left right right left" ] || fail "$(rows "SELECT * FROM trial")"
[ "$(rows "SELECT count(*) FROM trial WHERE response_time_quality = 'kernel'")" = 4 ] || fail "an answer without its kernel time"
[ "$(rows "SELECT participant FROM session")" = A2 ] || fail "not the participant who typed the code"
# When each answer was given, by its row: error beyond the time that the injection itself took, in ms.
rows "SELECT onset_ns + CAST(round(response_time_s * 1e9) AS INTEGER) FROM trial ORDER BY trial_index" >recovered.txt
paste -d ' ' given.txt recovered.txt | awk '
  { late = $3 > $2 ? $3 - $2 : $3 < $1 ? $3 - $1 : 0; sum += late < 0 ? -late : late; after += ($3 - $1) / 1e6; print $1, $2, $3, late * 1e-6 " ms" }
  END { print "mean error", sum / NR * 1e-6, "ms; mean distance from the begin of the injection", after / NR, "ms"; exit NR != 4 || sum / NR > 1e5 }' || fail "not recovered within 0.1 ms"
