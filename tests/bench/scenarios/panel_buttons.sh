# proves: a bouncing press counts once, with the kernel's time of its first edge; a spike (a pulse too short for a press) is reported as a glitch; lost edges and a removed chip are reported
# timeout: 90
# suite: core
gpio_sim BTN_L BTN_R FINGER
for line in BTN_L BTN_R FINGER; do pull $line down; done
panel_events gpio:left=BTN_L,right=BTN_R,refractory_ms=400 gpio:line=FINGER 30 >events.txt & panel=$!
eventually 5 has events.txt ready
for i in 1 2 3; do
  # three presses within the refractory time of 400 ms
  for bounce in 1 2 3; do gpio_line press "$(pull_file BTN_R)" 5; done >pressed.txt
  eventually 5 sh -c "[ \$(grep -c '^press 1' events.txt) = $i ]"
  stamp=$(awk '/^press 1/ { print $3 }' events.txt | tail -1)
  read -r before after _ <pressed.txt
  [ "$stamp" -ge "$before" ] && [ "$stamp" -le "$((after + 1000000))" ] || fail "the press is stamped $stamp ns, but its first edge was between $before and $after ns"
  sleep 1
done
pull FINGER up; eventually 5 grep -q "^contact 1" events.txt
pull FINGER down; eventually 5 grep -q "^contact 0" events.txt
[ "$(grep -c ^press events.txt)" = 3 ] || fail "$(grep -c ^press events.txt) presses were reported, expected 3"
# A spike must be reported as a glitch.
gpio_line press "$(pull_file BTN_L)" 0 >spike.txt
eventually 5 grep -q "^glitch left" events.txt
read -r before after _ <spike.txt
awk -v b="$before" -v a="$after" '/^glitch left/ { exit !($3 >= b && $3 <= a + 1e6 && $5 < 1.5e6) }' events.txt ||
  fail "the glitch does not match the spike between $before and $after ns: $(grep ^glitch events.txt)"
! grep -q "^press 0" events.txt || fail "a spike was reported as a press"
# Freeze the program while there are more edges than the kernel can store.
kill -STOP $panel
for k in $(seq 40); do pull BTN_L up; pull BTN_L down; done
kill -CONT $panel
eventually 5 grep -q "^press 0" events.txt
pull BTN_L up; pull BTN_L down
eventually 5 grep -q "^fault line left: .*lost" events.txt
grep ^fault events.txt
echo 0 >/sys/kernel/config/gpio-sim/bench/live
eventually 5 grep -q "fault.*chip was removed" events.txt
