# proves: the installed unit gets ready under systemd, on eglfs and on the frame buffer, is hardened, listens nowhere, and is restarted when it hangs or dies; a session by touches under it outlives a lost panel
# needs: installed screen
# timeout: 900
state() { systemctl show -P "$1" turnpoint; }
journal() { journalctl -u turnpoint --no-pager; }
panel_begin
screen_begin
# As it is installed: eglfs on the kernel's mode setting, drawn by software for want of a GPU.
systemctl start turnpoint || { journal | tail -30; fail "the unit did not get ready on eglfs"; }
mount -t debugfs debugfs /sys/kernel/debug
sed -n '/^plane/,/^crtc/p' /sys/kernel/debug/dri/0/state >shown.txt
{ has shown.txt "allocated by = QSGRenderThread" && has shown.txt "size=800x480"; } || fail "not on the screen: $(cat shown.txt)"
systemctl stop turnpoint

# The rest on the frame buffer, whose pixels can be read.
mkdir -p /etc/turnpoint
printf 'QT_QPA_PLATFORM=linuxfb\nQT_QUICK_BACKEND=software\nQT_QPA_GENERIC_PLUGINS=evdevtouch\nQT_QPA_FB_DISABLE_INPUT=1\nTURNPOINT_DPI=132\n' \
  >/etc/turnpoint/environment
systemctl daemon-reload
systemctl start turnpoint || { journal | tail -30; fail "the unit did not get ready"; }
[ "$(state ActiveState)/$(state SubState)" = active/running ] || fail "it is $(state ActiveState)"
first=$(state MainPID)
say "ready after $(($(state ActiveEnterTimestampMonotonic) / 1000 - $(state ExecMainStartTimestampMonotonic) / 1000)) ms of virtual time"
screenshot start_page
ps -o user=,rss=,args= -p "$first"
[ "$(ps -o user= -p "$first")" = turnpoint ] || fail "it runs as $(ps -o user= -p "$first")"

score=$(systemd-analyze security turnpoint --no-pager | awk '/Overall exposure/ { print $(NF - 2) }')
near "exposure" "$score" 0.75 0.75
[ -z "$(ss -H -l -n -t -u -p | grep -v 'AF_NETLINK' || true)" ] || fail "something listens: $(ss -H -lntup)"

kill -STOP "$first"      # hangs: the watchdog's 10 s, then a second
restarted() { [ "$(state MainPID)" != "$first" ] && [ "$(state ActiveState)" = active ]; }
eventually 60 restarted
journal | grep -i "watchdog timeout" || fail "it was not the watchdog: $(journal | tail -5)"
first=$(state MainPID)
kill -KILL "$first"
eventually 30 restarted
near "restarts" "$(state NRestarts)" 2 0

# A session on the same screen, under the same rights, by touches alone.
db=/var/lib/turnpoint/lab.sqlite
sed "/^\[touch\]/,/^uri/ s|^uri.*|uri = \"evdev:$PANEL\"|" /usr/share/turnpoint/rigs/simulated.toml >/etc/turnpoint/rig.toml
cp "$SOURCE/tests/ui/short.toml" /etc/turnpoint/short.toml
mkdir /run/systemd/system/turnpoint.service.d
printf '[Service]\nType=exec\nWatchdogSec=0\nRestart=no\nExecStart=\nExecStart=/usr/bin/turnpoint run /etc/turnpoint/short.toml --participant P01 --db %s --seed 1\n' \
  $db >/run/systemd/system/turnpoint.service.d/session.conf
systemctl daemon-reload
systemctl restart turnpoint
action=5c3d0f
answers_open() { [ "$(pixel 60 400)" = $action ] && [ "$(pixel 740 400)" = $action ]; }
continues() { [ "$(pixel 290 390)" = $action ] && [ "$(pixel 60 400)" != $action ]; }
trials() { sqlite3 "file:$db?mode=ro" "SELECT group_concat(outcome, ' ') FROM trial" 2>/dev/null || true; }
answer() { eventually 30 answers_open; sleep 0.5; touch_do tap 200 370; eventually 10 equals trials "" "$1"; }
goes_on() { eventually 60 continues; sleep 0.7; touch_do tap 400 390; }
language_page() { [ "$(pixel 200 200)" = $action ]; }
eventually 60 language_page
sleep 0.7; touch_do tap 400 210
goes_on
answer "answered"
eventually 30 answers_open
touch_do gone
eventually 10 equals trials "" "answered fault"
sleep 1; screenshot panel_gone
[ "$(pixel 440 390)" = $action ] || fail "no way on from the page that says so"
before=$PANEL
panel_begin
[ "$PANEL" = "$before" ] || fail "it came back as $PANEL"
sleep 1; touch_do tap 535 390
goes_on
answer "answered fault answered"

# Removed and purged, the station is gone, and the lab's data are not, unless they are asked for.
rm -r /run/systemd/system/turnpoint.service.d
dpkg --purge turnpoint | tee purged.txt
has purged.txt "data in /var/lib/turnpoint are kept" || fail "it does not say that the data are kept"
[ "$(state MainPID)" = 0 ] || fail "purged, and it still runs"
[ -e $db ] && [ -e /etc/turnpoint/rig.toml ] || fail "purge has removed data that nobody asked to remove"
! command -v turnpoint >/dev/null || fail "purged, and turnpoint is still there"
dpkg -i "$SOURCE/build/roots/station.build/turnpoint.deb"
[ -e $db ] || fail "installing anew has lost the data"
TURNPOINT_PURGE_DATA=yes dpkg --purge turnpoint
[ ! -e /var/lib/turnpoint ] && [ ! -e /etc/turnpoint ] || fail "asked for, and the data are still there"
