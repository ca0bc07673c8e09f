# proves: an output line keeps the level set by the process that holds it, and falls back to its pull level when this process is killed; edges have the kernel's time
# suite: core
# timeout: 240
gpio_sim SPARE AMP_EN BTN_LEFT
pull AMP_EN down
[ "$(level AMP_EN)" = 0 ] || fail "AMP_EN is pulled down but not low"
gpio_line hold AMP_EN 1 >holder.txt & holder=$!
eventually 5 has holder.txt ready
[ "$(level AMP_EN)" = 1 ] || fail "gpio_line did not set AMP_EN high"
fails 1 gpio_line hold AMP_EN 0       # a second process must not get the line
has refusal.txt busy || fail "the message does not say that the line is busy"
kill -KILL $holder
eventually 1 equals level AMP_EN 0

gpio_line watch BTN_LEFT 10 >edges.txt & watcher=$!
eventually 5 has edges.txt ready
for _ in 1 2 3 4 5; do gpio_line press "$(pull_file BTN_LEFT)" 30; done >pressed.txt
wait $watcher
tail -n +2 edges.txt | paste -d ' ' pressed.txt - | tee pairs.txt
awk '{ want = NR % 2 ? "rising" : "falling"; if ($3 < $1 || $3 > $2 + 1e6 || $4 != want) bad++ } END { exit bad || NR != 10 }' pairs.txt ||
  fail "an edge is missing, or its stamp is not within 1 ms of the moment when the line was driven (before, after, stamp in ns; see above)"
