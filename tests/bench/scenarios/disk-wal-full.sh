# proves: with WAL and synchronous=FULL no acknowledged transaction is lost by a power cut at any moment
# needs: disk
# timeout: 120
# core
modprobe virtio_blk ext4
mkdir -p /mnt/data
mount -t ext4 /dev/vda /mnt/data
"$BIN/bench_disk_writer" /mnt/data/station.sqlite FULL 150 /out/acknowledged
sync /out/acknowledged
# The disk is left mounted: the power goes now, or at any moment before.
