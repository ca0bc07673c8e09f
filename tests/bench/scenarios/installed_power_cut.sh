# proves: if the power fails at any moment of a session under the installed unit, no committed trial is lost, and `turnpoint resume` completes the session
# needs: installed disk
# timeout: 400
data=/var/lib/turnpoint
disk_begin $data
chown turnpoint: $data
watch_rows $data/station.sqlite trial /dev/vda & watcher=$!
mkdir /run/systemd/system/turnpoint.service.d
cat >/run/systemd/system/turnpoint.service.d/session.conf <<END
[Service]
Type=oneshot
WatchdogSec=0
Restart=no
ExecStart=
ExecStart=/usr/bin/turnpoint run /usr/share/turnpoint/protocols/demo.toml --rig /usr/share/turnpoint/rigs/simulated.toml \
  --participant P01 --db $data/station.sqlite --headless --observer sim --seed 1
END
systemctl daemon-reload
systemctl start turnpoint || { journalctl -u turnpoint --no-pager; fail "the session failed"; }
sleep 0.1
kill $watcher
mkdir "$OUT/whole"; cp $data/station.sqlite* "$OUT/whole/"
