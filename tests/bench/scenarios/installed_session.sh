# proves: a session under the installed unit, answered with buttons, plays the tones that its database lists; a stop, a clock jump, a lost sound card, a full disk and a kill lose no stored trial; the station never arms by itself
# needs: installed
# timeout: 900
gpio_sim AMP_EN AMP_FAULT STOP AMP_HB BTN_L BTN_R
for line in AMP_EN AMP_FAULT STOP AMP_HB BTN_L BTN_R; do pull $line down; done
loopback
udevadm settle
data=/var/lib/turnpoint db=/var/lib/turnpoint/lab.sqlite log=/run/session.log
# The self-test requires 200 MiB of free space. The disk is filled later.
mount -t tmpfs -o size=232M,mode=0750,uid="$(id -u turnpoint)",gid="$(id -g turnpoint)" data $data
rows() { sqlite3 -separator ' ' "file:$db?mode=ro" "$1"; }
rig_with output=alsa:hw:Loopback,0 amplifier=gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB buttons=gpio:left=BTN_L,right=BTN_R \
  </usr/share/turnpoint/rigs/simulated.toml >/etc/turnpoint/rig.toml

# station ARGUMENTS: starts the installed unit with these arguments. Buttons and the operator's keyboard
# replace the screen.
mkfifo /run/operator; exec 8<>/run/operator
drop_in=/run/systemd/system/turnpoint.service.d/bench.conf
mkdir ${drop_in%/*}
station() {
  printf '[Service]\nType=exec\nWatchdogSec=0\nRestart=no\nStandardInput=file:/run/operator\nStandardError=append:%s\nExecStart=\nExecStart=/usr/bin/turnpoint %s\n' \
    $log "$*" >$drop_in
  systemctl daemon-reload
  systemctl start turnpoint
}
lasts() { [ "$(systemctl show -P ActiveState turnpoint)" = active ]; }
# says TEXT: waits until the station prints this text. Output that an earlier call has read does not count.
read_so_far=0
said() {
  lasts || { cat $log; fail "the session ended before it printed: $1"; }
  local line; line=$(tail -n +$((read_so_far + 1)) $log | grep -n -m1 "$1" | cut -d: -f1)
  [ -n "$line" ] && read_so_far=$((read_so_far + line))
}
trap '[ $? = 0 ] || tail -n 20 $log' EXIT   # a failure shows what the station printed last
says() { eventually 60 said "$1"; }
operator() { echo "$1" >&8; }
on() { [ "$(level AMP_EN)" = 1 ]; }
off() { [ "$(level AMP_EN)" = 0 ]; }
press() { gpio_line press "$(pull_file "$1")" 50 >/dev/null; }
stored() { [ "$(rows "SELECT count(*) FROM trial")" = "$1" ]; }
stimulus() { says "^stimulus"; eventually 5 on; sleep 1; }
answer() { press BTN_R; eventually 5 off; }
armed() { operator arm; sleep 0.5; said "$1"; }   # tries to arm, and checks the station's reply

record 120 heard0.raw; recorder=$!
station run /usr/share/turnpoint/protocols/demo.toml --participant P01 --db $db --buttons-only --seed 3
says "arm or stop"
off || fail "the amplifier is on before the operator armed it"
operator arm
says "^instructions"
sleep 0.7; press BTN_L
stimulus; answer
eventually 20 stored 1
date -s "+2 hours" >/dev/null

say "the stop is pressed"
stimulus
near "time from the stop until the enable line is low (us)" "$(($(gpio_line until-low "$(pull_file STOP)" "$(line_of AMP_EN)/value") / 1000))" 0 1000
says "^fault: The emergency stop"
eventually 20 stored 2
off || fail "the amplifier is on while the stop is pressed"
pull STOP down
operator arm; says "^paused"; operator next

say "the sound card is unplugged and plugged in again"
stimulus
echo snd_aloop.0 >/sys/bus/platform/drivers/snd_aloop/unbind
eventually 1 off
says "^fault: The sound device"
eventually 20 stored 3
operator arm; sleep 0.5; off || fail "the amplifier is on without a sound card"
kill $recorder 2>/dev/null || true; wait $recorder || true
echo snd_aloop.0 >/sys/bus/platform/drivers/snd_aloop/bind
eventually 5 test -e /dev/snd/pcmC0D1c
record 120 heard1.raw; recorder=$!
eventually 30 armed "^paused"
operator next

say "the disk becomes full and is then freed"
stimulus
fallocate -l "$(($(df --output=avail -B1 $data | tail -1) - 65536))" $data/filler
dd if=/dev/zero of=$data/filler2 bs=4k status=none 2>/dev/null || true
answer
says "^fault: The disk is full"
off || fail "the amplifier is on while the disk is full"
stored 3 || fail "the number of stored trials changed while the disk was full"
rm $data/filler $data/filler2
operator next
eventually 20 stored 4

say "a second station wants the same database, while the session is paused; then the first is killed during a stimulus"
operator pause; says "^paused"
fails 1 turnpoint run /usr/share/turnpoint/protocols/demo.toml --rig /usr/share/turnpoint/rigs/simulated.toml --participant P02 \
  --db $db --headless --observer sim
has refusal.txt "pid $(systemctl show -P MainPID turnpoint)" || fail "the message does not name the process that uses the database"
operator next
stimulus
systemctl kill -s KILL turnpoint
eventually 1 off
kill $recorder; wait $recorder || true
[ "$(rows "PRAGMA integrity_check")" = ok ] || fail "the database is damaged"
[ "$(rows "SELECT group_concat(outcome, ' ') FROM trial")" = "answered fault fault answered" ] || fail "$(rows "SELECT * FROM trial")"
near "logged clock jumps" "$(rows "SELECT count(*) FROM event WHERE value LIKE '%wall clock was set by +7%'")" 1 0
[[ "$(rows "SELECT realtime_rights FROM session")" == "fifo 70, memory locked"* ]] || fail "$(rows "SELECT realtime_rights FROM session")"

# Compares each recorded stimulus with the tone in the database, in the order of presentation.
rows "SELECT tone.frequency_Hz FROM tone ORDER BY trial_index" >frequencies.txt
for k in 0 1; do python3 "$BENCH_SOURCE/guest/bursts.py" heard$k.raw burst$k 0.1; done
ls burst*.raw | head -4 | paste -d ' ' - frequencies.txt >pairs.txt
near "recorded stimuli, including the one during which the station was killed" "$(ls burst*.raw | wc -l)" 5 0
near "stimuli in the database" "$(wc -l <frequencies.txt)" 4 0
while read -r burst frequency; do
  read -r measured _ residual <<<"$(measure_tone "$burst" 192000 2 0)"
  near "$burst (Hz, residual $residual dB)" "$measured" "$frequency" 0.02
done <pairs.txt

say "the session is resumed and must not arm by itself"
systemctl reset-failed turnpoint
station resume --db $db --headless
says "arm or stop"
off || fail "a resumed session armed by itself"
operator stop
ended() { [ "$(systemctl show -P ActiveState turnpoint)" != active ]; }
eventually 30 ended
cat $log
[ "$(rows "PRAGMA integrity_check")" = ok ] || fail "the database is damaged"
