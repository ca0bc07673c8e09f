# proves: a line is found by name and set, an edge carries the kernel's monotonic time, and a killed holder's line falls back to its pull
# timeout: 60
# core
gpio_sim AMP_EN STOP BTN_L BTN_R
pull AMP_EN down

$BIN/bench_gpio_line hold AMP_EN 1 >hold.txt & holder=$!
eventually 5 grep -q ready hold.txt
[ "$(level AMP_EN)" = 1 ] || fail "AMP_EN was not driven"

$BIN/bench_gpio_line watch BTN_L 2 >edges.txt & watcher=$!
eventually 5 grep -q ready edges.txt
before=$($BIN/bench_clock)
pull BTN_L up
after=$($BIN/bench_clock)
pull BTN_L down
wait $watcher
read -r stamp kind < <(sed -n 2p edges.txt)
say "edge $kind at $stamp, between $before and $after"
[ "$kind" = rising ] && [ "$stamp" -ge "$before" ] && [ "$stamp" -le "$after" ] || fail "the edge's stamp is not the time of the edge"

kill -KILL $holder
wait $holder || true
eventually 5 test "$(level AMP_EN)" = 0
