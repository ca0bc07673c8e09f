# proves: the kernel stamps each touch with CLOCK_MONOTONIC at the moment of injection, and a panel that goes is noticed
# timeout: 60
# core
modprobe uinput
mkfifo commands
"$BIN/bench_touch_panel" 800 480 <commands >panel.txt & panel=$!
exec 3>commands
eventually 5 grep -q device panel.txt
device=$(awk '/^device/ { print $2 }' panel.txt)
"$BIN/bench_touch_times" "$device" 21 >touches.txt & reader=$!
eventually 5 grep -q ready touches.txt
for i in $(seq 20); do echo "tap $((i * 30)) $((i * 20))" >&3; echo "sleep 40" >&3; done
eventually 20 sh -c '[ $(grep -c tapped panel.txt) = 20 ]'
eventually 5 sh -c '[ $(wc -l <touches.txt) = 21 ]'
echo gone >&3
status=0; wait $reader || status=$?
[ $status = 3 ] || fail "the reader did not notice that the panel has gone"
paste <(awk '/^tapped/ { print $2 }' panel.txt) <(sed -n '2,21p' touches.txt) | awk '
  { late = ($2 - $1) / 1e6; sum += late; if (late < -0.01 || late > 5) bad++ }
  END { printf "# mean %.3f ms after injection, %d of %d beyond 5 ms\n", sum / NR, bad, NR; exit !(NR == 20 && bad == 0) }' ||
  fail "stamps are not the times of the touches"
