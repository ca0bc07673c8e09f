# proves: on a chip that keeps its outputs, the installed unit takes the amplifier's enable line low within 2 s of the station being killed, and within 13 s of it being frozen; this holds for the rig with which the station was started
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
  systemctl start turnpoint || { journalctl -u turnpoint --no-pager | tail -30; fail "the unit did not get ready"; }
  unlock
  sleep 0.5
  tap 150 215                       # choose the protocol "demo"
  tap 303 392                       # tap "enter it now"
  sleep 0.5
  tap 437 360; tap 736 240; tap 63 240; tap 700 425   # enter the participant's code P01
  hold 385 443                      # arm the amplifier
  tap 694 443                       # begin the session
  eventually 30 english; sleep 0.5; tap 400 150
  off || fail "on before the first stimulus"
  goes_on
  eventually 30 equals level AMP_EN 1
}
# seconds_to_off SIGNAL LIMIT: sends the signal to the station, and measures how long the enable line stays
# high.
seconds_to_off() {
  local station start; station=$(state MainPID) start=$(date +%s%N)
  kill -"$1" "$station"
  until off; do
    [ $(($(date +%s%N) - start)) -lt ${2}000000000 ] || return 1
    sleep 0.02
  done
  awk -v ns=$(($(date +%s%N) - start)) 'BEGIN { print ns / 1e9 }'
}

say "killed"
drives
seconds_to_off KILL 5 >seconds.txt || fail "killed, and AMP_EN stays high: $(journalctl -u turnpoint --no-pager | tail -5)"
near "killed: AMP_EN low after (s)" "$(cat seconds.txt)" 1 1
journalctl -u turnpoint --no-pager | grep 'amplifier off: gpio:enable=AMP_EN.*second.toml' || fail "amplifier-off says nothing in the journal"

say "frozen: the watchdog kills it"
drives
seconds_to_off STOP 20 >seconds.txt || fail "frozen, and AMP_EN stays high"
near "frozen: AMP_EN low after (s)" "$(cat seconds.txt)" 8 5
[ "$(level OTHER)" = 0 ] || fail "the other rig's line was touched"

say "the control: without what runs after the station, and without a restart, the line of this chip stays high"
mkdir -p /run/systemd/system/turnpoint.service.d
printf '[Service]\nRestart=no\nExecStopPost=\n' >/run/systemd/system/turnpoint.service.d/bench.conf
systemctl daemon-reload
drives
! seconds_to_off KILL 5 || fail "low without amplifier-off: this scenario shows nothing"
eventually 5 failed
turnpoint amplifier-off             # without --rig, this affects only the line of the installed rig
! off || fail "low without the rig that the station was started with"
turnpoint amplifier-off --locked --rig /etc/turnpoint/second.toml
off || fail "amplifier-off does not lower it"
