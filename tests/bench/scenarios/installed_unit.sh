# proves: the installed unit starts under systemd on eglfs, is hardened, listens on no network port and can be stopped; purging the package keeps the lab's data
# needs: installed screen
# timeout: 900
state() { systemctl show -P "$1" turnpoint; }
journal() { journalctl -u turnpoint --no-pager; }
panel_begin
# Simulate a board whose first graphics card has no screen. The screen is at the second card.
# Unload the screen's driver if udev has loaded it already; cards are numbered in the order of their drivers.
modprobe -r bochs 2>/dev/null || true
modprobe vgem
eventually 5 test -e /dev/dri/card0
screen_begin
[ -e /sys/class/drm/card1-Virtual-1 ] || fail "the screen is not at the second graphics card: $(ls /sys/class/drm)"
# Before an operator's code is stored, the station must not start, and must say how to store one.
systemctl start --no-block turnpoint
refused() { journal | grep -q 'store one with: sudo turnpoint operator-code'; }
eventually 30 refused
echo 7391 | turnpoint operator-code
systemctl stop turnpoint
# Start the unit as installed. It uses eglfs on kernel mode setting and renders in software, because there is
# no GPU.
systemctl start turnpoint || { journal | tail -30; fail "turnpoint.service did not start on eglfs"; }
mount -t debugfs debugfs /sys/kernel/debug
sed -n '/^plane/,/^crtc/p' /sys/kernel/debug/dri/1/state >shown.txt
{ has shown.txt "allocated by = QSGRenderThread" && has shown.txt "size=800x480"; } || fail "the station does not draw on the whole screen: $(cat shown.txt)"
[ "$(state ActiveState)/$(state SubState)" = active/running ] || fail "turnpoint.service is $(state ActiveState)/$(state SubState), not active/running"
first=$(state MainPID)
say "ready after $(($(state ActiveEnterTimestampMonotonic) / 1000 - $(state ExecMainStartTimestampMonotonic) / 1000)) ms of virtual time"
ps -o user=,rss=,args= -p "$first"
[ "$(ps -o user= -p "$first")" = turnpoint ] || fail "the station runs as $(ps -o user= -p "$first")"

score=$(systemd-analyze security turnpoint --no-pager | awk '/Overall exposure/ { print $(NF - 2) }')
near "exposure by systemd-analyze security" "$score" 0.75 0.75
[ -z "$(ss -H -l -n -t -u -p | grep -v 'AF_NETLINK' || true)" ] || fail "a program listens on a network port: $(ss -H -lntup)"

# Stopping the unit must succeed, on its first page and while it starts. systemd must not count it as failed.
stops() { systemctl stop turnpoint; [ "$(state Result)" = success ] || fail "after a stop $1, systemd's result is $(state Result), not success"; }
stops "on its first page"
systemctl start --no-block turnpoint
sleep 0.5
stops "while it started"

# Purging the package must remove the station but keep the lab's data, unless TURNPOINT_PURGE_DATA=yes.
db=/var/lib/turnpoint/turnpoint.sqlite
cp /usr/share/turnpoint/rigs/simulated.toml /etc/turnpoint/rig.toml
runuser -u turnpoint -- turnpoint run /usr/share/turnpoint/protocols/demo.toml --participant P01 --db $db --headless --observer sim
systemctl start --no-block turnpoint
dpkg --purge turnpoint | tee purged.txt
has purged.txt "data in /var/lib/turnpoint were kept" || fail "the purge does not say that the data were kept"
[ "$(state MainPID)" = 0 ] || fail "the station still runs after the purge"
[ -e $db ] && [ -e /etc/turnpoint/rig.toml ] || fail "the purge removed the database or the rig file without TURNPOINT_PURGE_DATA=yes"
! command -v turnpoint >/dev/null || fail "the program turnpoint is still installed after the purge"
dpkg -i "$SOURCE/build/roots/station.build/turnpoint.deb"
[ -e $db ] || fail "installing the package again removed the database"
TURNPOINT_PURGE_DATA=yes dpkg --purge turnpoint
[ ! -e /var/lib/turnpoint ] && [ ! -e /etc/turnpoint ] || fail "the data are still there although TURNPOINT_PURGE_DATA=yes"
