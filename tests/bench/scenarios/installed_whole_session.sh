# proves: a live session on the installed kiosk can be completed by touches and buttons, from the operator's page to the last answer, although panel, sound card and GPIO chip are unplugged for a while and the station hangs once and is killed once during a stimulus; every stimulus that was played has the boundary stored in the database
# needs: installed screen
# suite: long
# timeout: 1800
gpio_sim AMP_EN AMP_FAULT STOP AMP_HB BTN_L BTN_R
for line in AMP_EN AMP_FAULT STOP AMP_HB BTN_L BTN_R; do pull $line down; done
loopback
panel_begin
screen_begin
udevadm settle
db=/var/lib/turnpoint/turnpoint.sqlite
rows() { sqlite3 -separator ' ' "file:$db?mode=ro" "$1" 2>/dev/null || true; }

# Calibrate the rig for live sessions. The installed unit is changed only in its graphics settings, so that
# this script can read the pixels of the screen.
rig_with output=alsa:hw:Loopback,0 amplifier=gpio:enable=AMP_EN,fault=AMP_FAULT,stop=STOP,heartbeat=AMP_HB buttons=gpio:left=BTN_L,right=BTN_R "touch=evdev:$PANEL" \
  </usr/share/turnpoint/rigs/simulated.toml >/etc/turnpoint/rig.toml
calibrate_for_live /etc/turnpoint/rig.toml
printf 'QT_QPA_PLATFORM=linuxfb\nQT_QUICK_BACKEND=software\nQT_QPA_GENERIC_PLUGINS=evdevtouch\nQT_QPA_FB_DISABLE_INPUT=1\nTURNPOINT_DPI=132\n' \
  >/etc/turnpoint/environment
echo 'TURNPOINT_OPTIONS=--protocols /usr/share/turnpoint/protocols' >>/etc/turnpoint/environment
echo 2580 | turnpoint operator-code
[ "$(stat -c '%a %U %G' /etc/turnpoint/operator-code)" = '640 root turnpoint' ] || fail "the operator's code has the wrong mode, owner or group: $(stat -c '%a %U %G' /etc/turnpoint/operator-code)"
systemctl daemon-reload

on() { [ "$(level AMP_EN)" = 1 ]; }
off() { [ "$(level AMP_EN)" = 0 ]; }
stored() { [ "$(rows "SELECT count(*) FROM trial")" = "$1" ]; }
stimulus() { eventually 30 answers_open; eventually 5 on; sleep 0.8; echo "$1" >>presented.txt; }
by_touch() { stimulus stored; touch_do tap 200 370; eventually 5 off; eventually 10 stored "$1"; }
by_button() { stimulus stored; gpio_line press "$(pull_file BTN_R)" 50 >/dev/null; eventually 5 off; eventually 10 stored "$1"; }
# The operator's actions: `asked` taps "for the experimenter"; `arm` then enters the code and arms by a long
# press.
asked() { keypad || { tap 536 400; sleep 0.5; return 1; }; }   # a new page ignores taps for a moment, so try again
arm() { eventually 15 asked; operator_code; sleep 1; hold 536 400; }   # a new page ignores presses for a moment
carry_on() { sleep 0.7; tap 535 395; }

systemctl start turnpoint
eventually 30 keypad
sleep 0.3; tap 400 148; tap 280 216; tap 520 216; tap 400 284; tap 520 352   # 2468, the wrong code
sleep 0.5; keypad || fail "the station accepts 2468, although its code is 2580"
first=$(systemctl show -P MainPID turnpoint)
unlock
record 110 heard0.raw; recorder=$!
tap 200 287                       # choose the protocol "demo"
tap 382 395                       # tap "enter it now"
sleep 0.5; screenshot code
tap 481 355; tap 744 220; tap 146 220; tap 711 423   # enter the participant's code P01
tap 278 445                       # choose a live session
hold 450 445                      # arm the amplifier
screenshot chosen
off || fail "the amplifier is on before the session"
begins_pilot
eventually 20 english; sleep 0.5; tap 400 150
goes_on
by_touch 1
by_button 2
screenshot trial

