# proves: with its drop-in, the installed unit may start and read a converter of the kernel's subsystem IIO; without it, /sys is read-only
# needs: installed
# timeout: 900
modprobe uhid; modprobe hid-sensor-hub; modprobe hid-sensor-accel-3d
hid_sensor 1000 >sensor.txt &
eventually 10 test -e /dev/iio:device0
udevadm settle
sed -e '/^\[capture\]/,/^uri/ s|^uri.*|uri = "alsa:hw:CARD=none"|' -e '/^bridges/d' /usr/share/turnpoint/rigs/simulated-forces.toml >/run/rig.toml
printf '[force_cells]\nuri = "iio:accel_3d"\na = "accel_x"\nb = "accel_y"\nlateral = "accel_z"\nrate_Hz = 1000\n' >>/run/rig.toml
# examine FILE...: runs the doctor with what these unit files allow, and prints its row of the converter.
examine() {
  local line arguments=()
  while read -r line; do arguments+=(-p "$line"); done < <(
    grep -hE '^(User|Group|SupplementaryGroups|Device|Protect|Private|ReadWritePaths|NoNewPrivileges|Capability|Restrict|LockPersonality|SystemCall)' "$@")
  systemd-run -q --wait --pipe "${arguments[@]}" turnpoint doctor --rig /run/rig.toml >found.txt 2>&1 || true
  grep "force converter" found.txt || { cat found.txt; fail "the doctor has no row of the converter"; }
}
unit=$(systemctl show -P FragmentPath turnpoint)
examine "$unit" | tee refused.txt
grep -qE "Read-only file system|Permission denied" refused.txt || fail "the unit alone may already use the converter"
examine "$unit" /usr/share/turnpoint/system/iio.conf | tee allowed.txt
has allowed.txt "samples a second on accel_x, accel_y, accel_z, 0 lost" || fail "the drop-in does not allow enough"
