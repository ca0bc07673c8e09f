# proves: the kiosk's user may mount a USB stick with FAT, export and back up to it, and eject it, because of the package's rule for polkit; without the rule this is refused; the disk with the data is neither offered nor unmounted
# needs: installed usb
# timeout: 900
modprobe usb-storage; modprobe vfat
device() { readlink -f "/dev/disk/by-label/$1"; }
there() { [ -b "$(device STICK)" ] && [ -b "$(device DATA)" ]; }
eventually 60 there
udevadm settle
db=/var/lib/turnpoint/turnpoint.sqlite
mount "$(device DATA)" /var/lib/turnpoint
chown turnpoint:turnpoint /var/lib/turnpoint
stick=$(device STICK) data=$(device DATA)
# as_kiosk COMMAND...: runs a command as turnpoint.service would: as its user and with all that the unit forbids.
as_kiosk() {
  local line arguments=()
  while read -r line; do arguments+=(-p "$line"); done < <(
    grep -hE '^(User|Group|SupplementaryGroups|Device|Protect|Private|StateDirectory|UMask|NoNewPrivileges|Capability|Ambient|Restrict|LockPersonality|SystemCall|IPAddress|ReadWritePaths)' \
      "$(systemctl show -P FragmentPath turnpoint)")
  systemd-run -q --wait --pipe "${arguments[@]}" "$@"
}
as_kiosk turnpoint run demo --participant P01 --db $db --observer sim
disks() { as_kiosk "$BENCH_DIR/bin/usb_disks" $db "$@"; }

[ "$(disks)" = "$stick - $(disks | cut -d' ' -f3-)" ] || fail "the stick alone should be offered: $(disks)"

say "without the rule nothing may be mounted"
mv /usr/share/polkit-1/rules.d/60-turnpoint.rules /run/
systemctl restart polkit
fails 1 disks mount "$stick"
has refusal.txt "NotAuthorized" || fail "the stick was not mounted, but for another reason"
mv /run/60-turnpoint.rules /usr/share/polkit-1/rules.d/
systemctl restart polkit

say "with the rule another user still may not"
fails 1 runuser -u nobody -- udisksctl mount --no-user-interaction --block-device "$stick"
has refusal.txt "NotAuthorized" || fail "another user may not mount, but for another reason"

say "with the rule it is mounted by the running station, which can then write to it"
as_kiosk sh -ec "'$BENCH_DIR/bin/usb_disks' $db mount '$stick'
  turnpoint export --db $db --out /media/turnpoint/STICK/export" | tee mounted.txt
folder=$(head -n 1 mounted.txt)
grep " $folder " /proc/mounts | grep -w vfat || fail "$folder is not the stick"
[ "$(ls "$folder"/export/demo/*.csv | wc -l)" = 9 ] || fail "the export is not complete: $(ls -R "$folder")"

say "a station that starts later can also write to it"
[ "$(disks mount "$stick")" = "$folder" ] || fail "a disk that is mounted is mounted again"
as_kiosk turnpoint backup --db $db --dir "$folder/turnpoint-backups" | tee backup.txt
! has backup.txt "not recorded" || fail "the backup was not recorded"
as_kiosk turnpoint backup --db $db --dir "$folder/turnpoint-backups" --drill

say "nobody may unmount the data"
fails 1 as_kiosk udisksctl unmount --no-user-interaction --block-device "$data"
has refusal.txt "NotAuthorized" || fail "the data were not unmounted, but for another reason"
fails 1 disks eject "$data"

say "it is ejected: unmounted and switched off"
disks eject "$stick"
! grep -q " $folder " /proc/mounts || fail "the stick is still mounted"
off() { [ ! -b "$stick" ]; }
eventually 20 off
[ -z "$(disks)" ] || fail "after ejecting, a disk is still offered: $(disks)"
mountpoint -q /var/lib/turnpoint || fail "the data were unmounted"
