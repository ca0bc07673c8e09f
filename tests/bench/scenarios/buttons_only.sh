# proves: a session runs without a screen: the operator types commands, the participant answers with buttons, and each answer gets its time
# timeout: 400
gpio_sim BTN_L BTN_R
pull BTN_L down; pull BTN_R down
rig_with buttons=gpio:left=BTN_L,right=BTN_R <"$SOURCE/deploy/rigs/simulated.toml" >rig.toml
sed -e 's/device = "touch"/device = "buttons"/' "$SOURCE/tests/ui/short.toml" >short.toml
mkfifo operator
turnpoint run short.toml --rig rig.toml --participant P1 --db lab.sqlite --buttons-only --json \
  <operator >summary.json 2>console.txt & session=$!
exec 8>operator
type() { echo "$*" >&8; }
pages() { grep -c "^$1" console.txt; }
given=0
answer() {
  eventually 20 sh -c "[ \$(grep -c '^stimulus' console.txt) -gt $given ]"
  sleep 0.3
  gpio_line press "$(pull_file "$1")" 50 | head -1 >>given.txt
  given=$((given + 1))
}
eventually 60 has console.txt "^instructions"
type next
answer BTN_L
type note the participant asked
answer BTN_R
eventually 20 has console.txt "^rest"
sleep 2; type next
answer BTN_R
answer BTN_L
status=0; wait $session || status=$?
cat summary.json console.txt
[ $status = 0 ] && has summary.json '"completed"' || fail "the session was not completed (exit status $status)"
rows() { sqlite3 -separator ' ' lab.sqlite "$1"; }
[ "$(rows "SELECT group_concat(response, ' ') FROM trial")" = "left right right left" ] || fail "$(rows "SELECT * FROM trial")"
[ "$(rows "SELECT count(*) FROM trial WHERE response_time_quality = 'kernel' AND response_offset_s = 0")" = 4 ] ||
  fail "not all four answers have the kernel's time and an offset of 0"
[ "$(rows "SELECT text FROM annotation")" = "the participant asked" ] || fail "the operator's note is not in the database"
rows "SELECT onset_ns + CAST(round(response_time_s * 1e9) AS INTEGER) FROM trial ORDER BY trial_index" >recovered.txt
paste -d ' ' given.txt recovered.txt | awk '{ d = $3 - $1; sum += d < 0 ? -d : d; print }
  END { print "mean error", sum / NR * 1e-6, "ms"; exit NR != 4 || sum / NR > 1e5 }' || fail "the stored answer times differ from the presses by more than 0.1 ms on average"
