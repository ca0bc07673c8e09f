# proves: the amplifier's enable line goes low within 1 ms after a fault or a press of the stop, and also when the station crashes
# suite: core
# timeout: 240
gpio_sim AMP_EN AMP_FAULT STOP AMP_HB
ln -s "${GPIO_DEVICE##*/}" /dev/gpiochip99    # a second name for the chip, as on Raspberry Pi OS
for line in AMP_EN AMP_FAULT STOP AMP_HB; do pull $line down; done
station_lines amplifier gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB >station.txt & station=$!
eventually 10 has station.txt ready
cat station.txt
eventually 2 equals level AMP_EN 1
beats() {  # reads the line 1500 times and counts how often its level changes
  local file; file=$(line_of "$1")/value
  local last= now n=0
  for _ in {1..1500}; do read -r now <"$file"; [ "$now" = "$last" ] || n=$((n + 1)); last=$now; done
  echo $n
}
[ "$(beats AMP_HB)" -ge 4 ] || fail "the heartbeat line changes too rarely: $(beats AMP_HB) times"

trips=0
for line in AMP_FAULT STOP AMP_FAULT STOP; do
  trips=$((trips + 1))
  near "$line to enable low (us)" "$(($(gpio_line until-low "$(pull_file $line)" "$(line_of AMP_EN)/value") / 1000))" 0 1000
  eventually 2 equals "grep -c ^fault" station.txt $trips
  sleep 0.3; [ "$(level AMP_EN)" = 0 ] || fail "the amplifier was enabled again while $line was still active"
  pull $line down
  eventually 3 equals level AMP_EN 1     # wait until station_lines has cleared the fault and armed again
done
awk '$1 == "fault" && ($3 < 0 || $3 > 1e6) { bad++ } END { exit bad > 0 }' station.txt || fail "the station reports a reaction time below 0 or above 1 ms: $(cat station.txt)"
grep ^fault station.txt
kill -KILL $station
eventually 1 equals level AMP_EN 0

# Test `turnpoint amplifier-off`, which the service runs after the station. If another process holds the line,
# the command must fail at once and name this process.
rig_with amplifier=gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB <"$SOURCE/deploy/rigs/simulated.toml" >rig.toml
gpio_line hold AMP_EN 1 >hold.txt & holder=$!
eventually 2 equals level AMP_EN 1
fails 1 turnpoint amplifier-off --rig rig.toml
has refusal.txt "AMP_EN: in use by bench"
kill -KILL $holder
eventually 2 turnpoint amplifier-off --rig rig.toml
[ "$(level AMP_EN)" = 0 ] || fail "AMP_EN is still high after amplifier-off"
