# proves: force cells on a converter of the kernel's subsystem IIO are read at 1 kHz without a lost sample and with the right values at the right times; five samples that the converter leaves out are found exactly; an unplugged converter is noticed; wrong names and missing rights are named
# timeout: 400
modprobe uhid; modprobe hid-sensor-hub; modprobe hid-sensor-accel-3d
hid_sensor 1000 >sensor.txt & sensor=$!
eventually 10 test -e /dev/iio:device0

# Names: what there is instead.
fails 3 cell_samples ad7124-4 1000 1 accel_x accel_y accel_z
has refusal.txt "iio:ad7124-4: there is no such device; there are: accel_3d" || fail "the devices are not named"
fails 3 cell_samples accel_3d 1000 1 accel_x accel_y voltage0
has refusal.txt 'there is no channel "voltage0"; there are: accel_x, accel_y, accel_z' || fail "the channels are not named"

# Rights: those that the udev rule gives the group are enough.
unprivileged() { setpriv --reuid=nobody --regid=nogroup --groups="${group:-nogroup}" "$(command -v cell_samples)" "$@"; }
fails 3 unprivileged accel_3d 1000 1 accel_x accel_y accel_z
has refusal.txt "which rights are needed.*Permission denied" || fail "the missing rights are not named"
getent group iio >/dev/null || groupadd --system iio
rule=$(sed -n "s|^SUBSYSTEM==\"iio\".*RUN+=\"/bin/sh -c '\(.*\)'\"$|\1|p" "$SOURCE/deploy/system/turnpoint.udev")
rule=${rule//%p/$(udevadm info -q path -n /dev/iio:device0 2>/dev/null || readlink -f /sys/bus/iio/devices/iio:device0 | sed s,^/sys,,)}
bash -c "${rule//\$\$/\$}"
chgrp iio /dev/iio:device0; chmod 660 /dev/iio:device0
group=iio unprivileged accel_3d 1000 1 accel_x accel_y accel_z >allowed.txt || fail "the rights of the rule are not enough: $(cat allowed.txt)"

# The doctor's row. Without a sound card it finds other faults.
sed -e '/^\[output\]/,/^uri/ s|^uri.*|uri = "alsa:hw:CARD=none"|' "$SOURCE/deploy/rigs/simulated-forces.toml" |
  sed -e '/^\[capture\]/,/^uri/ s|^uri.*|uri = "alsa:hw:CARD=none"|' -e '/^bridges/d' >rig.toml
printf '[force_cells]\nuri = "iio:accel_3d"\na = "accel_x"\nb = "accel_y"\nlateral = "accel_z"\nrate_Hz = 1000\n' >>rig.toml
fails 1 turnpoint doctor --rig rig.toml
grep "force converter" refusal.txt | tee row.txt
has row.txt "iio:accel_3d: [0-9.]* samples a second on accel_x, accel_y, accel_z, 0 lost, 0 time stamps out of order" || fail "the doctor has no row"

# Samples and their times. The driver turns the sensor off 3 s after the last use, and then on again.
sleep 5
cell_samples accel_3d 1000 8 accel_x accel_y accel_z >cells.txt & reader=$!
three_seconds() { [ "$(grep -c ^point cells.txt)" -gt 3000 ]; }
eventually 60 three_seconds
kill -USR1 $sensor
wait $reader
tail -1 cells.txt; cp cells.txt sensor.txt "$OUT"
start=$(awk '$1 == "on" { at = $2 } END { print at }' sensor.txt)
first=$(awk '$1 == "left" { print $3 }' sensor.txt)
read -r _ samples _ lost _ gaps _ disorder _ rate <<<"$(tail -1 cells.txt)"
[ "$lost/$gaps/$disorder" = 5/1/0 ] || fail "lost $lost samples in $gaps gaps, $disorder stamps out of order; expected 5 in 1, and 0"
near "rate (Hz)" "$rate" 1000 0.5
[ "$samples" -gt 7000 ] || fail "only $samples samples in 8 s"
# One per second, and half of that with the other sign; each point at its time. A stamp alone is up to 0.1 ms off.
awk -v start="$start" -v first="$first" '$1 == "point" {
    t = ($2 - start) / 1e9
    if (n++ > 300) { e = $3 - t; if (e < 0) e = -e; if (e > largest) largest = e }
    d = $3 + 2 * $4; if (d < 0) d = -d; if (d > unequal) unequal = d
    if ($5 < 0.00699999 || $5 > 0.00700001) wrong++
    if (last && $2 - last > 1500000) { holes++; missing = ($2 - last) / 1e6 - 1; hole = (last - start) / 1e6; end = ($2 - start) / 1e6 }
    last = $2
  } END {
    printf "points %d, largest error %.9f s, a + 2 b %.9f, wrong %d, holes %d: %d points after %.3f ms until %.3f ms, left out from %d\n", n, largest, unequal, wrong, holes, missing, hole, end, first
    exit !(n > 7000 && largest < 3e-5 && unequal < 1e-6 && !wrong && holes == 1 && missing == 7 && hole < first && hole > first - 3 && end > first + 4 && end < first + 7) }' cells.txt ||
  fail "the points are not those of the sensor"

# Unplugged while it is read, and plugged in again.
cell_samples accel_3d 1000 60 accel_x accel_y accel_z >gone.txt & reader=$!
eventually 10 has gone.txt ^point
kill $sensor
status=0; wait $reader || status=$?
tail -2 gone.txt
[ $status -eq 3 ] && has gone.txt "^iio:accel_3d: .*No such device" || fail "the loss of the converter was not noticed (exit status $status)"
fails 3 cell_samples accel_3d 1000 1 accel_x accel_y accel_z
has refusal.txt "iio:accel_3d: there is no such device" || fail "the missing device is not named"
hid_sensor 1000 >again.txt &
eventually 10 test -e /dev/iio:device0
cell_samples accel_3d 1000 2 accel_x accel_y accel_z >back.txt
has back.txt "lost 0 gaps 0 disorder 0" || fail "after it was plugged in again: $(tail -1 back.txt)"
