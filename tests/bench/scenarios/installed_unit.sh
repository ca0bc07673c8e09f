# proves: the installed unit gets ready under systemd, is hardened, listens nowhere, and is killed and restarted when it hangs or dies
# needs: installed screen
# timeout: 900
state() { systemctl show -P "$1" turnpoint; }
panel_begin
screen_begin
mkdir -p /etc/turnpoint
printf 'QT_QPA_PLATFORM=linuxfb\nQT_QUICK_BACKEND=software\nQT_QPA_FB_DISABLE_INPUT=1\n' >/etc/turnpoint/environment
systemctl daemon-reload
systemctl start turnpoint || { journalctl -u turnpoint --no-pager | tail -30; fail "the unit did not get ready"; }
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
journalctl -u turnpoint --no-pager | grep -i "watchdog timeout" || fail "it was not the watchdog: $(journalctl -u turnpoint --no-pager | tail -5)"
first=$(state MainPID)
kill -KILL "$first"
eventually 30 restarted
near "restarts" "$(state NRestarts)" 2 0
