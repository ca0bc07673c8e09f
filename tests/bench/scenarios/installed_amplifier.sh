# proves: on a chip that keeps its outputs, the installed unit takes the amplifier's enable line low within 2 s after the station is killed, and within 13 s after it is frozen; the line is that of the rig with which the station was started
# needs: installed screen
# timeout: 1800
gpio_sim AMP_EN AMP_FAULT STOP AMP_HB OTHER
for line in AMP_EN AMP_FAULT STOP AMP_HB OTHER; do pull $line down; done
keep_outputs Y
panel_begin
screen_begin
udevadm settle

# The installed rig file names a different enable line than the rig with which the station is started.
rig_with "touch=evdev:bench touch panel" amplifier=gpio:enable=OTHER </usr/share/turnpoint/rigs/simulated.toml >/etc/turnpoint/rig.toml
rig_with "touch=evdev:bench touch panel" amplifier=gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB \
  </usr/share/turnpoint/rigs/simulated.toml >/etc/turnpoint/second.toml
cat >/etc/turnpoint/environment <<'CONF'
TURNPOINT_DPI=132
QT_QPA_PLATFORM=linuxfb
QT_QUICK_BACKEND=software
TURNPOINT_OPTIONS=--protocols /usr/share/turnpoint/protocols --rig /etc/turnpoint/second.toml --db /var/lib/turnpoint/second.sqlite
CONF
echo 2580 | turnpoint operator-code
state() { systemctl show -P "$1" turnpoint; }
off() { [ "$(level AMP_EN)" = 0 ]; }
failed() { [ "$(state ActiveState)" = failed ]; }

# drives: starts a session by touch, arms it, and waits until its first stimulus enables the amplifier.
drives() {
  systemctl stop turnpoint
  rm -f /var/lib/turnpoint/second.sqlite*
  systemctl start turnpoint || { journalctl -u turnpoint --no-pager | tail -30; fail "turnpoint.service did not start"; }
  unlock
  sleep 0.5
  tap 200 287                       # choose the protocol "demo"
  tap 382 395                       # tap "enter it now"
  sleep 0.5
  tap 481 355; tap 744 220; tap 146 220; tap 711 423   # enter the participant's code P01
  hold 450 445                      # arm the amplifier
  begins_pilot
  eventually 30 english; sleep 0.5; tap 400 150
  off || fail "the amplifier is on before the first stimulus"
  goes_on
  eventually 30 equals level AMP_EN 1
}
# seconds_to_off SIGNAL LIMIT: sends SIGNAL to the station and prints how many seconds the enable line stays
# high. Returns 1 if the line is still high after LIMIT seconds.
seconds_to_off() {
  local station start; station=$(state MainPID) start=$(date +%s%N)
  kill -"$1" "$station"
  until off; do
    [ $(($(date +%s%N) - start)) -lt ${2}000000000 ] || return 1
    sleep 0.02
  done
  awk -v ns=$(($(date +%s%N) - start)) 'BEGIN { print ns / 1e9 }'
}

say "the station is killed"
drives
seconds_to_off KILL 5 >seconds.txt || fail "AMP_EN is still high 5 s after the station was killed: $(journalctl -u turnpoint --no-pager | tail -5)"
near "seconds from the kill until AMP_EN is low" "$(cat seconds.txt)" 1 1
journalctl -u turnpoint --no-pager | grep 'amplifier off: gpio:enable=AMP_EN.*second.toml' || fail "amplifier-off wrote no message to the journal"

say "the station is frozen, and the watchdog kills it"
drives
seconds_to_off STOP 20 >seconds.txt || fail "AMP_EN is still high 20 s after the station was frozen"
near "seconds from the freeze until AMP_EN is low" "$(cat seconds.txt)" 8 5
[ "$(level OTHER)" = 0 ] || fail "OTHER, the enable line of the installed rig, is not low"

say "negative control: without ExecStopPost and without a restart, the line of this chip must stay high"
mkdir -p /run/systemd/system/turnpoint.service.d
printf '[Service]\nRestart=no\nExecStopPost=\n' >/run/systemd/system/turnpoint.service.d/bench.conf
systemctl daemon-reload
drives
! seconds_to_off KILL 5 || fail "AMP_EN goes low without amplifier-off, so this scenario proves nothing"
eventually 5 failed
turnpoint amplifier-off             # without --rig, this affects only the enable line of the installed rig
! off || fail "amplifier-off without --rig changed AMP_EN, which belongs to another rig"
turnpoint amplifier-off --locked --rig /etc/turnpoint/second.toml
off || fail "amplifier-off with the station's rig left AMP_EN high"
