# proves: the calibration page finds a panel's latency and jitter against a button, and sessions keep it with touches
# needs: screen
# timeout: 500
gpio_sim BTN_L BTN_R
pull BTN_L down; pull BTN_R down
panel_begin
screen_begin
export TURNPOINT_DPI=132 QT_LOGGING_RULES=turnpoint.startup=true
sed -e "/^\[buttons\]/,/^uri/ s|^uri.*|uri = \"gpio:left=BTN_L,right=BTN_R\"|" \
  -e "/^\[touch\]/,/^uri/ s|^uri.*|uri = \"evdev:$PANEL\"|" "$SOURCE/deploy/rigs/simulated.toml" >rig.toml
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
