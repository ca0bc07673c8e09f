# proves: with the unchanged installed unit on eglfs, a participant completes a session by touches alone, which Qt reads with libinput; after the panel was unplugged and plugged in again it works; a mouse does not bring a pointer onto the screen
# needs: installed screen
# timeout: 1200
panel_begin
screen_begin
udevadm settle
db=/var/lib/turnpoint/turnpoint.sqlite
rows() { sqlite3 -separator ' ' "file:$db?mode=ro" "$1" 2>/dev/null || true; }
stored() { [ "$(rows "SELECT count(*) FROM trial")" = "$1" ]; }

# Set only what every station needs: its rig, its operator's code, and the size of the panel, which does not
# report it. Turn off the hardware cursor, so that screenshots show a mouse pointer if there is one.
rig_with "touch=evdev:bench touch panel" </usr/share/turnpoint/rigs/simulated.toml >/etc/turnpoint/rig.toml
echo '{"device": "/dev/dri/card0", "hwcursor": false}' >/etc/turnpoint/kms.json
printf 'TURNPOINT_DPI=132\nQT_QPA_EGLFS_KMS_CONFIG=/etc/turnpoint/kms.json\n' >/etc/turnpoint/environment
echo 'TURNPOINT_OPTIONS=--protocols /usr/share/turnpoint/protocols' >>/etc/turnpoint/environment
echo 2580 | turnpoint operator-code
station() { systemctl restart turnpoint || { journalctl -u turnpoint --no-pager | tail -30; fail "turnpoint.service did not start"; }; }
mount -t debugfs debugfs /sys/kernel/debug
drawn_by() { has /sys/kernel/debug/dri/0/state "allocated by = $1"; }
shows_no_pointer() {
  sleep 1
  local before; before=$(kms_screen | sha256sum)
  touch_do mouse 30 30
  sleep 1.5
  [ "$(kms_screen | sha256sum)" = "$before" ] || { screenshot pointer; fail "moving a mouse changes the screen, probably by a pointer"; }
}

station
drawn_by QSGRenderThread || fail "the screen is not drawn by eglfs"
eventually 30 keypad
shows_no_pointer
unlock
sleep 0.5; screenshot start_page
tap 200 287                       # choose the protocol "demo"
tap 382 395                       # tap "enter it now"
sleep 0.5
tap 481 355; tap 744 220; tap 146 220; tap 711 423   # enter the participant's code P01
screenshot chosen
hold 450 445                      # arm the amplifier
begins_pilot
eventually 30 english; sleep 0.5; tap 400 150
goes_on
by_touch() { eventually 30 answers_open; sleep 1; touch_do tap 200 370; eventually 20 stored "$1"; }
for trial in 1 2 3; do by_touch $trial; done
screenshot trial

say "the panel is unplugged and plugged in again"
eventually 30 answers_open
touch_do gone
eventually 10 stored 4            # the fault makes the fourth trial void; it will be repeated
panel_begin
sleep 1.5; tap 535 395
for trial in 5 6 7 8 9 10 11; do by_touch $trial; done
completed() { [ "$(rows "SELECT status FROM session")" = completed ]; }
eventually 10 completed
[ "$(rows "SELECT group_concat(coalesce(response, outcome), ' ') FROM trial")" = \
  "left left left fault left left left left left left left" ] || fail "$(rows "SELECT * FROM trial")"
near "answers with the kernel's time" "$(rows "SELECT count(*) FROM trial WHERE response_time_quality = 'kernel'")" 10 0

say "the same unit draws on the frame buffer"
printf 'QT_QPA_PLATFORM=linuxfb\nQT_QUICK_BACKEND=software\n' >>/etc/turnpoint/environment
station
eventually 30 keypad
! drawn_by QSGRenderThread || fail "the screen is drawn by eglfs although linuxfb is set"
shows_no_pointer
unlock

say "the doctor reports that the service may only read the input devices"
# Run the doctor by a unit file, because systemd-run needs a message bus, which the guest does not have.
doctor() {
  cat >/run/systemd/system/bench-doctor.service <<UNIT
[Service]
Type=oneshot
User=turnpoint
SupplementaryGroups=input
DevicePolicy=closed
DeviceAllow=char-input $1
StandardOutput=truncate:/run/doctor.txt
StandardError=null
ExecStart=-/usr/bin/turnpoint doctor --rig /etc/turnpoint/rig.toml --data /var/lib/turnpoint
UNIT
  systemctl daemon-reload
  systemctl start bench-doctor
  cp /run/doctor.txt doctor.txt
  grep -A1 "^input devices" doctor.txt
}
doctor rw; has doctor.txt "^input devices *ok"
doctor r; has doctor.txt "^input devices *failed.*/dev/input/event0: Operation not permitted"
