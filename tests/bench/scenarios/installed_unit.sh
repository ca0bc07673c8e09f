# proves: the installed unit starts under systemd on eglfs, is hardened, listens on no network port, can be stopped, and purging the package keeps the lab's data
# needs: installed screen
# timeout: 900
state() { systemctl show -P "$1" turnpoint; }
journal() { journalctl -u turnpoint --no-pager; }
panel_begin
# Simulates a board whose first graphics card has no screen; the screen is at the second one.
modprobe vgem
eventually 5 test -e /dev/dri/card0
screen_begin
[ -e /sys/class/drm/card1-Virtual-1 ] || fail "not at the second card: $(ls /sys/class/drm)"
# Without an operator's code of its own, the station must not start, and must say how to store one.
systemctl start --no-block turnpoint
refused() { journal | grep -q 'store one with: sudo turnpoint operator-code'; }
eventually 30 refused
echo 7391 | turnpoint operator-code
systemctl stop turnpoint
# Starts the unit as installed: eglfs on kernel mode setting, rendered in software because there is no GPU.
systemctl start turnpoint || { journal | tail -30; fail "the unit did not get ready on eglfs"; }
mount -t debugfs debugfs /sys/kernel/debug
sed -n '/^plane/,/^crtc/p' /sys/kernel/debug/dri/1/state >shown.txt
{ has shown.txt "allocated by = QSGRenderThread" && has shown.txt "size=800x480"; } || fail "not on the screen: $(cat shown.txt)"
[ "$(state ActiveState)/$(state SubState)" = active/running ] || fail "it is $(state ActiveState)"
first=$(state MainPID)
say "ready after $(($(state ActiveEnterTimestampMonotonic) / 1000 - $(state ExecMainStartTimestampMonotonic) / 1000)) ms of virtual time"
ps -o user=,rss=,args= -p "$first"
[ "$(ps -o user= -p "$first")" = turnpoint ] || fail "it runs as $(ps -o user= -p "$first")"

score=$(systemd-analyze security turnpoint --no-pager | awk '/Overall exposure/ { print $(NF - 2) }')
near "exposure" "$score" 0.75 0.75
[ -z "$(ss -H -l -n -t -u -p | grep -v 'AF_NETLINK' || true)" ] || fail "something listens: $(ss -H -lntup)"

# The unit can be stopped both on its first page and while it starts, and then does not count as failed.
stops() { systemctl stop turnpoint; [ "$(state Result)" = success ] || fail "stopped $1, it ended as $(state Result)"; }
stops "on its first page"
systemctl start --no-block turnpoint
sleep 0.5
stops "while it started"

# Removing and purging the package removes the station, but keeps the lab's data unless asked otherwise.
db=/var/lib/turnpoint/turnpoint.sqlite
cp /usr/share/turnpoint/rigs/simulated.toml /etc/turnpoint/rig.toml
runuser -u turnpoint -- turnpoint run /usr/share/turnpoint/protocols/demo.toml --participant P01 --db $db --headless --observer sim
systemctl start --no-block turnpoint
dpkg --purge turnpoint | tee purged.txt
has purged.txt "data in /var/lib/turnpoint were kept" || fail "it does not say that the data are kept"
[ "$(state MainPID)" = 0 ] || fail "purged, and it still runs"
[ -e $db ] && [ -e /etc/turnpoint/rig.toml ] || fail "purge has removed data that nobody asked to remove"
! command -v turnpoint >/dev/null || fail "purged, and turnpoint is still there"
dpkg -i "$SOURCE/build/roots/station.build/turnpoint.deb"
[ -e $db ] || fail "installing anew has lost the data"
TURNPOINT_PURGE_DATA=yes dpkg --purge turnpoint
[ ! -e /var/lib/turnpoint ] && [ ! -e /etc/turnpoint ] || fail "asked for, and the data are still there"