say "the panel is unplugged and plugged in again"
stimulus stored
touch_do gone
eventually 10 stored 3
eventually 5 off
sleep 1; screenshot panel_gone
before=$PANEL
panel_begin
[ "$PANEL" = "$before" ] || fail "the panel got another device name, $PANEL instead of $before"
carry_on

say "the sound card is unplugged and plugged in again"
stimulus stored
echo snd_aloop.0 >/sys/bus/platform/drivers/snd_aloop/unbind
eventually 1 off
eventually 10 stored 4
kill $recorder 2>/dev/null || true; wait $recorder || true
echo snd_aloop.0 >/sys/bus/platform/drivers/snd_aloop/bind
eventually 5 test -e /dev/snd/pcmC0D1c
record 140 heard1.raw; recorder=$!
sleep 1
off || fail "the station armed itself"
arm; screenshot dac_back
carry_on
by_touch 5

say "the GPIO chip is unplugged and plugged in again"
stimulus stored
echo 0 >/sys/kernel/config/gpio-sim/bench/live
eventually 10 stored 6
sleep 0.5
arm; screenshot chip_gone
echo 1 >/sys/kernel/config/gpio-sim/bench/live
GPIO_DEVICE=$(echo /sys/devices/platform/gpio-sim.*/gpiochip*)
for line in AMP_EN AMP_FAULT STOP AMP_HB BTN_L BTN_R; do pull $line down; done
sleep 0.5
off || fail "the station armed itself"
hold 536 400; screenshot chip_back
carry_on
by_button 7
by_touch 8

say "the station hangs during a stimulus; the watchdog ends it, and it restarts unarmed"
stimulus lost
kill -STOP "$first"
eventually 15 off
unlock
journalctl -u turnpoint --no-pager | grep -i "watchdog timeout" || fail "the station was ended, but not by the watchdog: $(journalctl -u turnpoint --no-pager | tail -5)"
sleep 0.5; screenshot interrupted
tap 738 83
eventually 10 shows 440 375
off || fail "a resumed session armed by itself"
arm
goes_on
by_touch 9

say "the station is killed during a stimulus"
stimulus lost
systemctl kill -s KILL turnpoint
eventually 1 off
unlock
sleep 0.5
hold 450 445
tap 738 83
goes_on
by_button 10; by_touch 11; by_button 12; by_touch 13
sleep 2; screenshot end
completed() { [ "$(rows "SELECT status FROM session")" = completed ]; }
eventually 10 completed
off || fail "the amplifier is on after the session"
tap 560 390; sleep 0.5; operator_code
eventually 10 start_page
kill $recorder; wait $recorder || true
[ "$(rows "PRAGMA integrity_check")" = ok ] || fail "the database is damaged"
screenshot start_page

# Check each stored answer, its device and its time. Touches chose the left answer, buttons the right one.
near "restarts" "$(systemctl show -P NRestarts turnpoint)" 2 0
near "sessions" "$(rows "SELECT count(*) FROM session WHERE run_mode = 'live'")" 1 0
[ "$(rows "SELECT group_concat(coalesce(response, outcome), ' ') FROM trial")" = \
  "left right fault fault left fault right left left right left right left" ] || fail "$(rows "SELECT * FROM trial")"
near "answers with the kernel's time" "$(rows "SELECT count(*) FROM trial WHERE response_time_quality = 'kernel'")" 10 0
near "presses" "$(rows "SELECT count(*) FROM event WHERE kind = 'button'")" 4 0
near "refused attempts to arm" "$(rows "SELECT count(*) FROM event WHERE kind = 'arm' AND value LIKE 'refused: GPIO lines disconnected%'")" 1 0
near "successful attempts to arm" "$(rows "SELECT count(*) FROM event WHERE kind = 'arm' AND value = 'armed'")" 5 0

# Split the recording into bursts. installed_whole_session.after checks them outside the guest, which is
# faster.
for k in 0 1; do python3 "$BENCH_SOURCE/guest/bursts.py" heard$k.raw "$OUT/burst$k."; done
cp presented.txt /etc/turnpoint/rig.toml "$OUT"
rows "SELECT frequency_Hz, boundary_mm, model FROM tone ORDER BY trial_index" >"$OUT/rows.txt"
