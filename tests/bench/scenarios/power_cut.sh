# proves: SQLite in WAL mode with synchronous FULL loses no acknowledged row in a power cut; with NORMAL it loses some, which shows that the test can fail
# needs: disk
# timeout: 240
disk_begin
mkdir /run/disk/full /run/disk/normal
sync
disk_writer /run/disk/full/rows.sqlite FULL 200 /dev/vda
disk_writer /run/disk/normal/rows.sqlite NORMAL 200 /dev/vda
