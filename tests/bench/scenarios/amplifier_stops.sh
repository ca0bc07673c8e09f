# proves: a press of the stop takes the enable line low within 1 ms, even if the processor is fully loaded and the session gets hardly any processor time
# timeout: 1800
gpio_sim AMP_EN AMP_FAULT STOP AMP_HB
for line in AMP_EN AMP_FAULT STOP AMP_HB; do pull $line down; done
stop_latency "${TURNPOINT_STOPS:-500}" "$(pull_file STOP)" "$(line_of AMP_EN)/value" >"$OUT/stops.txt" 2>&1 ||
  fail "$(cat "$OUT/stops.txt")"
cat "$OUT/stops.txt"
near "longest reaction of ${TURNPOINT_STOPS:-500} (ns)" "$(awk '$1 == "longest_ns" { print $2 }' "$OUT/stops.txt")" 0 1000000
