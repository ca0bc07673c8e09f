# proves: each press of a button gets the kernel's time stamp of its first edge, and a bouncing press counts once
# timeout: 240
gpio_sim OTHER BTN_R BTN_L
pull BTN_L down; pull BTN_R down
station_lines buttons gpio:left=BTN_L,right=BTN_R >station.txt & station=$!
eventually 10 has station.txt ready
for line in BTN_L BTN_R BTN_L; do
  gpio_line bounce "$(pull_file $line)" 80 >>driven.txt
done
cat station.txt
near "presses" "$(grep -c ^press station.txt)" 3 0
awk '$1 == "press" { print $2, $3 }' station.txt | paste -d ' ' <(awk 'NR % 2' driven.txt) - | tee pairs.txt
awk '$4 < $1 || $4 > $2 + 1e6 { bad++ } END { exit bad || NR != 3 }' pairs.txt || fail "the time of a press is not that of its first edge (before, after, stamp in ns; see above)"
[ "$(awk '{ printf "%s ", $3 }' pairs.txt)" = "left right left " ] || fail "the presses were not reported as left, right, left"
kill $station
