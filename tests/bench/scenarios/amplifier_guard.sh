# proves: the amplifier's enable line becomes low within 1 ms of a fault or a stop, and also when the station crashes
# suite: core
# timeout: 240
gpio_sim AMP_EN AMP_FAULT STOP AMP_HB
ln -s "${GPIO_DEVICE##*/}" /dev/gpiochip99    # gives the chip a second name, as Raspberry Pi OS does
for line in AMP_EN AMP_FAULT STOP AMP_HB; do pull $line down; done
station_lines amplifier gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB >station.txt & station=$!
eventually 10 has station.txt ready
cat station.txt
eventually 2 equals level AMP_EN 1
beats() {  # counts the changes of the heartbeat line, by polling it often
  local file; file=$(line_of "$1")/value
  local last= now n=0
  for _ in {1..1500}; do read -r now <"$file"; [ "$now" = "$last" ] || n=$((n + 1)); last=$now; done
  echo $n
}
[ "$(beats AMP_HB)" -ge 4 ] || fail "no heartbeat: $(beats AMP_HB) changes"

trips=0
for line in AMP_FAULT STOP AMP_FAULT STOP; do
  trips=$((trips + 1))
  near "$line to enable low (us)" "$(($(gpio_line until-low "$(pull_file $line)" "$(line_of AMP_EN)/value") / 1000))" 0 1000
  eventually 2 equals "grep -c ^fault" station.txt $trips
  sleep 0.3; [ "$(level AMP_EN)" = 0 ] || fail "enabled again while $line is active"
  pull $line down
  eventually 3 equals level AMP_EN 1     # wait until station_lines has cleared the fault and armed again
done
awk '$1 == "fault" && ($3 < 0 || $3 > 1e6) { bad++ } END { exit bad > 0 }' station.txt || fail "its own reaction times: $(cat station.txt)"
grep ^fault station.txt
kill -KILL $station
eventually 1 equals level AMP_EN 0

# Test the command that the service runs after the station. If another process holds the line, the command
# does not wait, and says which process that is.
rig_with amplifier=gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB <"$SOURCE/deploy/rigs/simulated.toml" >rig.toml
gpio_line hold AMP_EN 1 >hold.txt & holder=$!
eventually 2 equals level AMP_EN 1
fails 1 turnpoint amplifier-off --rig rig.toml
has refusal.txt "AMP_EN: in use by bench"
kill -KILL $holder
eventually 2 turnpoint amplifier-off --rig rig.toml
[ "$(level AMP_EN)" = 0 ] || fail "AMP_EN is high after amplifier-off"
